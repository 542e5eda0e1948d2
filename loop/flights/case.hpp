/// The input of a loop on flights: recorded launches, the measurements of the flight after each, and the unknowns of
/// every shot and of every group of shots. No club, no impact.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "loop/case.hpp"
#include "loop/shots/shots.hpp"
#include "models/flight/flight_inference.hpp"

namespace hosel::loop {

/// What a shot has of its own beside the errors of its recorded launch, and a group beside that: standard deviations
/// about zero.
struct FlightUnknowns {
  double axis = 0;                         ///< tilt of the spin where none is recorded [rad]; about a level spin
  double spin_rate = 0, spin_rate_sd = 0;  ///< of a spin that is not recorded: the usual one, its relative deviation
  double drag = 0, lift = 0;               ///< of a ball, relative
  double gust = 0;                         ///< of a shot's wind, each direction [m/s]
  double wind = 0;                         ///< of a group's, each direction [m/s]
  double slope = 0;                        ///< of the ground where a group's shots land [rad]
};

/// Position at an instant as a channel: of the path that a shot's file holds.
struct PathPoint {
  int axis;  ///< 0 to the target, 1 to its right, 2 up
  double time;
};

struct FlightCase : Case {
  FlightCase() { rules = Rules::of_flights(); }
  Shots shots;
  Ball ball;
  models::FlightConditions conditions;
  std::vector<models::Air> air;                  ///< of each row; empty: that of `conditions`
  std::map<std::string, double> noise;           ///< by header, header's unit: of the launch and of the flight
  std::vector<models::ShotUnknowns> deviations;  ///< of each row's unknowns; empty: by `noise` and `unknown`
  std::vector<std::string> group_by;  ///< columns whose values together name a group; none: all are one group
  FlightUnknowns unknown;
  std::vector<PathPoint> points;  ///< channels of the path,
  Eigen::MatrixXd positions;      ///< rows x points [m]; NaN where there is none
  double position_noise = 0;      ///< [m]
};

}  // namespace hosel::loop
