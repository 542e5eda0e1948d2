#include "fem/shape_spline.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace hosel::fem {
namespace {

/// Inverse of interpolation at n equal intervals' ends with vanishing second derivatives at both: values, in the rows
/// between, to n + 2 coefficients.
Eigen::MatrixXd interpolation(int points) {
  const int n = points + 2;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  A.block<1, 3>(0, 0) << 1, -2, 1;
  A.block<1, 3>(n - 1, n - 3) << 1, -2, 1;
  for (int i = 0; i < points; ++i) A.block<1, 3>(i + 1, i) << 1.0 / 6, 4.0 / 6, 1.0 / 6;
  return A.inverse().middleCols(1, points);
}

struct Weights4 {
  std::array<double, 4> value, slope, second;
};

Weights4 cubic(double t, double step) {
  const double s = 1 - t, h = step;
  return {{s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6},
          {-s * s / 2 / h, (3 * t * t - 4 * t) / 2 / h, -(3 * s * s - 4 * s) / 2 / h, t * t / 2 / h},
          {s / h / h, (3 * t - 2) / h / h, (3 * s - 2) / h / h, t / h / h}};
}

}  // namespace

struct ShapeSpline::Cell {
  int i, j;
  Weights4 y, z;
};

ShapeSpline::ShapeSpline(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int columns, int rows,
                         const Eigen::MatrixXd& values)
    : from_(from),
      step_((to - from).cwiseQuotient(Eigen::Vector2d(columns - 1, rows - 1))),
      columns_(columns),
      rows_(rows) {
  if (columns < 2 || rows < 2 || values.cols() != Eigen::Index(columns) * rows || values.rows() > kSurfaceUnknowns)
    throw std::invalid_argument("spline: a value at every grid point of at most 32 functions is needed");
  const Eigen::MatrixXd Y = interpolation(columns), Z = interpolation(rows);
  coefficients_.resize(values.rows(), Eigen::Index(columns + 2) * (rows + 2));
  for (Eigen::Index f = 0; f < values.rows(); ++f) {
    const Eigen::VectorXd own = values.row(f);
    coefficients_.row(f) = (Y * own.reshaped(columns, rows) * Z.transpose()).reshaped().transpose();
  }
}

bool ShapeSpline::inside(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d at = (place - from_).cwiseQuotient(step_);
  return at.minCoeff() >= 0 && at.x() <= columns_ - 1 && at.y() <= rows_ - 1;
}

ShapeSpline::Cell ShapeSpline::cell(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d at = (place - from_).cwiseQuotient(step_);
  const int i = std::min(int(at.x()), columns_ - 2), j = std::min(int(at.y()), rows_ - 2);
  return {i, j, cubic(at.x() - i, step_.x()), cubic(at.y() - j, step_.y())};
}

double ShapeSpline::sum(const Eigen::Vector2d& place, const SurfaceUnknowns& weights) const {
  if (!inside(place)) return 0;
  const Cell c = cell(place);
  SurfaceUnknowns at = SurfaceUnknowns::Zero(count());
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a)
      at += c.y.value[std::size_t(a)] * c.z.value[std::size_t(b)] *
            coefficients_.col(Eigen::Index(c.j + b) * (columns_ + 2) + c.i + a);
  return at.dot(weights);
}

Travel ShapeSpline::at(const Eigen::Vector2d& place, const SurfaceUnknowns& weights) const {
  Travel out;
  out.shape.setZero(count());
  out.shape_slope.setZero(2, count());
  if (!inside(place)) return out;
  const Cell c = cell(place);
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a) {
      const auto i = std::size_t(a), j = std::size_t(b);
      const auto own = coefficients_.col(Eigen::Index(c.j + b) * (columns_ + 2) + c.i + a);
      out.shape += c.y.value[i] * c.z.value[j] * own;
      out.shape_slope.row(0) += c.y.slope[i] * c.z.value[j] * own.transpose();
      out.shape_slope.row(1) += c.y.value[i] * c.z.slope[j] * own.transpose();
      const double all = own.dot(weights);
      out.second(0, 0) += c.y.second[i] * c.z.value[j] * all;
      out.second(0, 1) += c.y.slope[i] * c.z.slope[j] * all;
      out.second(1, 1) += c.y.value[i] * c.z.second[j] * all;
    }
  out.second(1, 0) = out.second(0, 1);
  out.value = out.shape.dot(weights);
  out.slope = out.shape_slope * weights;
  return out;
}

}  // namespace hosel::fem
