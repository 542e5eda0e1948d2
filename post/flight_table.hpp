/// What a flight comes to, as people and files read it: names, units, tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/flight/bounce_roll.hpp"
#include "models/flight/flight_budget.hpp"
#include "post/text_table.hpp"

namespace hosel::post {

enum class DistanceUnit { yards, metres };
/// Suffix and size of the unit in which distances are shown.
std::string_view suffix(DistanceUnit unit);
double size(DistanceUnit unit);  ///< [m]

/// From the launch to the ball's rest.
struct ShotFlight {
  models::Flight flight;
  std::optional<models::Run> run;           ///< absent: the ball is not followed on the ground
  DistanceUnit unit = DistanceUnit::yards;  ///< in which it is shown
  std::string no_run = {};                  ///< why the ball's run on the turf has no end, where it was asked for
};

struct FlightChannel {
  std::string_view name;  ///< without unit
  std::string_view unit;  ///< suffix
  double si;              ///< one of the unit in SI
  int decimals;
  std::optional<double> (*value)(const ShotFlight&);  ///< SI; absent where the ball was not followed that far
};
/// carry, total, side, apex, flight_time, landing_angle.
std::span<const FlightChannel> flight_channels(DistanceUnit unit);

/// {"carry_yd": ..., ...}, and what share of the flight lies outside the law's range.
nlohmann::json to_json(const ShotFlight& shot);

/// A row per answer: the value; what the integration, each launch error and the choice of the law do to it.
TextTable budget_table(const models::FlightBudget& budget, const std::vector<models::LaunchError>& errors,
                       DistanceUnit unit);
nlohmann::json to_json(const models::FlightBudget& budget, const std::vector<models::LaunchError>& errors,
                       DistanceUnit unit);

}  // namespace hosel::post
