/// Error budget of a flight: integration, laws, and launch.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/flight/flight.hpp"

namespace hosel::models {

/// One source of error of a launch: standard deviations that know nothing of each other. Spin's magnitude and tilt
/// are an alternative to its components.
struct LaunchError {
  std::string source;
  double ball_speed = 0;                             ///< [m/s]
  double launch_angle = 0, azimuth = 0;              ///< [rad]
  double backspin = 0, sidespin = 0, riflespin = 0;  ///< [rad/s]
  double spin_rate = 0;                              ///< [rad/s]
  double spin_axis = 0;                              ///< [rad]
};

using FlightAnswers = Eigen::Matrix<double, kFlightAnswers, 1>;  ///< by FlightAnswer; SI with radians
FlightAnswers answers(const Flight& flight);

struct FlightBudget {
  FlightAnswers value, numerical;     ///< with the asked tolerance, and what a ten-thousandth of it changes
  double outside = 0;                 ///< share of the time that the law's range does not cover
  std::vector<FlightAnswers> launch;  ///< standard deviation of each source, by the flight's derivative
  FlightAnswers launch_total;
  /// Standard deviation by the law's own coefficients, where it came with their covariance.
  std::optional<FlightAnswers> law;
  struct Law {
    std::string name;
    FlightAnswers value;
    double outside;  ///< share of the time that its range does not cover
  };
  std::vector<Law> laws;  ///< the flight by other laws
};

FlightBudget flight_budget(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                           const FlightOptions& options, const std::vector<LaunchError>& errors,
                           const std::vector<FlightLaw>& others);

}  // namespace hosel::models
