#include "solvers/kriging.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "golf/dense.hpp"
#include "solvers/errors.hpp"

namespace hosel::solvers {
namespace {

constexpr double kStart = 3;  // length of an input of which nothing is known: some more than its range
constexpr double kShortest = 0.1, kLongest = 200, kLeastNugget = 1e-8, kLargestNugget = 100;
constexpr double kLengthStep = 2.5, kNuggetStep = 10;  // factors of the search
constexpr double kNuggetGain = 0.1;                    // of log likelihood: less is not worth a step of the nugget

/// Of so many points a plane may be asked, or a constant.
Eigen::Index terms(Eigen::Index points, Eigen::Index inputs) { return points > 3 * (inputs + 1) ? inputs + 1 : 1; }

/// Of all points with all: the nugget stands in the diagonal.
Eigen::MatrixXd covariance(const Eigen::MatrixXd& x, const Kriging::Correlation& c) {
  const Eigen::MatrixXd at = c.length.cwiseInverse().asDiagonal() * x.transpose();
  const Eigen::VectorXd square = at.colwise().squaredNorm();
  Eigen::MatrixXd k = (at.transpose() * at) * -2;
  k.colwise() += square;
  k.rowwise() += square.transpose();
  k = matern(k.array()).matrix();
  k.diagonal().setConstant(1 + c.nugget);
  return k;
}

/// What follows from a correlation.
struct Regression {
  dense::Cholesky factor;
  Eigen::MatrixXd of_trend, normal, plane, weight;
  Eigen::VectorXd variance;  // of every output

  Regression(const Eigen::MatrixXd& x, const Eigen::MatrixXd& trend, const Eigen::MatrixXd& y,
             const Kriging::Correlation& c)
      : factor(covariance(x, c)) {
    of_trend = factor.solve(trend);
    normal = trend.transpose() * of_trend;
    plane = dense::Cholesky(normal).solve(Eigen::MatrixXd(of_trend.transpose() * y));
    const Eigen::MatrixXd left = y - trend * plane;
    weight = factor.solve(left);
    variance = (left.array() * weight.array()).colwise().sum().transpose() / double(x.rows() - trend.cols());
  }

  /// Logarithm of the restricted likelihood but for a constant, outputs that vary taken as independent.
  double likelihood(Eigen::Index freedom) const {
    if (!factor.positive()) return -std::numeric_limits<double>::infinity();
    double sum = 0;
    int outputs = 0;
    for (const double v : variance)
      if (v > std::numeric_limits<double>::min()) sum += std::log(v), ++outputs;
    const double determinants = factor.log_determinant() + dense::Cholesky(normal).log_determinant();
    return -0.5 * (outputs * determinants + double(freedom) * sum);
  }
};

}  // namespace

Eigen::ArrayXXd matern(const Eigen::ArrayXXd& square) {
  const Eigen::ArrayXXd d = (5 * square.max(0.0)).sqrt();
  return (1 + d + d.square() / 3) * (-d).exp();
}

Kriging::Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) : Kriging(x, y, Correlation{}) {}

Kriging::Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, Correlation from)
    : Kriging(x, y, std::move(from), Search{}) {}

Kriging::Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const Search& search)
    : Kriging(x, y, Correlation{}, search) {}

