/// What a regression leaves, interpolated: near a point that was asked its answer counts, far from all none does.
#pragma once

#include <Eigen/Core>

namespace hosel::solvers {

/// Simple kriging [@pc-kriging] of residuals with zero mean, Matern's covariance of smoothness 5/2 over a distance with
/// a length per input, and a nugget. One factor on the lengths and the nugget, common to all outputs, are those of
/// least error in leaving one out; where no interpolation predicts better than zero, there is none.
class Kriging {
 public:
  Kriging() = default;  ///< says zero everywhere
  /// `x`: points x inputs; `length`: of every input, relative to each other; `y`: residuals to interpolate, points x
  /// outputs; `honest`: residuals of the same points by a regression that had not seen them, to choose by.
  Kriging(const Eigen::MatrixXd& x, const Eigen::VectorXd& length, const Eigen::MatrixXd& y,
          const Eigen::MatrixXd& honest);

  Eigen::VectorXd operator()(const Eigen::VectorXd& x) const;
  /// Mean square of the error to be expected there, outputs x outputs.
  Eigen::MatrixXd error(const Eigen::VectorXd& x) const;
  /// How the errors of many points (a row each) go together: times `process` the covariance of two points' errors; its
  /// diagonal times that is `error`.
  Eigen::MatrixXd errors_together(const Eigen::MatrixXd& x) const;
  /// Covariance of the outputs where nothing is known near.
  const Eigen::MatrixXd& process() const { return process_; }
  bool interpolates() const { return weight_.size() > 0; }
  /// What was left of every point's honest residual once the others had predicted it: points x outputs.
  const Eigen::MatrixXd& left_out() const { return left_out_; }

 private:
  Eigen::VectorXd covariances(const Eigen::VectorXd& x) const;

  Eigen::MatrixXd points_;   ///< scaled, inputs x points
  Eigen::ArrayXd square_;    ///< their squared lengths
  Eigen::VectorXd scale_;    ///< of the inputs [1/length]
  Eigen::MatrixXd inverse_;  ///< of the points' correlation with the nugget
  Eigen::MatrixXd weight_;   ///< points x outputs
  double nugget_ = 0;
  Eigen::MatrixXd process_;
  Eigen::MatrixXd left_out_;
};

}  // namespace hosel::solvers
