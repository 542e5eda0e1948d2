#include "hosel/solvers/kriging.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace hosel::solvers {
namespace {

double matern(double distance) {
  const double d = std::sqrt(5.0) * distance;
  return (1 + d + d * d / 3) * std::exp(-d);
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& distance, double length, double nugget) {
  Eigen::MatrixXd k = distance.unaryExpr([&](double d) { return matern(d / length); });
  k.diagonal().array() += nugget;
  return k.llt().solve(Eigen::MatrixXd::Identity(k.rows(), k.cols()));
}

}  // namespace

Kriging::Kriging(const Eigen::MatrixXd& x, const Eigen::VectorXd& length, const Eigen::MatrixXd& y,
                 const Eigen::MatrixXd& honest)
    : scale_(length.cwiseInverse()), process_(honest.transpose() * honest / double(x.rows())), left_out_(honest) {
  const Eigen::Index n = x.rows();
  points_ = scale_.asDiagonal() * x.transpose();
  Eigen::MatrixXd distance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) distance.col(i) = (points_.colwise() - points_.col(i)).colwise().norm();

  const Eigen::VectorXd size = process_.diagonal().cwiseMax(std::numeric_limits<double>::min());
  double least = double(honest.cols()) * double(n);  // of no interpolation
  double best = 0;
  for (double l = 0.125; l <= 8; l *= 2)
    for (double nugget = 1e-4; nugget <= 1; nugget *= 10) {
      const Eigen::MatrixXd inverse = inverse_of(distance, l, nugget);
      const Eigen::MatrixXd e = inverse.diagonal().cwiseInverse().asDiagonal() * (inverse * honest);
      const double sum = (e.colwise().squaredNorm().transpose().array() / size.array()).sum();
      if (!(sum < least)) continue;
      least = sum;
      best = l;
      nugget_ = nugget;
      left_out_ = e;
    }
  if (best == 0) return;
  scale_ /= best;
  points_ /= best;
  square_ = points_.colwise().squaredNorm().transpose();
  inverse_ = inverse_of(distance, best, nugget_);
  weight_ = inverse_ * y;
  // The errors of leaving one out, each over the share of the process that was unknown there.
  const Eigen::MatrixXd over = inverse_.diagonal().cwiseSqrt().asDiagonal() * left_out_;
  process_ = over.transpose() * over / double(n);
}

Eigen::VectorXd Kriging::covariances(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd there = scale_.cwiseProduct(x);
  Eigen::ArrayXd d = (points_.transpose() * there).array() * -2 + (square_ + there.squaredNorm());
  d = (5 * d.max(0.0)).sqrt();
  return (1 + d + d.square() / 3) * (-d).exp();
}

Eigen::VectorXd Kriging::operator()(const Eigen::VectorXd& x) const {
  if (!interpolates()) return Eigen::VectorXd::Zero(process_.rows());
  return weight_.transpose() * covariances(x);
}

Eigen::MatrixXd Kriging::error(const Eigen::VectorXd& x) const {
  if (!interpolates()) return process_;
  const Eigen::VectorXd k = covariances(x);
  return (1 + nugget_ - k.dot(inverse_ * k)) * process_;
}

Eigen::MatrixXd Kriging::errors_together(const Eigen::MatrixXd& x) const {
  const Eigen::Index n = x.rows();
  if (!interpolates()) return Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd there = scale_.asDiagonal() * x.transpose();
  Eigen::MatrixXd of_points(points_.cols(), n), shared(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    of_points.col(i) = covariances(x.row(i).transpose());
    shared.col(i) = (there.colwise() - there.col(i)).colwise().norm().unaryExpr(&matern).transpose();
  }
  shared.diagonal().array() += nugget_;
  return shared - of_points.transpose() * inverse_ * of_points;
}

}  // namespace hosel::solvers
