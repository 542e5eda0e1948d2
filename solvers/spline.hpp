/// Splines through or near samples, with their derivatives right up to both ends.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hosel::solvers {

/// Quintic B-spline in one variable with values in R^d: continuous up to the fourth derivative.
class Spline {
 public:
  /// Through every sample; the two samples next to each end are no knots (not-a-knot), so that nothing is
  /// forced on the ends. At least six samples. Rows of `values` belong to `times`, which increase.
  static Spline through(const std::vector<double>& times, const Eigen::MatrixXd& values);
  /// Least squares with knots about `knot_spacing` apart, ends free. Noise on scales
  /// shorter than that is smoothed away. Throws std::invalid_argument where a stretch between knots
  /// holds too few samples.
  static Spline near(const std::vector<double>& times, const Eigen::MatrixXd& values, double knot_spacing);

  double first() const { return knots_.front(); }
  double last() const { return knots_.back(); }
  /// Value and first two derivatives (rows 0, 1, 2). Outside the range the end polynomials go on.
  Eigen::Matrix<double, 3, Eigen::Dynamic> at(double t) const;

 private:
  struct Basis {
    int first;                      // first basis function that is not zero
    Eigen::Matrix<double, 3, 6> n;  // values, first and second derivatives
  };
  Basis basis(double t) const;

  static constexpr int kDegree = 5;
  std::vector<double> knots_;
  Eigen::MatrixXd coefficients_;
};

}  // namespace hosel::solvers
