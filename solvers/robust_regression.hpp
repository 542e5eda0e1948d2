/// A straight line through data of which some rows are bad.
#pragma once

#include <Eigen/Core>

namespace hosel::solvers {

struct RobustRegression {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;  ///< by the scatter of the scores, whatever the residuals' law
  Eigen::VectorXd weights;     ///< of the rows, 0 to 1
  double scale = 0;            ///< of the residuals: 1.4826 times the median of their size
};

/// Tukey's bisquare (4.685 scales: 95 % efficient on normal errors) from Huber's fit, by reweighted least squares. P.
/// J. Rousseeuw and A. M. Leroy, Robust Regression and Outlier Detection (1987), ch. 1. Bad values of y are borne, bad
/// rows of X are not. Throws NonConvergence where the columns of X depend on each other or the weights do not settle.
RobustRegression robust_regression(const Eigen::MatrixXd& X, const Eigen::VectorXd& y);

}  // namespace hosel::solvers
