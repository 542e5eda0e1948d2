/// A straight line through data of which some rows are bad.
#pragma once

#include <Eigen/Core>

namespace hosel::solvers {

struct RobustRegression {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;  ///< by the scatter of the scores, each by the fit of the other rows (HC3)
  Eigen::VectorXd weights;     ///< of the rows, 0 to 1
  double scale = 0;            ///< 1.4826 times the median size of the residuals of Huber's fit; held from there on
};

/// Tukey's bisquare (4.685 scales: 95 % efficient on normal errors) from Huber's fit, by reweighted least squares. P.
/// J. Rousseeuw and A. M. Leroy, Robust Regression and Outlier Detection (1987), ch. 1. Bad values of y are borne, bad
/// rows of X are not. The scores are those of J. G. MacKinnon and H. White, J. Econometrics 29 (1985) 305. Throws
/// NonConvergence where the columns of X depend on each other, also without one row, or the weights do not settle.
RobustRegression robust_regression(const Eigen::MatrixXd& X, const Eigen::VectorXd& y);

}  // namespace hosel::solvers
