#include "hosel/loop/history/search.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <set>

#include "hosel/loop/history/noise.hpp"

namespace hosel::loop {
namespace {

Candidate judged(Fit fit, std::size_t base_forms, const Rules& rules) {
  Candidate c;
  c.criterion = fit.deviance + rules.parameter_cost * fit.model.size();
  for (const Form* f : fit.model.forms) c.criterion += f->rarity;
  for (std::size_t k = base_forms; k < fit.model.forms.size(); ++k) c.effects.push_back(fit.model.forms[k]->effect);
  std::ranges::stable_sort(c.effects, {}, history_order);
  c.fit = std::move(fit);
  return c;
}

std::vector<Candidate> best_of_each(std::vector<Candidate> all) {
  std::ranges::stable_sort(all, {}, &Candidate::criterion);
  std::vector<Candidate> best;
  std::set<std::vector<std::string>> seen;
  for (Candidate& c : all)
    if (std::isfinite(c.criterion) && seen.insert(c.effects).second) best.push_back(std::move(c));
  return best;
}

class Search {
 public:
  Search(const HistoryProblem& problem, double period, const Rules& rules) : problem_(problem), rules_(rules) {
    double span = 0;
    for (const HistoryRecord& r : problem.records())
      if (!r.times.empty()) span = std::max(span, r.times.back() - r.times.front());
    if (!problem.slow())
      for (double w = 4 * period; w < 0.7 * span; w *= 3) windows_.push_back(w);
  }

  /// From each start over growing windows; the best few go on.
  Fit climb(const Model& model, std::vector<Eigen::VectorXd> starts) const {
    for (const double w : windows_) {
      std::vector<Fit> fits;
      for (const Eigen::VectorXd& s : starts) fits.push_back(problem_.fit(model, s, w, 8));
      std::ranges::stable_sort(fits, {}, &Fit::deviance);
      starts.clear();
      for (const Fit& f : fits) {
        if (starts.size() == 3 || !std::isfinite(f.deviance)) break;
        const bool known = std::ranges::any_of(
            starts, [&](const Eigen::VectorXd& s) { return (s - f.p).norm() < 1e-3 * (s.norm() + f.p.norm()); });
        if (!known) starts.push_back(f.p);
      }
      if (starts.empty()) break;
    }
    Fit best{
        .model = model, .p = Eigen::VectorXd::Zero(model.size()), .deviance = std::numeric_limits<double>::infinity()};
    for (const Eigen::VectorXd& s : starts) {
      Fit f = problem_.fit(model, s, kWhole, problem_.slow() ? 5 : 20);
      if (f.deviance < best.deviance) best = std::move(f);
    }
    return best;
  }

  /// Fall of the deviance that each form promises beside a fit, to first order.
  std::vector<double> promises(const Fit& at, const std::vector<const Form*>& forms) const {
    Eigen::VectorXd z;
    std::vector<double> out(forms.size(), 0.0);
    if (!problem_.whitened(at.model, at.p.data(), kWhole, z)) return out;
    const Eigen::MatrixXd own = problem_.jacobian(at.model, at.p);
    tbb::parallel_for(std::size_t(0), forms.size(), [&](std::size_t k) {
      Model more = at.model;
      more.forms.push_back(forms[k]);
      Eigen::VectorXd p = Eigen::VectorXd::Zero(more.size());
      p.head(at.p.size()) = at.p;
      const auto n = std::ptrdiff_t(forms[k]->parameters.size());
      Eigen::MatrixXd J(z.size(), own.cols() + n);
      J << own, columns(more, p, n);
      const Eigen::VectorXd step = J.colPivHouseholderQr().solve(Eigen::VectorXd(-z));
      for (std::ptrdiff_t i = 0; i < n; ++i)
        if (forms[k]->parameters[std::size_t(i)].min >= 0 && step[own.cols() + i] < 0) return;
      out[k] = z.squaredNorm() - (z + J * step).squaredNorm();
    });
    return out;
  }

  /// Derivatives by the last `n` parameters.
  Eigen::MatrixXd columns(const Model& model, const Eigen::VectorXd& at, std::ptrdiff_t n) const {
    const auto parameters = model.parameters();
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(problem_.readings(), n);
    Eigen::VectorXd z, up, p = at;
    if (!problem_.whitened(model, p.data(), kWhole, z)) return J;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const auto k = p.size() - n + i;
      const double h = 1e-3 * parameters[std::size_t(k)]->scale;
      p[k] += h;
      if (problem_.whitened(model, p.data(), kWhole, up)) J.col(i) = (up - z) * 1e3;
      p[k] = at[k];
    }
    return J;
  }

