#include "loop/fit.hpp"

#include <algorithm>
#include <cmath>

#include "golf/dense.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

/// One row for each parameter of which something is known beside the data: its scale over that standard deviation.
Eigen::MatrixXd prior_of(const Model& model) {
  const std::vector<const Parameter*> all = model.parameters();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(
      std::ranges::count_if(all, [](const Parameter* q) { return std::isfinite(q->known); }), model.size());
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (std::isfinite(all[k]->known)) rows(row++, Eigen::Index(k)) = all[k]->scale / all[k]->known;
  return rows;
}

/// A model's parameters are searched in units of their scale; what is known of them stands below the data.
solvers::LeastSquares least_squares(const Problem& problem, Part part, const Model& model, const Stage& stage,
                                    const Eigen::VectorXd& scale, Eigen::Index residuals) {
  const Eigen::MatrixXd prior = prior_of(model);
  solvers::LeastSquares out;
  out.residuals = int(residuals + prior.rows());
  out.loss = stage.loss;
  out.plain = int(prior.rows());
  for (const Parameter* q : model.parameters()) out.bounds.push_back({q->min / q->scale, q->max / q->scale, 1});
  out.value = [&problem, &model, &scale, prior, part, window = stage.window](const Eigen::VectorXd& x,
                                                                             Eigen::VectorXd& z) {
    Eigen::VectorXd data;
    if (!problem.whitened(part, model, x.cwiseProduct(scale), data, window)) return false;
    z.resize(data.size() + prior.rows());
    z << data, prior * x;
    return true;
  };
  out.linearised = [&problem, &model, &scale, prior, part, window = stage.window](
                       const Eigen::VectorXd& x, Eigen::VectorXd& z, Eigen::MatrixXd& J) {
    Eigen::VectorXd data;
    Eigen::MatrixXd by_data;
    if (!problem.linearise(part, model, x.cwiseProduct(scale), data, by_data, window)) return false;
    z.resize(data.size() + prior.rows());
    z << data, prior * x;
    J.resize(z.size(), x.size());
    J << by_data, prior;
    return true;
  };
  return out;
}

bool at_bound(const Model& model, const Eigen::VectorXd& p) {
  Eigen::Index k = 0;
  return std::ranges::any_of(model.parameters(), [&](const Parameter* q) { return q->at_edge(p[k++]); });
}

}  // namespace

Eigen::VectorXd scales(const Model& model) {
  Eigen::VectorXd s(model.size());
  Eigen::Index k = 0;
  for (const Parameter* q : model.parameters()) s[k++] = q->scale;
  return s;
}

Eigen::VectorXd whitened(const Problem& problem, Part part, const Model& model, const Eigen::VectorXd& p) {
  Eigen::VectorXd z;
  if (!problem.whitened(part, model, p, z)) z.resize(0);
  return z;
}

double deviance(const Problem& problem, Part part, const Fit& f) {
  const Eigen::VectorXd z = whitened(problem, part, f.model, f.p);
  if (!z.size()) return kInfinity;
  const double data = problem.stages().back().loss.sum(z);
  return part == Part::holdout ? data : data + known(f);
}

double known(const Fit& f) { return (prior_of(f.model) * f.p.cwiseQuotient(scales(f.model))).squaredNorm(); }

double improbability(const Fit& f) {
  constexpr double freedom = 4;
  double sum = 0;
  Eigen::Index k = 0;
  for (const Parameter* q : f.model.parameters())
    sum += (freedom + 1) * std::log1p(std::pow(f.p[k++] / q->usual, 2) / freedom);
  return sum;
}

double criterion(const Fit& f, const Rules& rules) {
  double sum = f.deviance + rules.parameter_cost * f.size() + improbability(f);
  for (const Parametrisation* form : f.model.forms) sum += form->complexity;
  return sum;
}

std::vector<Eigen::VectorXd> starts(const Model& model) {
  std::vector<Eigen::VectorXd> all = {Eigen::VectorXd::Zero(model.size())};
  int at = 0;
  for (const Parametrisation* f : model.forms) {
    const int n = int(f->parameters.size());
    const std::size_t known = all.size();
    for (const auto& s : f->starts)
      for (std::size_t i = 0; i < known && all.size() < 128; ++i) {
        Eigen::VectorXd p = all[i];
        p.segment(at, n) = as_vector(s);
        all.push_back(p);
      }
    at += n;
  }
  return all;
}

