/// Inverse problem: stiffness and damping of a shaft from measured deflections in the swing.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "models/club/swing.hpp"

namespace hosel::models {

/// One measured swing: what drove the club, and how the hosel moved in the grip frame.
struct MeasuredSwing {
  fem::Motion motion;
  double begin = 0, end = 0;        ///< the simulation's span [s]
  std::vector<double> times;        ///< of the samples that count, increasing, within the span [s]
  std::vector<double> lead, droop;  ///< [m]
  bool train = true;                ///< false: held out, for the error only
};

/// Sentences naming what no measured swing can have; empty if all is well.
std::vector<std::string> faults(const MeasuredSwing& swing);

struct ShaftIdentification {
  double bending_scale = 1;  ///< of bending and axial stiffness
  double damping_time = 0;   ///< [s]
  /// Of the logarithms of bending_scale and damping_time: 95 % of a parameter lies within a factor
  /// exp(+-1.96 sd) of the estimate.
  Eigen::Matrix2d log_covariance = Eigen::Matrix2d::Zero();
  double train_before = 0, train_after = 0;  ///< RMS error of the deflection [m]
  struct HeldOut {
    double before = 0, after = 0;
  };
  std::optional<HeldOut> held_out;  ///< the same of swings that are not fitted; none: nothing [m]
  /// Steps that Newton made shorter, over all training swings at the solution: above zero the swings are
  /// not smooth functions of the shaft, and the case wants a shorter step.
  long shortened_steps = 0;
};

/// Least squares over all training swings, in the logarithms of scale and damping time, within factors of 10
/// and 1000 of the first guess; derivatives by central differences of swings solved tightly enough for them.
/// The covariance takes the noise, independent from sample to sample, from the residuals.
/// `club.shaft` is the nominal shaft, its damping_time the first guess (above zero).
/// Throws std::invalid_argument on a fault of a swing, NonConvergence where there is no minimum inside.
ShaftIdentification identify_shaft(const Club& club, SwingOptions options, const std::vector<MeasuredSwing>& swings);

}  // namespace hosel::models
