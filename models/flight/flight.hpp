/// The ball after the blow: from its launch to the ground, in three dimensions.
///
/// State: position x from the tee, velocity v, and the spin as a share of the launch's spin (the spin axis keeps its
/// direction in space). With u the velocity through the air, q = rho A u^2 / 2 and the law's C_D(Re, S), C_L(Re, S):
///   m v' = -q C_D u / |u| + q C_L (spin x u) / (|spin| |u|) - m g ez.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "golf/ball.hpp"
#include "golf/launch.hpp"
#include "golf/units.hpp"
#include "models/flight/atmosphere.hpp"
#include "models/flight/flight_laws.hpp"

namespace hosel::models {

/// The plane on which the ball lands.
struct Ground {
  double height = 0;  ///< of the plane where the ball was struck, above the ball's centre at launch [m]
  double slope = 0;   ///< towards the target, uphill positive [rad]
};

struct FlightConditions {
  FlightLaw law = find_flight_law("ferguson-2022")->make();
  Air air;
  Wind wind;
  Ground ground;
  double gravity = kGravity;  ///< [m/s^2]
};

struct FlightOptions {
  /// Relative tolerance of a step. 1e-5 keeps the landing within two millimetres, in wind as in calm air
  /// (bench/flight_bench.cpp); the answers follow the tolerance down to 1e-12.
  double tolerance = 1e-5;
  double sample = 0;  ///< interval of the points in `path` [s]; 0: no path
};

struct FlightPoint {
  double time;          ///< [s]
  Vec3 position;        ///< of the ball's centre, global frame [m]
  Vec3 velocity, spin;  ///< global frame [m/s, rad/s]
  double reynolds, spin_ratio;
  Coefficients<double> coefficients;
};

struct Flight {
  double carry = 0;          ///< horizontal distance from launch to landing [m]
  double side = 0;           ///< of the landing, right of the target positive [m]
  double apex = 0;           ///< greatest height above the launch [m]
  double time = 0;           ///< in the air [s]
  double landing_angle = 0;  ///< of the path below the horizontal [rad]
  double landing_speed = 0;  ///< [m/s]
  FlightPoint landing;
  double apex_time = 0;             ///< [s]
  double outside = 0;               ///< share of the time that the law's range does not cover
  FlightLaw::Range reynolds, spin;  ///< what the flight went through
  long steps = 0;
  std::vector<FlightPoint> path;  ///< with the landing, where asked for
};

/// The flight. A ball that starts into the ground has none: every distance is zero.
/// Throws std::invalid_argument on a launch without speed or too low for raised ground, solvers::NonConvergence where
/// it does not come down in a minute.
Flight fly(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
           const FlightOptions& options = {});

/// Where the ball is at these rising times [s], whatever the ground does: heights of the wind count from the launch and
/// are mirrored below it. `sample` is not looked at. Throws as `fly` does.
std::vector<FlightPoint> follow(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                                std::span<const double> times, const FlightOptions& options = {});

/// Both by Runge and Kutta's fourth order in equal steps [s], the first of them halved again and again since the wind's
/// profile begins steeply. The answers are as smooth in launch, law, air and wind as these are, where an adaptive
/// method's choice of steps shows as jitter: for differences and fits. At 0.05 s flights lie within a millimetre of
/// `fly` and `follow`, those by a law whose drag has corners within a centimetre (test InStepsIsTheSameFlight). No
/// path. Throw as those do, and std::invalid_argument where the step is not above zero.
Flight fly_in_steps(const Launch& launch, const Ball& ball, const FlightConditions& conditions, double step);
std::vector<Vec3> follow_in_steps(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                                  std::span<const double> times, double step);

enum FlightAnswer { kCarry, kSide, kApex, kTime, kLandingAngle, kFlightAnswers };
enum LaunchQuantity { kBallSpeed, kLaunchAngle, kAzimuth, kBackspin, kSidespin, kRiflespin, kLaunchQuantities };

/// Row: FlightAnswer, column: LaunchQuantity; SI with radians.
using FlightJacobian = Eigen::Matrix<double, kFlightAnswers, kLaunchQuantities>;

/// The derivative of the flight by the launch, from the variational equations along it (dual numbers through every
/// rate, the events' own motion included), no differences. A launch without spin has none: std::invalid_argument.
FlightJacobian flight_jacobian(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                               const FlightOptions& options = {});

}  // namespace hosel::models
