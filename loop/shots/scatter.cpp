#include "loop/shots/scatter.hpp"

#include <algorithm>
#include <cmath>

#include "golf/dense.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {

double smooth_scatter(const ShotModel& model, const std::vector<int>& rows, int channel,
                      const Eigen::MatrixXd& residuals) {
  std::vector<int> seen;
  for (const int i : rows)
    if (std::isfinite(residuals(i, channel))) seen.push_back(i);
  const auto n = std::ptrdiff_t(seen.size());
  if (seen.size() < kFewestToTest) return 0;
  std::vector<Eigen::VectorXd> basis = {Eigen::VectorXd::Ones(n)};
  const auto add = [&](Eigen::VectorXd x) {
    if (std::ptrdiff_t(basis.size()) * 3 >= n) return;
    x.array() -= x.mean();
    if (x.norm() < kRoundOff) return;
    basis.push_back(x / x.norm());
  };
  for (const int power : {1, 2})
    for (int k = 0; k < kInputs; ++k) {
      Eigen::VectorXd x(n);
      for (std::ptrdiff_t i = 0; i < n; ++i) x[i] = get(model.trial(seen[i]).blow, Input(k));
      if (power == 2) x = Eigen::VectorXd((x.array() - x.mean()).square());
      add(x);
    }
  Eigen::MatrixXd A(n, std::ptrdiff_t(basis.size()));
  for (std::size_t k = 0; k < basis.size(); ++k) A.col(std::ptrdiff_t(k)) = basis[k];
  Eigen::VectorXd y(n), w = Eigen::VectorXd::Ones(n);
  for (std::ptrdiff_t i = 0; i < n; ++i) y[i] = residuals(seen[i], channel);
  double scale = 0;
  for (int pass = 0; pass < 12; ++pass) {
    const Eigen::MatrixXd WA = w.cwiseSqrt().asDiagonal() * A;
    const Eigen::VectorXd b = dense::PivotedQr(WA).solve(Eigen::VectorXd(w.cwiseSqrt().cwiseProduct(y)));
    const Eigen::VectorXd r = y - A * b;
    std::vector<double> size;
    for (std::ptrdiff_t i = 0; i < n; ++i) size.push_back(std::abs(r[i]));
    scale = robust_deviation(size) * std::sqrt(double(n) / double(n - A.cols()));
    if (!(scale > 0)) break;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const double u = r[i] / (4.685 * scale);
      w[i] = std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) + 1e-6 : 1e-6;
    }
  }
  return scale;
}

Scatter scatter(const ShotModel& model, const std::vector<int>& rows, int channel, const Eigen::MatrixXd& residuals,
                int fitted) {
  std::vector<double> readings;
  for (const int i : rows)
    if (std::isfinite(residuals(i, channel))) readings.push_back(residuals(i, channel) / model.sigma(i, channel));
  return scatter_of(readings, double(fitted) / model.width());
}

Scatter scatter_of(const std::vector<double>& readings, double fitted) {
  double sum = 0, fourth = 0;
  const double n = double(readings.size());
  for (const double u : readings) {
    const double s = std::min(u * u, kMostSquare);
    sum += s;
    fourth += s * s;
  }
  Scatter out;
  if (n < 3 || !(sum > 0)) return out;
  const double dof = std::max(1.0, n - fitted), mean = sum / n;
  out.ratio = std::sqrt(sum / dof);
  out.error = std::max(std::sqrt(std::max(0.0, fourth / n - mean * mean) / n) / mean / 2, 1 / std::sqrt(2 * dof));
  return out;
}

}  // namespace hosel::loop
