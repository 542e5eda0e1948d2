/// Calibration of a ball's material to its normal impacts on a rigid wall, and to oblique blows where there are some.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hosel/models/fe_impact.hpp"

namespace hosel::models {

/// What the ball shall do at the wall: restitution level + slope v at the speeds, contact time at one of them. Where no
/// oblique blow is given, spin and tangential data have no part: what the ball says about them is a prediction.
struct NormalImpactTarget {
  std::vector<double> speeds{20, 30, 40, 50};  ///< [m/s]
  double restitution = 0.86;                   ///< level [-]
  double restitution_slope = -0.0029;          ///< [s/m]
  double restitution_sigma = 0.005;            ///< [-]
  double contact_speed = 40;                   ///< one of the speeds [m/s]
  double contact_time = 0.45e-3;               ///< [s]
  double contact_time_sigma = 0.01e-3;         ///< [s]
};

/// A measured shot. Its loft is an unknown of its own, found from the launch angle: a recorded one may have been
/// computed from the ball.
struct ObliqueTarget {
  std::string name;
  Blow blow;                         ///< with a shaft: the full club; its loft is where the search begins
  double launch_angle = 0;           ///< [rad]
  double spin_rate = 0;              ///< [rad/s]
  double spin_sigma = 0;             ///< relative [-]
  std::optional<double> ball_speed;  ///< where it is a target as well [m/s]
  double ball_speed_sigma = 0;       ///< relative; what the club's speed is known to counts here as well [-]
};

/// Beside the factors on long-term and branch moduli of all layers.
struct Fitted {
  bool branch_times = true;  ///< one factor for all
  bool cover = false;        ///< a factor on the moduli of the outermost layer alone
  bool friction = false;
  bool face = false;  ///< a factor on the stiffness of the clubs' yielding face, one for all shots
};

struct ObliquePoint {
  std::string name;
  double loft = 0;                    ///< found [rad]
  double target = 0, spin_rate = 0;   ///< [rad/s]
  double ball_speed = 0;              ///< [m/s]
  double tangential_restitution = 0;  ///< no target
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
  std::vector<double> start, values;  ///< of the first layer, in the units of the names; then cover and friction
  Eigen::MatrixXd covariance;         ///< of log values, at the residuals' declared sigmas
  std::vector<NormalImpactPoint> points;
  std::vector<ObliquePoint> shots;
  double friction = 0;
  std::optional<FaceCompliance> face;
  double cost = 0;  ///< half the sum of squared residuals over sigmas
  int evaluations = 0;
  bool converged = false;
  std::string report;  ///< of the least-squares solver, one line
};

/// One normal impact on a wall.
NormalImpactPoint normal_impact(const FeImpactOptions& options, const Ball& ball, double speed);

/// Fits, by Ceres in logarithms, factors on the long-term moduli, the branch moduli and what `fitted` names besides.
/// `options.ball`, `options.friction` and `options.face` are the start; the wall is rigid and met by the axisymmetric
/// ball, the shots by `options.harmonics`. `progress` hears of every evaluation. Throws std::invalid_argument where
/// cover, friction or face are to be fitted without shots (a bounce does not see them), or a face without a start.
BallCalibration calibrate_ball(const FeImpactOptions& options, const Ball& ball, const NormalImpactTarget& target,
                               const std::vector<ObliqueTarget>& shots, const Fitted& fitted,
                               const std::function<void(int evaluations, double cost)>& progress = {});

}  // namespace hosel::models