  /// Sets with one more effect than those given: the most promising refitted.
  std::vector<Candidate> grow(const std::vector<Candidate>& from, std::size_t few, std::size_t many,
                              std::size_t base_forms, const std::vector<const Form*>& forms,
                              const std::vector<Candidate>& singles) const {
    struct Plan {
      const Candidate* first;
      const Form* second;
      double promise;
    };
    std::vector<Plan> plans;
    for (std::size_t k = 0; k < std::min(few, from.size()); ++k) {
      const std::vector<double> gain = promises(from[k].fit, forms);
      for (std::size_t f = 0; f < forms.size(); ++f)
        if (!std::ranges::count(from[k].effects, forms[f]->effect) && gain[f] > 1)
          plans.push_back({&from[k], forms[f], from[k].fit.deviance - gain[f]});
    }
    std::ranges::stable_sort(plans, {}, &Plan::promise);
    if (plans.size() > many) plans.resize(many);
    std::vector<Candidate> out(plans.size());
    const auto start_of = [&](const Plan& p) {
      Eigen::VectorXd s = Eigen::VectorXd::Zero(p.first->fit.size() + std::ptrdiff_t(p.second->parameters.size()));
      s.head(p.first->fit.size()) = p.first->fit.p;
      return s;
    };
    const auto model_of = [&](const Plan& p) {
      Model m = p.first->fit.model;
      m.forms.push_back(p.second);
      return m;
    };
    tbb::parallel_for(std::size_t(0), plans.size(), [&](std::size_t k) {
      out[k] = judged(problem_.fit(model_of(plans[k]), start_of(plans[k]), kWhole, problem_.slow() ? 4 : 15),
                      base_forms, rules_);
    });
    if (!windows_.empty()) {
      // The best of them once more from the first periods on.
      std::vector<std::size_t> order(plans.size());
      for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
      std::ranges::stable_sort(order, {}, [&](std::size_t k) { return out[k].criterion; });
      if (order.size() > 6) order.resize(6);
      tbb::parallel_for(std::size_t(0), order.size(), [&](std::size_t o) {
        const std::size_t k = order[o];
        std::vector<Eigen::VectorXd> starts = {start_of(plans[k]), out[k].fit.p};
        for (const Candidate& s : singles)
          if (s.fit.model.forms.back() == plans[k].second) {
            Eigen::VectorXd p = Eigen::VectorXd::Zero(starts[0].size());
            p.tail(std::ptrdiff_t(plans[k].second->parameters.size())) =
                s.fit.p.tail(std::ptrdiff_t(plans[k].second->parameters.size()));
            starts.push_back(p);
          }
        Candidate again = judged(climb(model_of(plans[k]), starts), base_forms, rules_);
        if (again.criterion < out[k].criterion) out[k] = std::move(again);
      });
    }
    return out;
  }

  /// The best set with each of its members exchanged for each other form.
  std::vector<Candidate> exchanged(const Candidate& best, std::size_t base_forms,
                                   const std::vector<const Form*>& forms) const {
    struct Plan {
      Model model;
      Eigen::VectorXd start;
    };
    std::vector<Plan> plans;
    std::ptrdiff_t at = 0;
    for (std::size_t k = 0; k < best.fit.model.forms.size(); ++k) {
      const Form* out = best.fit.model.forms[k];
      const auto n = std::ptrdiff_t(out->parameters.size());
      if (k >= base_forms) {
        for (const Form* in : forms) {
          if (std::ranges::count(best.effects, in->effect)) continue;
          Plan p;
          Eigen::VectorXd rest(best.fit.size() - n);
          rest << best.fit.p.head(at), best.fit.p.tail(best.fit.size() - at - n);
          p.model = best.fit.model;
          p.model.forms.erase(p.model.forms.begin() + std::ptrdiff_t(k));
          p.model.forms.push_back(in);
          p.start = Eigen::VectorXd::Zero(p.model.size());
          p.start.head(rest.size()) = rest;
          plans.push_back(std::move(p));
        }
      }
      at += n;
    }
    std::vector<Candidate> out(plans.size());
    tbb::parallel_for(std::size_t(0), plans.size(), [&](std::size_t k) {
      Fit f = problem_.fit(plans[k].model, plans[k].start, kWhole, problem_.slow() ? 3 : 12);
      out[k] = judged(std::move(f), base_forms, rules_);
    });
    return out;
  }

 private:
  const HistoryProblem& problem_;
  Rules rules_;
  std::vector<double> windows_;
};

}  // namespace

std::size_t history_order(const std::string& effect) {
  const auto all = history_effects();
  return std::size_t(std::ranges::find(all, effect, &HistoryEffect::name) - all.begin());
}