Kriging::Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, Correlation from, const Search& search)
    : correlation_(std::move(from)) {
  const Eigen::Index n = x.rows(), d = x.cols(), p = search.plane ? terms(n, d) : 1;
  if (correlation_.length.size() != d) correlation_ = {.length = Eigen::VectorXd::Constant(d, kStart)};
  Eigen::MatrixXd trend = Eigen::MatrixXd::Ones(n, p);
  if (p > 1) trend.rightCols(d) = x;

  double best = Regression(x, trend, y, correlation_).likelihood(n - p);
  for (const double length : {1.0, 2.5, 6.0, 15.0})
    for (const double nugget : {0.01, 0.1, 1.0, 10.0, 100.0}) {
      if (!search.together) continue;
      Correlation tried{.length = Eigen::VectorXd::Constant(d, length), .nugget = nugget};
      const double l = Regression(x, trend, y, tried).likelihood(n - p);
      if (!(l > best)) continue;
      best = l;
      correlation_ = std::move(tried);
    }
  /// One of the lengths, or the nugget, as far as it is worth while.
  const auto follow = [&](Eigen::Index k, double factor) {
    bool moved = false;
    for (;; moved = true) {
      Correlation tried = correlation_;
      double& value = k < d ? tried.length[k] : tried.nugget;
      value *= factor;
      if (k < d ? value < kShortest || value > kLongest : value < kLeastNugget || value > kLargestNugget) return moved;
      const double l = Regression(x, trend, y, tried).likelihood(n - p);
      if (!(l > best + (k < d ? search.gain : kNuggetGain))) return moved;
      best = l;
      correlation_ = std::move(tried);
    }
  };
  for (int sweep = 0, moved = 1; sweep < search.sweeps && moved; ++sweep) {
    moved = 0;
    for (Eigen::Index k = 0; k <= d; ++k) {
      const double factor = k < d ? kLengthStep : kNuggetStep;
      moved += follow(k, factor) || follow(k, 1 / factor);
    }
  }

  const Regression found(x, trend, y, correlation_);
  if (!found.factor.positive())
    throw NonConvergence(
        "no Gaussian process goes through these points: their correlation matrix is not positive definite");
  points_ = correlation_.length.cwiseInverse().asDiagonal() * x.transpose();
  square_ = points_.colwise().squaredNorm().transpose();
  inverse_ = found.factor.lower_inverse();
  of_trend_ = found.of_trend;
  plane_ = found.plane;
  plane_error_ = dense::Cholesky(found.normal).inverse();
  weight_ = found.weight;
  process_ = weight_.transpose() * (y - trend * plane_) / double(n - p);
}

Eigen::VectorXd Kriging::covariances(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd there = x.cwiseQuotient(correlation_.length);
  return matern((points_.transpose() * there).array() * -2 + (square_ + there.squaredNorm())).matrix();
}

Eigen::VectorXd Kriging::trend(const Eigen::VectorXd& x) const {
  Eigen::VectorXd terms = Eigen::VectorXd::Ones(plane_.rows());
  if (terms.size() > 1) terms.tail(x.size()) = x;
  return terms;
}

Eigen::VectorXd Kriging::operator()(const Eigen::VectorXd& x) const {
  return plane_.transpose() * trend(x) + weight_.transpose() * covariances(x);
}

Eigen::MatrixXd Kriging::error(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd k = covariances(x), open = trend(x) - of_trend_.transpose() * k;
  const double share = 1 - (inverse_.triangularView<Eigen::Lower>() * k).squaredNorm() +
                       open.dot(plane_error_ * open);  // at a point that was asked, rounding
  return (std::max(share, 0.0) + correlation_.nugget) * process_;
}

Kriging Kriging::through(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) const {
  const Eigen::Index n = x.rows(), p = plane_.rows(), m = points_.cols();
  Eigen::MatrixXd basis(n, p + m), normal;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd at = x.row(i).transpose();
    basis.row(i) << trend(at).transpose(), covariances(at).transpose();
  }
  normal = basis.transpose() * basis;
  const Eigen::MatrixXd own = correlation_.length.asDiagonal() * points_;
  normal.bottomRightCorner(m, m) += correlation_.nugget *
                                    covariance(own.transpose(), {correlation_.length, kLeastNugget});
  const Eigen::MatrixXd found = dense::Cholesky(normal).solve(Eigen::MatrixXd(basis.transpose() * y));
  Kriging out = *this;
  out.plane_ = found.topRows(p);
  out.weight_ = found.bottomRows(m);
  return out;
}

Eigen::MatrixXd Kriging::errors_together(const Eigen::MatrixXd& x) const {
  const Eigen::Index n = x.rows();
  const Eigen::MatrixXd there = correlation_.length.cwiseInverse().asDiagonal() * x.transpose();
  Eigen::MatrixXd of_points(points_.cols(), n), shared(n, n), open(plane_.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    of_points.col(i) = covariances(x.row(i).transpose());
    open.col(i) = trend(x.row(i).transpose()) - of_trend_.transpose() * of_points.col(i);
    shared.col(i) = matern((there.colwise() - there.col(i)).colwise().squaredNorm().transpose().array()).matrix();
  }
  shared.diagonal().array() += correlation_.nugget;
  const Eigen::MatrixXd told = inverse_.triangularView<Eigen::Lower>() * of_points;
  return shared - told.transpose() * told + open.transpose() * plane_error_ * open;
}

}  // namespace hosel::solvers
