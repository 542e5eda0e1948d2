/// The other way round: stiffness and damping of a shaft from measured deflections in the swing.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/swing.hpp"

namespace hosel::models {

/// One measured swing: what drove the club, and how the hosel moved in the grip frame.
struct MeasuredSwing {
  fem::Motion motion;
  double begin = 0, end = 0;         ///< the simulation's span [s]
  std::vector<double> times;         ///< of the samples that count, increasing, within the span [s]
  std::vector<double> lead, droop;   ///< [m]
  bool train = true;                 ///< false: held out, for the error only
};

struct ShaftIdentification {
  double bending_scale = 1;   ///< of bending and axial stiffness
  double damping_time = 0;    ///< [s]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (bending_scale, damping_time)
  double train_before = 0, train_after = 0;      ///< RMS error of the deflection [m]
  double holdout_before = 0, holdout_after = 0;  ///< 0 where nothing is held out [m]
  int iterations = 0;
  bool converged = false;
};

/// Least squares over all training swings, in the logarithms of scale and damping time (Ceres,
/// Levenberg-Marquardt, forward differences); the covariance takes the noise from the residuals.
/// `club.shaft` is the nominal shaft, its damping_time the first guess (above zero).
/// Throws std::invalid_argument on swings without samples.
ShaftIdentification identify_shaft(const Club& club, const SwingOptions& options, const std::vector<MeasuredSwing>& swings);

}  // namespace hosel::models
