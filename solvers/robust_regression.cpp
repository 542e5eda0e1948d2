#include "solvers/robust_regression.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "golf/dense.hpp"
#include "solvers/errors.hpp"

namespace hosel::solvers {
namespace {

double median_size(const Eigen::VectorXd& r) {
  std::vector<double> size(r.data(), r.data() + r.size());
  for (double& x : size) x = std::abs(x);
  const auto middle = size.begin() + std::ptrdiff_t(size.size() / 2);
  std::ranges::nth_element(size, middle);
  return *middle;
}

}  // namespace

RobustRegression robust_regression(const Eigen::MatrixXd& given, const Eigen::VectorXd& y) {
  // Columns of unit length: inputs in metres stand beside inputs in metres a second.
  const Eigen::VectorXd length = given.colwise().norm();
  if (!(length.minCoeff() > 0)) throw NonConvergence("regression: a column without values");
  const Eigen::MatrixXd X = given * length.cwiseInverse().asDiagonal();
  RobustRegression out;
  out.weights = Eigen::VectorXd::Ones(y.size());
  Eigen::VectorXd residual = y;
  bool held = false;  // the scale: re-estimated in every round of the bisquare, it may go in circles
  const auto solve = [&] {
    const Eigen::VectorXd root = out.weights.cwiseSqrt();
    const dense::PivotedQr qr(root.asDiagonal() * X);
    if (qr.rank() < X.cols()) throw NonConvergence("regression: the inputs depend on each other");
    out.coefficients = qr.solve(Eigen::VectorXd(root.cwiseProduct(y)));
    residual = y - X * out.coefficients;
    if (!held) out.scale = 1.4826 * median_size(residual);
  };
  solve();
  for (const bool bisquare : {false, true}) {
    held = bisquare;
    constexpr int most = 500;
    int k = 0;
    for (; k < most && out.scale > 0; ++k) {
      const Eigen::VectorXd before = out.coefficients;
      for (Eigen::Index i = 0; i < y.size(); ++i) {
        const double u = std::abs(residual[i]) / out.scale;
        if (bisquare) out.weights[i] = u < 4.685 ? std::pow(1 - (u / 4.685) * (u / 4.685), 2) : 0;
        else out.weights[i] = u > 1.345 ? 1.345 / u : 1;
      }
      solve();
      if ((out.coefficients - before).norm() <= 1e-9 * out.coefficients.norm()) break;
    }
    // Huber's fit is a start only.
    if (bisquare && k == most) throw NonConvergence("regression: the weights do not settle");
  }
  // Derivative of the bisquare's score: (1 - v^2) (1 - 5 v^2).
  Eigen::VectorXd slope = Eigen::VectorXd::Ones(y.size());
  if (out.scale > 0)
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double v = residual[i] / (4.685 * out.scale), w = v * v;
      slope[i] = w < 1 ? (1 - w) * (1 - 5 * w) : 0;
    }
  const Eigen::MatrixXd bread = dense::inverse(X.transpose() * slope.asDiagonal() * X);
  // A row draws the fit towards itself: its score is by its residual from the fit of the others (HC3).
  const Eigen::MatrixXd inside = dense::inverse(X.transpose() * out.weights.asDiagonal() * X);
  Eigen::VectorXd score = out.weights.cwiseProduct(residual);
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double alone = out.weights[i] * X.row(i).dot(inside * X.row(i).transpose());
    if (!(alone < 1 - 1e-9)) throw NonConvergence("regression: one row alone decides a coefficient");
    score[i] /= 1 - alone;
  }
  const Eigen::MatrixXd meat = X.transpose() * score.cwiseAbs2().asDiagonal() * X;
  const Eigen::VectorXd back = length.cwiseInverse();
  out.covariance = back.asDiagonal() * bread * meat * bread * back.asDiagonal();
  out.coefficients = back.cwiseProduct(out.coefficients);
  return out;
}

}  // namespace hosel::solvers
