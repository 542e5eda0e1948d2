/// What is told of a blow and what is read of its launch, one row each: name, dimension, plausible range, access.
/// Files, fits and reports all take them from here.
#pragma once

#include <optional>
#include <string_view>

#include "golf/blow.hpp"
#include "golf/launch.hpp"
#include "golf/units.hpp"

namespace hosel {

enum class Input { club_speed, attack_angle, club_path, face_angle, dynamic_loft, impact_toe, impact_high, head_mass };
inline constexpr int kInputs = 8;

struct InputQuantity {
  std::string_view name;  ///< without unit
  Dimension dimension;
  double low, high;  ///< what no blow with a golf club exceeds [SI]
  double step;       ///< of differences: far below any noise, far above round-off [SI]
  double& (*of)(Blow&);
};
const InputQuantity& quantity(Input input);
inline std::string_view stem(Input input) { return quantity(input).name; }
std::optional<Input> input_of(std::string_view name);
double get(const Blow& blow, Input input);        ///< SI
void set(Blow& blow, Input input, double value);  ///< SI

/// What a launch monitor reports: of the launch, then of the flight.
enum class Output {
  ball_speed,
  launch_angle,
  azimuth,
  backspin,
  sidespin,
  spin_rate,
  spin_axis,
  carry,
  side,
  apex,
  flight_time,
  landing_angle
};
inline constexpr int kLaunchOutputs = 7, kOutputs = 12;
/// Compared on the circle.
inline bool is_angle(Output o) { return o == Output::launch_angle || o == Output::azimuth || o == Output::spin_axis; }
inline bool of_flight(Output output) { return int(output) >= kLaunchOutputs; }

struct OutputQuantity {
  std::string_view name;  ///< without unit
  Dimension dimension;
  double (Launch::*of)() const;  ///< null for those of the flight
};
const OutputQuantity& quantity(Output output);
inline std::string_view stem(Output output) { return quantity(output).name; }
std::optional<Output> output_of(std::string_view name);
/// SI; not for those of the flight.
inline double get(const Launch& launch, Output output) { return (launch.*quantity(output).of)(); }

}  // namespace hosel
