#include "loop/likeness.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>

#include "loop/rules.hpp"

namespace hosel::loop {

Likeness likeness(const std::vector<EffectColumn>& columns, const Eigen::MatrixXd& fitted) {
  Likeness out;
  const Eigen::MatrixXd Q = orthonormal(fitted);
  std::vector<std::size_t> seen;
  std::vector<Eigen::VectorXd> unit;
  for (const EffectColumn& c : columns) {
    const double whole = c.whitened.norm();
    Absorption a{.effect = c.effect, .parameter = c.parameter};
    const Eigen::VectorXd left = c.whitened - Q * (Q.transpose() * c.whitened);
    a.signal = left.norm();
    a.absorbed = whole > 0 ? 1 - a.signal * a.signal / (whole * whole) : 0;
    if (a.signal > kFaint && a.signal > kFaint * whole) {
      seen.push_back(out.absorption.size());
      unit.push_back(left / a.signal);
    }
    out.absorption.push_back(a);
  }
  const auto n = std::ptrdiff_t(unit.size());
  if (n < 2) return out;
  Eigen::MatrixXd U(unit.front().size(), n);
  for (std::ptrdiff_t k = 0; k < n; ++k) U.col(k) = unit[k];
  const Eigen::MatrixXd G = U.transpose() * U;
  for (std::ptrdiff_t k = 0; k < n; ++k)
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      Absorption& a = out.absorption[seen[k]];
      const Absorption& b = out.absorption[seen[j]];
      if (a.effect == b.effect || std::abs(G(k, j)) <= std::abs(a.likeness)) continue;
      a.likeness = G(k, j);
      a.nearest = b.effect;
    }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(G, Eigen::ComputeFullV);
  for (std::ptrdiff_t k = n - 1; k >= 0 && out.null_vectors.size() < kMostTold; --k) {
    NullVector v{.singular = std::sqrt(std::max(0.0, svd.singularValues()[k]))};
    if (v.singular > 0.1) break;
    Eigen::VectorXd w = svd.matrixV().col(k);
    std::ptrdiff_t most = 0;
    w.cwiseAbs().maxCoeff(&most);
    w /= w[most];
    std::vector<std::ptrdiff_t> order;
    for (std::ptrdiff_t j = 0; j < n; ++j)
      if (std::abs(w[j]) > 0.15) order.push_back(j);
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::ptrdiff_t j) { return std::abs(w[j]); });
    for (const std::ptrdiff_t j : order) v.weights.emplace_back(out.absorption[seen[j]].effect, w[j]);
    out.null_vectors.push_back(std::move(v));
  }
  return out;
}

Likeness likeness(const Problem& problem, const Fit& at, const std::vector<const Parametrisation*>& forms) {
  std::vector<EffectColumn> columns;
  std::set<std::string> seen;
  for (const Parametrisation* f : at.model.forms) seen.insert(f->effect);
  const Eigen::VectorXd z = whitened(problem, Part::select, at.model, at.p);
  for (const Parametrisation* f : forms) {
    if (f->parameters.size() != 1 || !seen.insert(f->effect).second) continue;
    Fit more = beside(at, f);
    EffectColumn c{f->effect, f->parameters.front().name, {}};
    if (f->threshold) {
      const double probe = f->starts.front().front();
      more.p.tail(1).setConstant(probe);
      c.whitened = (whitened(problem, Part::select, more.model, more.p) - z) / (probe / f->parameters.front().scale);
    } else {
      c.whitened = problem.jacobian(Part::select, more.model, more.p).rightCols(1);
    }
    columns.push_back(std::move(c));
  }
  return likeness(columns, problem.jacobian(Part::select, at.model, at.p));
}

}  // namespace hosel::loop