const Fit& HistorySearch::richest() const {
  const Fit* best = &base;
  for (const auto* list : {&singles, &pairs, &triples})
    for (const Candidate& c : *list)
      if (c.fit.deviance < best->deviance) best = &c.fit;
  return *best;
}

HistorySearch search(const HistoryProblem& problem, const std::vector<const Form*>& base,
                     const std::vector<const Form*>& candidates, double period, const Rules& rules) {
  HistorySearch s;
  const Search how(problem, period, rules);
  const Model model{base};
  s.base = how.climb(model, starts(model));
  if (!std::isfinite(s.base.deviance)) return s;

  // A form that moves nothing is said, not tried.
  std::vector<const Form*> forms;
  std::set<std::string> seen;
  {
    std::vector<char> moves(candidates.size(), 0);
    tbb::parallel_for(std::size_t(0), candidates.size(), [&](std::size_t k) {
      Model m = model;
      m.forms.push_back(candidates[k]);
      Eigen::VectorXd p = Eigen::VectorXd::Zero(m.size());
      p.head(s.base.p.size()) = s.base.p;
      const auto n = std::ptrdiff_t(candidates[k]->parameters.size());
      moves[k] = how.columns(m, p, n).colwise().norm().minCoeff() > 1e-3;
    });
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (moves[k]) {
        forms.push_back(candidates[k]);
        seen.insert(candidates[k]->effect);
      }
    for (const Form* f : candidates)
      if (!seen.contains(f->effect) && !std::ranges::count(s.silent, f->effect)) s.silent.push_back(f->effect);
  }

  // Where nothing is left and no form promises anything, far starts are a waste.
  Eigen::VectorXd z;
  problem.whitened(model, s.base.p.data(), kWhole, z);
  const std::vector<HistoryFinding> left = history_structure(problem, z);
  const std::vector<double> promised = how.promises(s.base, forms);
  const bool quiet = (left.empty() || left.front().p_adjusted > 0.01) &&
                     (promised.empty() || std::ranges::max(promised) < 0.6 * rules.gain);

  std::vector<Candidate> all(forms.size());
  tbb::parallel_for(std::size_t(0), forms.size(), [&](std::size_t k) {
    Model m = model;
    m.forms.push_back(forms[k]);
    if (quiet) {
      Eigen::VectorXd p = Eigen::VectorXd::Zero(m.size());
      p.head(s.base.p.size()) = s.base.p;
      all[k] = judged(problem.fit(m, p, kWhole, 8), base.size(), rules);
      return;
    }
    std::vector<Eigen::VectorXd> from;
    for (const Eigen::VectorXd& start : starts(Model{{forms[k]}})) {
      Eigen::VectorXd p(m.size());
      p << s.base.p, start;
      from.push_back(p);
      if (problem.slow()) break;
    }
    all[k] = judged(how.climb(m, from), base.size(), rules);
  });
  const std::vector<Candidate> form_fits = all;
  s.singles = best_of_each(std::move(all));
  if (s.singles.empty() || s.base.deviance - s.singles.front().fit.deviance < rules.gain) return s;

  std::vector<Candidate> first = form_fits;
  std::ranges::stable_sort(first, {}, &Candidate::criterion);
  const bool slow = problem.slow();
  std::vector<Candidate> pairs = how.grow(first, slow ? 1 : 5, slow ? 4 : 16, base.size(), forms, form_fits);
  pairs = best_of_each(std::move(pairs));
  if (!pairs.empty() && s.singles.front().criterion - pairs.front().criterion > rules.further_gain) {
    std::vector<Candidate> more = how.exchanged(pairs.front(), base.size(), forms);
    pairs.insert(pairs.end(), more.begin(), more.end());
  }
  s.pairs = best_of_each(std::move(pairs));
  return s;
}

void search_triples(const HistoryProblem& problem, const std::vector<const Form*>& candidates, const Rules& rules,
                    HistorySearch& s) {
  if (s.pairs.empty()) return;
  const Search how(problem, 1e300, rules);
  std::vector<Candidate> triples =
      how.grow(s.pairs, problem.slow() ? 1 : 2, problem.slow() ? 2 : 8, s.base.model.forms.size(), candidates, {});
  triples = best_of_each(std::move(triples));
  if (!triples.empty() && !problem.slow() &&
      s.pairs.front().criterion - triples.front().criterion > rules.further_gain) {
    std::vector<Candidate> more = how.exchanged(triples.front(), s.base.model.forms.size(), candidates);
    triples.insert(triples.end(), more.begin(), more.end());
  }
  s.triples = best_of_each(std::move(triples));
}

}  // namespace hosel::loop