Fit fit(const Problem& problem, Part part, const Model& model, std::vector<Eigen::VectorXd> from, std::size_t most,
        bool near) {
  Fit best{.model = model, .p = Eigen::VectorXd::Zero(model.size()), .deviance = kInfinity};
  std::vector<Stage> stages = problem.stages();
  if (near) std::erase_if(stages, [](const Stage& s) { return std::isfinite(s.window); });
  if (model.size() == 0) {
    best.deviance = deviance(problem, part, best);
    return best;
  }
  if (from.size() > most) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < from.size(); ++k)
      order.emplace_back(deviance(problem, part, {.model = model, .p = from[k]}), k);
    std::ranges::stable_sort(order, {}, [](const auto& o) { return o.first; });
    std::vector<Eigen::VectorXd> kept;
    for (std::size_t k = 0; k < most; ++k) kept.push_back(std::move(from[order[k].second]));
    from = std::move(kept);
  }
  const Eigen::VectorXd scale = scales(model);
  std::vector<solvers::Minimum> at;
  for (const Eigen::VectorXd& start : from) at.push_back({.parameters = start.cwiseQuotient(scale)});
  constexpr std::size_t beam = 3;  // of an early stage, the best go on
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const Stage& stage = stages[k];
    std::vector<solvers::Minimum> reached;
    for (solvers::Minimum& m : at) {
      Eigen::VectorXd z;
      if (!problem.whitened(part, model, m.parameters.cwiseProduct(scale), z, stage.window)) continue;
      // A loss that makes nothing else of the residual has nothing to add.
      if (k > 0 && stages[k - 1].window == stage.window && stage.loss.sum(z) == stages[k - 1].loss.sum(z)) {
        reached.push_back(std::move(m));
        continue;
      }
      if (auto next = solvers::minimise(least_squares(problem, part, model, stage, scale, z.size()), m.parameters,
                                        {.iterations = stage.iterations, .cost = 1e-7, .parameters = 1e-7}))
        reached.push_back(*std::move(next));
    }
    std::ranges::stable_sort(reached, {}, &solvers::Minimum::cost);
    at.clear();
    for (solvers::Minimum& m : reached) {
      const bool known = std::ranges::any_of(at, [&](const solvers::Minimum& other) {
        const Eigen::VectorXd &a = m.parameters, &b = other.parameters;
        return (a - b).norm() < kNothing * (a.norm() + b.norm());
      });
      if (!known && at.size() < beam) at.push_back(std::move(m));
    }
  }
  if (at.empty()) return best;
  // An optimum inside the range is preferred to one at its edge if its deviance is higher by less than the cost of a
  // parameter.
  const auto taken = std::ranges::find_if(at, [&](const solvers::Minimum& m) {
    return !at_bound(model, m.parameters.cwiseProduct(scale)) &&
           2 * (m.cost - at.front().cost) < Rules{}.parameter_cost;
  });
  const solvers::Minimum& minimum = taken == at.end() ? at.front() : *taken;
  for (const solvers::Minimum& m : at)
    if (&m != &minimum) best.others.push_back(m.parameters.cwiseProduct(scale));
  best.p = minimum.parameters.cwiseProduct(scale);
  best.deviance = 2 * minimum.cost;
  best.at_bound = at_bound(model, best.p);
  return best;
}

Fit beside(const Fit& f, const Parametrisation* more) {
  Fit out{.model = f.model.with(more), .p = Eigen::VectorXd::Zero(f.size() + Eigen::Index(more->parameters.size()))};
  out.p.head(f.size()) = f.p;
  return out;
}

Eigen::MatrixXd covariance(const Problem& problem, Part part, const Fit& f) {
  const solvers::Loss loss = problem.stages().back().loss;
  Eigen::MatrixXd J = problem.jacobian(part, f.model, f.p);
  const Eigen::VectorXd z = whitened(problem, part, f.model, f.p);
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(J.cols(), J.cols());
  double blocks = 0;
  for (Eigen::Index i = 0; i < z.size(); i += loss.block) {
    auto rows = J.middleRows(i, loss.block);
    const auto zi = z.segment(i, loss.block);
    const double s = zi.squaredNorm(), w = loss.weight(s);
    const Eigen::VectorXd score = w * (rows.transpose() * zi);
    scores += score * score.transpose();
    rows *= std::sqrt(w);
    blocks += s > 0;
  }
  scores *= blocks / std::max(1.0, blocks - double(f.size()));
  const Eigen::MatrixXd prior = prior_of(f.model), data = J;
  J.resize(data.rows() + prior.rows(), data.cols());
  J << data, prior;
  scores += prior.transpose() * prior;
  bool known = true;
  for (int c = 0; c < problem.width(); ++c) known = known && problem.channel(c).trusted();
  // So few noise units per unit of scale tell nothing along a direction.
  const Eigen::VectorXd scale = scales(f.model);
  return scale.asDiagonal() * solvers::covariance(J, kNothing, known ? nullptr : &scores) * scale.asDiagonal();
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  Eigen::MatrixXd scaled = columns;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k)
    if (const double norm = scaled.col(k).norm(); norm > 0) scaled.col(k) /= norm;
  return dense::PivotedQr(scaled, 1e-8).basis();
}

}  // namespace hosel::loop
