/// The optional `[flight]` of a case: how far the ball goes after the blow.
#pragma once

#include <functional>

#include "app/output.hpp"
#include "app/reader.hpp"
#include "post/table.hpp"
#include "post/trajectory.hpp"

namespace hosel::app {

struct FlightSetup {
  models::FlightConditions conditions;
  models::FlightOptions options;
  std::optional<models::BounceRoll> turf;
  post::DistanceUnit unit = post::DistanceUnit::yards;
  std::vector<models::LaunchError> errors;
  std::vector<models::FlightLaw> others;  ///< laws shown beside

  /// Distances in the unit that was asked for on the command line, if one was.
  void show_in(const Output& out);
  post::ShotFlight follow(const Launch& launch, const Ball& ball, double sample = 0) const;
};

/// Density, or the weather that makes it.
models::Air read_air(Table table);
/// Law, air, wind and ground: all of a flight that is compared with a measured one.
models::FlightConditions read_conditions(Table table);
FlightSetup read_flight(Table table);
std::optional<FlightSetup> read_optional_flight(Table root);

/// What is stated of a launch; the rest is as a model has it.
struct StatedLaunch {
  std::optional<double> ball_speed, launch_angle, azimuth;  ///< [m/s], [rad]
  std::optional<Vec3> spin;                                 ///< [rad/s]
  double speed_scale = 1;                                   ///< factor on the ball's speed

  Launch in_place_of(Launch launch) const;
};
/// The spin by its components or by rate and tilt. `whole`: speed, angle and spin are required, and what else is absent
/// is zero.
StatedLaunch read_launch(Table table, bool whole);

/// A quantity of the launch or of the flight after it, by name.
struct ShotChannel {
  std::string name, unit;
  double si;
  std::function<double(const Launch&)> value;  ///< SI; throws as the flight does
};
/// Absent where nothing has this name, or where it belongs to a flight and there is none.
std::optional<ShotChannel> find_shot_channel(std::string_view name, const std::optional<FlightSetup>& flight,
                                             const Ball& ball);

/// A sentence where part of a flight is outside the range of its law; empty else.
std::string outside_law(const FlightSetup& setup, const post::ShotFlight& shot);

/// The error budget as a table, the trajectories by every law as figure and lines for ParaView in OUT; returns the
/// budget for the summary. `name` begins the files' names. Says where a law is used outside its range. With a table for
/// files: gives it a row a law. Without `draw`: no figure.
nlohmann::json report_flight(Output& out, const FlightSetup& setup, const std::string& name, const Launch& launch,
                             const Ball& ball, post::Table* by_law = nullptr, bool draw = true);

}  // namespace hosel::app
