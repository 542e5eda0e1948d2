/// Calibration of a ball's material to its normal impacts on a rigid wall, and to oblique blows where there are some.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "models/fe/impact.hpp"

namespace hosel::models {

/// What the ball shall do at the wall: restitution level + slope v at the speeds, or a figure of its own at each;
/// contact time at one of them. Where no oblique blow is given, spin and tangential data have no part: what the ball
/// says about them is a prediction.
struct NormalImpactTarget {
  std::vector<double> speeds{20, 30, 40, 50};  ///< [m/s]
  double restitution = 0.86;                   ///< level [-]
  double restitution_slope = -0.0029;          ///< [s/m]
  std::vector<double> restitutions;            ///< one for each speed, instead of the line; empty: the line [-]
  double restitution_sigma = 0.005;            ///< [-]
  double contact_speed = 40;                   ///< one of the speeds [m/s]
  double contact_time = 0.45e-3;               ///< [s]
  double contact_time_sigma = 0.01e-3;         ///< [s]

  double wanted(std::size_t k) const {
    return restitutions.empty() ? restitution + restitution_slope * speeds[k] : restitutions[k];
  }
};

/// Tangential restitution of the ball thrown at a rigid plate.
struct BounceTarget {
  double speed = 0;  ///< [m/s]
  double angle = 0;  ///< from the normal [rad]
  double tangential_restitution = 0, sigma = 0;
};

/// A measured shot. Its loft is an unknown of its own, found from the launch angle: a recorded one may have been
/// computed from the ball.
struct ObliqueTarget {
  std::string name;
  Blow blow;                         ///< with a shaft: the full club; its loft is where the search begins
  bool seen = true;                  ///< by the fit; else it is predicted alone
  double launch_angle = 0;           ///< [rad]
  double spin_rate = 0;              ///< [rad/s]
  double spin_sigma = 0;             ///< relative [-]
  std::optional<double> ball_speed;  ///< where it is a target as well [m/s]
  double ball_speed_sigma = 0;       ///< relative; what the club's speed is known to counts here as well [-]
};

/// An unknown of the calibration.
struct FreeParameter {
  enum class What {
    long_term,       ///< logarithm of a factor on the long-term moduli of all layers
    branches,        ///< the same on all branch moduli
    branch_times,    ///< the same on all branch times
    layer,           ///< the same on all moduli of one layer
    friction,        ///< the same on Coulomb's coefficient
    face_stiffness,  ///< the same on the stiffness of the face of some shots
    impact_high,     ///< of some shots: how much higher up the face they were struck than their blow says [cm]
    head_mass        ///< of some shots: how much heavier the head is than their blow says [10 g]
  };
  What what;
  std::size_t layer = 0;           ///< from the inside
  std::vector<std::size_t> shots;  ///< whose face, strike or head it is
  double prior = 0;                ///< where it is expected, in the units of `what`
  double sd = INFINITY;            ///< of that expectation

  static constexpr double kReach = 3;  ///< the search goes as far from zero, in the units of `what`
  bool of_shots() const { return what >= What::face_stiffness; }
};

struct ObliquePoint {
  std::string name;
  bool seen = true;
  double loft = 0;                    ///< found [rad]
  double target = 0, spin_rate = 0;   ///< [rad/s]
  double ball_speed = 0;              ///< [m/s]
  double tangential_restitution = 0;  ///< no target
  double launch_ratio = 0;            ///< no target
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
  std::vector<std::string> names;     ///< of the parameters that were fitted, with their units
  std::vector<double> start, values;  ///< in those units: of the first layer, of the named layer over the first, ...
  std::vector<double> internal;       ///< as FreeParameter has them
  std::vector<bool> at_bound;         ///< at an end of what the search allows
  Eigen::MatrixXd covariance;         ///< of the internal values, at the residuals' declared sigmas
  std::vector<NormalImpactPoint> points;
  std::optional<double> bounce;     ///< tangential restitution where that was a target
  std::vector<ObliquePoint> shots;  ///< all, those that the fit has not seen too
  /// Every seen shot as a fit without it has it: the shared parameters by one Gauss-Newton step from the whole fit
  /// without that shot's rows, its own nuisances (parameters of this shot alone) by its rows and their priors.
  std::vector<ObliquePoint> left_out;
  std::vector<std::vector<double>> left_out_values;  ///< internal values of each of those fits
  double friction = 0;
  std::vector<std::optional<FaceCompliance>> faces;  ///< of the shots
  double cost = 0;                                   ///< half the sum of squared residuals over sigmas
  int evaluations = 0;                               ///< blows asked for
  bool converged = false;
  std::string report;  ///< of the least-squares solver, one line
};

struct BallCalibrationProblem {
  FeImpactOptions options;  ///< ball to begin with; the wall is met by the axisymmetric ball
  PatchFriction friction;   ///< to begin with, of the bounce and of every shot
  Ball ball;
  NormalImpactTarget wall;
  std::optional<BounceTarget> bounce;
  std::vector<ObliqueTarget> shots;
  std::vector<FreeParameter> free;
  bool leave_one_out = false;

  /// Sentences naming what cannot be; empty if all is well.
  std::vector<std::string> faults() const;
};

/// One normal impact on a wall.
NormalImpactPoint normal_impact(const FeImpactOptions& options, const Ball& ball, double speed);

/// Fits the free parameters by Ceres. `progress` hears of every evaluation of all residuals. Throws
/// std::invalid_argument with the first of the faults, NonConvergence where there is no impact to begin with.
BallCalibration calibrate_ball(const BallCalibrationProblem& problem,
                               const std::function<void(int evaluations, double cost)>& progress = {});

}  // namespace hosel::models
