/// Calibration of a ball's material to its normal impacts on a rigid wall.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hosel/models/fe_impact.hpp"

namespace hosel::models {

/// What the ball shall do: restitution level + slope v at the speeds, contact time at one of them. Spin and
/// tangential data have no place here: what the ball says about them is a prediction.
struct NormalImpactTarget {
  std::vector<double> speeds{20, 30, 40, 50};  ///< [m/s]
  double restitution = 0.86;                   ///< level [-]
  double restitution_slope = -0.0029;          ///< [s/m]
  double restitution_sigma = 0.005;            ///< [-]
  double contact_speed = 40;                   ///< one of the speeds [m/s]
  double contact_time = 0.45e-3;               ///< [s]
  double contact_time_sigma = 0.01e-3;         ///< [s]
};

struct NormalImpactPoint {
  double speed = 0;         ///< [m/s]
  double target = 0;        ///< restitution [-]
  double restitution = 0;   ///< [-]
  double contact_time = 0;  ///< [s]
  double peak_force = 0;    ///< [N]
};

struct BallCalibration {
  FeBall ball;
  std::vector<std::string> names;     ///< of the parameters that were fitted
  std::vector<double> start, values;  ///< of the first layer, in the units of the names
  Eigen::MatrixXd covariance;         ///< of log values, at the residuals' declared sigmas
  std::vector<NormalImpactPoint> points;
  double cost = 0;  ///< half the sum of squared residuals over sigmas
  int evaluations = 0;
  bool converged = false;
  std::string report;  ///< of the least-squares solver, one line
};

/// One normal impact on a wall.
NormalImpactPoint normal_impact(const FeImpactOptions& options, const Ball& ball, double speed);

/// Fits, by Ceres in logarithms, factors on the long-term moduli, the branch moduli and, unless `hold_times`, the
/// branch times of all layers. `options.ball` is the start; options are those of the axisymmetric ball
/// (harmonics = 0). `progress` hears of every evaluation.
BallCalibration calibrate_ball(const FeImpactOptions& options, const Ball& ball, const NormalImpactTarget& target,
                               bool hold_times, const std::function<void(int evaluations, double cost)>& progress = {});

}  // namespace hosel::models
