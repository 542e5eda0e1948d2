#include "loop/beyond_doubt.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "golf/dense.hpp"

namespace hosel::loop {
namespace {

/// Parameters in units of their scale, as some of the rows have them.
struct Size {
  Eigen::VectorXd value, sd;
};

/// The blocks of one part about a fit: each its contribution to normal matrix and gradient.
class Scores {
 public:
  Scores(const Problem& problem, Part part, const Fit& f) : J_(problem.jacobian(part, f.model, f.p)) {
    const solvers::Loss loss = problem.stages().back().loss;
    z_ = whitened(problem, part, f.model, f.p);
    block_ = loss.block;
    for (Eigen::Index i = 0; i + block_ <= z_.size(); i += block_)
      weight_.push_back(loss.weight(z_.segment(i, block_).squaredNorm()));
    at_ = f.p.cwiseQuotient(scales(f.model));
  }

  /// One Gauss-Newton step of parameters first to first + count, the others held, on the blocks that `take` names; the
  /// errors by the scatter of the scores.
  template <class Take>
  Size size(Eigen::Index first, Eigen::Index count, Take&& take) const {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(count, count), scores = A;
    Eigen::VectorXd g = Eigen::VectorXd::Zero(count);
    for (std::size_t b = 0; b < weight_.size(); ++b) {
      if (!take(b)) continue;
      const auto J = J_.block(Eigen::Index(b) * block_, first, block_, count);
      const Eigen::VectorXd score = weight_[b] * (J.transpose() * z_.segment(Eigen::Index(b) * block_, block_));
      A += weight_[b] * (J.transpose() * J);
      scores += score * score.transpose();
      g += score;
    }
    const Eigen::MatrixXd inverse = dense::Ldlt(A).inverse();
    return {at_.segment(first, count) - inverse * g, (inverse * scores * inverse.transpose()).diagonal().cwiseSqrt()};
  }

 private:
  Eigen::MatrixXd J_;
  Eigen::VectorXd z_, at_;
  Eigen::Index block_ = 1;
  std::vector<double> weight_;
};

/// Whether an effect has one size in all of these looks, and is there in each.
bool agree(const std::vector<Size>& looks, const Rules& rules) {
  const Size& whole = looks.front();
  for (const Size& look : looks) {
    if (!look.value.allFinite() || !look.sd.allFinite()) return false;
    bool there = false;
    for (Eigen::Index k = 0; k < look.value.size(); ++k) {
      const double error = 2 * std::hypot(look.sd[k], whole.sd[k]);
      there = there || std::abs(look.value[k]) > rules.present * look.sd[k];
      if (!(std::abs(look.value[k] - whole.value[k]) < std::max(rules.steady * std::abs(whole.value[k]), error)))
        return false;
    }
    if (!there) return false;
  }
  return true;
}

/// The forms of `f` beyond the base that pass every look at them.
std::vector<const Parametrisation*> steady(const Study& study, const Fit& f) {
  const Problem& problem = study.problem;
  const Scores train(problem, Part::train, f), holdout(problem, Part::holdout, f);
  const auto subsets = problem.subsets();
  const auto all = [](std::size_t) { return true; };
  std::vector<const Parametrisation*> passed;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < f.model.forms.size(); ++k) {
    const Parametrisation* form = f.model.forms[k];
    const auto count = Eigen::Index(form->parameters.size());
    bool inside = true;
    for (Eigen::Index j = 0; j < count; ++j) inside = inside && !form->parameters[j].at_edge(f.p[first + j]);
    if (k >= study.base.size() && inside) {
      std::vector<Size> looks = {train.size(first, count, all), holdout.size(first, count, all)};
      for (const std::vector<bool>& in : subsets)
        looks.push_back(train.size(first, count, [&](std::size_t b) { return in[b]; }));
      if (agree(looks, study.rules)) passed.push_back(form);
    }
    first += count;
  }
  return passed;
}

/// Root mean square of the raw held-out residuals, per channel.
Eigen::VectorXd held_out(const Problem& problem, const Fit& f) {
  const Eigen::MatrixXd r = problem.residuals(f.model, f.p);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(r.cols()), count = sum;
  for (const Problem::Row& row : problem.rows())
    for (Eigen::Index c = 0; row.holdout && c < r.cols(); ++c)
      if (std::isfinite(r(row.index, c))) sum[c] += r(row.index, c) * r(row.index, c), count[c] += 1;
  return (sum.array() / count.array().max(1)).sqrt();
}

/// Of a set of effects those that pass every test, fitted to all training rows.
std::optional<Candidate> keep(const Study& study, const Fit& start) {
  const Problem& problem = study.problem;
  Candidate out{.effects = {}, .fit = start};
  do {
    const std::vector<const Parametrisation*> passed = steady(study, out.fit);
    if (passed.empty()) return {};
    if (study.base.size() + passed.size() == out.fit.model.forms.size()) break;
    const Fit left = part_of(out.fit, [&](const Parametrisation& form) {
      return std::ranges::count(passed, &form) + std::ranges::count(study.base, &form) > 0;
    });
    out.fit = fit(problem, Part::train, left.model, {left.p}, 1, true);
  } while (true);
  const Fit& base = study.selection.base;
  if (!(deviance(problem, Part::holdout, out.fit) < deviance(problem, Part::holdout, base) - study.rules.gain))
    return {};
  const Eigen::VectorXd before = held_out(problem, base), after = held_out(problem, out.fit);
  if (!(after.array() <= (1 + study.rules.worse) * before.array()).all()) return {};
  out.criterion = criterion(out.fit, study.rules);
  out.effects = out.fit.model.effects(study.base.size());
  return out;
}

}  // namespace

BeyondDoubt beyond_doubt(const Study& study) {
  const Problem& problem = study.problem;
  const Selection& s = study.selection;
  if (problem.subsets().empty()) return {};
  // The chosen set, and those that do nearly as well in its place.
  const std::size_t size = s.chosen.model.forms.size();
  // The sum of three effects follows any smooth form.
  if (size > study.base.size() + 2) return {};
  std::vector<Candidate> kept;
  for (const Candidate& c : s.candidates) {
    if (c.fit.model.forms.size() != size) continue;
    if (!(s.base.deviance - c.fit.deviance > study.rules.stand_in * (s.base.deviance - s.chosen.deviance))) continue;
    if (auto k = keep(study, fit(problem, Part::train, c.fit.model, {c.fit.p}, 1, true))) kept.push_back(*std::move(k));
  }
  if (kept.empty()) return {};
  const Candidate& best = *std::ranges::min_element(kept, {}, &Candidate::criterion);
  // Two together follow many a form that neither is: where structure remains, most such pairs are wrong.
  if (best.effects.size() > 1) return {};
  BeyondDoubt out{.adopted = {}, .ties = {}, .fit = best.fit};
  std::vector<std::string> tie = best.effects;
  for (const Candidate& k : kept)
    for (const std::string& other : k.effects)
      if (!std::ranges::count(k.effects, tie.front()) && !std::ranges::count(tie, other)) tie.push_back(other);
  if (tie.size() > 1) out.ties.push_back(std::move(tie));
  else out.adopted = std::move(tie);
  return out;
}

}  // namespace hosel::loop
