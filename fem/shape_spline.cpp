#include "fem/shape_spline.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
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
  double sum = 0;
  for (int b = 0; b < 4; ++b) {
    const Eigen::RowVector4d row = weights.transpose() *
                                   coefficients_.middleCols<4>(Eigen::Index(c.j + b) * (columns_ + 2) + c.i);
    sum += c.z.value[std::size_t(b)] * row.dot(Eigen::RowVector4d::Map(c.y.value.data()));
  }
  return sum;
}

Travel ShapeSpline::at(const Eigen::Vector2d& place, const SurfaceUnknowns& weights) const {
  Travel out;
  out.shape.setZero(count());
  out.shape_slope.setZero(2, count());
  if (!inside(place)) return out;
  const Cell c = cell(place);
  Eigen::Matrix<double, 4, 3> across;  // value, slope, second
  for (int a = 0; a < 4; ++a) {
    const auto i = std::size_t(a);
    across.row(a) << c.y.value[i], c.y.slope[i], c.y.second[i];
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kSurfaceUnknowns, 3> row(count(), 3);
  SurfaceUnknowns slope_y = SurfaceUnknowns::Zero(count()), slope_z = slope_y;
  for (int b = 0; b < 4; ++b) {
    const auto j = std::size_t(b);
    row = coefficients_.middleCols<4>(Eigen::Index(c.j + b) * (columns_ + 2) + c.i).lazyProduct(across);
    out.shape += c.z.value[j] * row.col(0);
    slope_y += c.z.value[j] * row.col(1);
    slope_z += c.z.slope[j] * row.col(0);
    out.second(0, 0) += c.z.value[j] * row.col(2).dot(weights);
    out.second(0, 1) += c.z.slope[j] * row.col(1).dot(weights);
    out.second(1, 1) += c.z.second[j] * row.col(0).dot(weights);
  }
  out.shape_slope.row(0) = slope_y;
  out.shape_slope.row(1) = slope_z;
  out.second(1, 0) = out.second(0, 1);
  out.value = out.shape.dot(weights);
  out.slope = out.shape_slope * weights;
  return out;
}

}  // namespace hosel::fem
