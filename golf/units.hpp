/// Units as name suffixes (`club_speed_mph`, `mass_kg`): one table for case files and measured data.
/// Everything in the code is SI with radians; suffixes live in files only.
#pragma once

#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hosel {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  ///< a number that nobody gave
inline constexpr double kRadPerDeg = kPi / 180.0;
inline constexpr double kRadPerSecPerRpm = kPi / 30.0;
inline constexpr double kMpsPerMph = 0.44704;
inline constexpr double kGravity = 9.80665;  ///< standard gravity [m/s^2]

constexpr double radians(double degrees) { return degrees * kRadPerDeg; }
constexpr double degrees(double radians) { return radians / kRadPerDeg; }
constexpr double rpm(double rad_per_s) { return rad_per_s / kRadPerSecPerRpm; }

/// What a unit measures. Names match the sentence shown to a person.
enum class Dimension {
  length,
  angle,
  speed,
  angular_velocity,
  mass,
  time,
  frequency,
  force,
  moment,
  pressure,
  density,
  inertia,
  bending_stiffness,
  line_density,
  translational_stiffness,
  rotational_stiffness,
  translational_damping,
  rotational_damping,
  volume_stiffness,
  inverse_speed,
  acceleration,
  energy,
  area,
  percent,
};

struct Unit {
  std::string_view suffix;  ///< as it stands at the end of a key, without the underscore
  Dimension dimension;
  double si;  ///< one of this unit in SI
};

/// Every unit the project reads, in the order offered to a person.
std::span<const Unit> all_units();
/// Those of them in which instruments record: the loop asks whether a column was recorded in another one.
std::span<const Unit> units();
std::string_view name(Dimension dimension);

/// `club_speed_mph` -> stem `club_speed`, unit mph. The longest matching suffix wins.
struct SplitName {
  std::string stem;
  std::optional<Unit> unit;
};
SplitName split_unit(std::string_view name);

}  // namespace hosel
