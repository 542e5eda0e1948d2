/// Several functions over a rectangle by one bicubic spline each.
#pragma once

#include <Eigen/Core>

#include "fem/contact_surface.hpp"

namespace hosel::fem {

/// Cubic B-splines on equal intervals, twice differentiable everywhere, that pass through values on a grid (natural at
/// its edges). Zero beyond the grid.
class ShapeSpline {
 public:
  /// `values`: a row for each function, a column for each grid point, y fastest; at least two points each way.
  ShapeSpline(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int columns, int rows,
              const Eigen::MatrixXd& values);
  Eigen::Index count() const { return coefficients_.rows(); }
  /// Of the functions' sum with these weights: its value.
  double sum(const Eigen::Vector2d& place, const SurfaceUnknowns& weights) const;
  /// The same with its derivatives, and the functions one by one.
  Travel at(const Eigen::Vector2d& place, const SurfaceUnknowns& weights) const;

 private:
  struct Cell;
  bool inside(const Eigen::Vector2d& place) const;
  Cell cell(const Eigen::Vector2d& place) const;
  Eigen::Vector2d from_, step_;
  int columns_, rows_;
  Eigen::MatrixXd coefficients_;  // a column for each control point, two more each way than the grid has points
};

}  // namespace hosel::fem
