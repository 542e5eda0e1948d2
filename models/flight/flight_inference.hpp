/// A law of drag, lift and decay of spin from measured paths, jointly with the unknowns of every shot and of every
/// group of shots.
///
/// Minimised is the sum over the shots of n_i s atan(m_i / s), and over winds and coefficients of (x / sd)^2. m_i is
/// the shot's misfit: its |r_i|^2 and the (u / sd)^2 of its own unknowns over the number n_i of its readings. r are the
/// distances of the computed from the measured positions over their noise, s the scale of the misfits. Unknowns of a
/// shot: ShotUnknown; of a group (the shots of a hole in a round): the wind; of all: the law's coefficients. A whole
/// shot, its own unknowns included, has the weight 1 / (1 + (m_i / s)^2), so that a path that no unknown explains has
/// little influence on the law. Gauss-Newton; each shot's unknowns are eliminated (Schur complement).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/flight/flight.hpp"

namespace hosel::models {

/// What one shot has of its own. Zero: as it was seen, in the group's wind, with the law's ball.
enum ShotUnknown {
  kAxis,        ///< tilt of the spin beyond the one seen, positive for a fade [rad]
  kLogSpin,     ///< logarithm of the spin rate over the one seen
  kOwnDrag,     ///< factor on the drag coefficient, less one
  kOwnLift,     ///< the same on lift
  kOwnSpeed,    ///< ball speed beyond the one seen [m/s]
  kOwnAngle,    ///< launch angle beyond the one seen [rad]
  kOwnAzimuth,  ///< [rad]
  kGustAlong,   ///< wind beyond the group's, towards the target, at the wind's reference height [m/s]
  kGustRight,   ///< to the right of it [m/s]
  kShotUnknowns
};
using ShotUnknowns = Eigen::Matrix<double, kShotUnknowns, 1>;
using GroupWind = Eigen::Vector2d;  ///< towards the target, to its right, at the reference height [m/s]

struct MeasuredPath {
  std::string id;
  Launch launch;  ///< as seen; a spin whose tilt was not seen is level, across the launch's direction
  Air air;
  int group = 0;
  ShotUnknowns sd = ShotUnknowns::Zero();  ///< standard deviation of each unknown about zero; zero: it is known
  std::vector<double> times;               ///< of the positions, rising [s]
  std::vector<Vec3> positions;             ///< from the launch, global frame [m]
};

struct PathModel {
  Ball ball;
  Wind profile;               ///< height and roughness of every wind; its speed and direction are not looked at
  double noise = 0.3;         ///< of a position, each axis [m]
  double wind_sd = 3;         ///< of a group's wind about none, each direction [m/s]
  double mean_wind_sd = 0.5;  ///< of the mean wind over all groups about none, each direction [m/s]
};

/// Further conditions on top of those given: a wind that adds to the one there, the ball's own drag and lift.
FlightConditions with_own(FlightConditions c, const ShotUnknowns& own, const GroupWind& wind);
/// The launch and the conditions of a shot with its unknowns.
Launch launched(const Launch& seen, const ShotUnknowns& own);
FlightConditions conditions_of(const MeasuredPath& shot, const PathModel& model, const FlightLaw& law,
                               const ShotUnknowns& own, const GroupWind& wind);

struct PathFit {
  FlightLaw law;  ///< with its covariance, where it was fitted
  std::vector<ShotUnknowns> shots;
  std::vector<GroupWind> winds;
  std::vector<Eigen::Vector2d> wind_sd;  ///< the law's own uncertainty included, where it was fitted
  std::vector<double> weight;            ///< of each shot; small: nothing explains its path
  std::vector<double> misfit;            ///< sum of its squares (data and unknowns) over the number of its readings
  double rms = 0;  ///< of the distances of computed from measured positions, weighted, per axis [m]
  int iterations = 0;
};

/// `law_sd`: standard deviation of every coefficient about those of `start` (`inferred_coefficient`); empty: the law is
/// held. `groups`: their number; `winds`: where each wind's search begins and, with `hold_winds`, what it is.
/// Throws std::invalid_argument on shots without readings, solvers::NonConvergence where the law does not settle.
PathFit fit_paths(const std::vector<MeasuredPath>& shots, int groups, const PathModel& model, const FlightLaw& start,
                  const std::vector<double>& law_sd = {}, std::vector<GroupWind> winds = {}, bool hold_winds = false);

}  // namespace hosel::models
