#include "golf/quantities.hpp"

#include <algorithm>
#include <array>

namespace hosel {
namespace {

using enum Dimension;

constexpr std::array<InputQuantity, kInputs> kInputTable = {{
    {"club_speed", speed, 0.5, 90, 1e-2, [](Blow& b) -> double& { return b.delivery.club_speed; }},
    {"attack_angle", angle, -0.8, 0.8, 1e-4, [](Blow& b) -> double& { return b.delivery.attack_angle; }},
    {"club_path", angle, -0.8, 0.8, 1e-4, [](Blow& b) -> double& { return b.delivery.club_path; }},
    {"face_angle", angle, -0.8, 0.8, 1e-4, [](Blow& b) -> double& { return b.delivery.face_angle; }},
    {"dynamic_loft", angle, -0.4, 1.57, 1e-4, [](Blow& b) -> double& { return b.delivery.dynamic_loft; }},
    {"impact_toe", length, -0.08, 0.08, 1e-5, [](Blow& b) -> double& { return b.delivery.impact_toe; }},
    {"impact_high", length, -0.06, 0.06, 1e-5, [](Blow& b) -> double& { return b.delivery.impact_high; }},
    {"head_mass", mass, 0.05, 1.0, 1e-5, [](Blow& b) -> double& { return b.club.head.mass; }},
}};

constexpr std::array<OutputQuantity, kOutputs> kOutputTable = {{
    {"ball_speed", speed, &Launch::ball_speed},
    {"launch_angle", angle, &Launch::launch_angle},
    {"azimuth", angle, &Launch::azimuth},
    {"backspin", angular_velocity, &Launch::backspin},
    {"sidespin", angular_velocity, &Launch::sidespin},
    {"spin_rate", angular_velocity, &Launch::spin_rate},
    {"spin_axis", angle, &Launch::spin_axis},
    {"carry", length, nullptr},
    {"side", length, nullptr},
    {"apex", length, nullptr},
    {"flight_time", time, nullptr},
    {"landing_angle", angle, nullptr},
}};

template <class Which>
std::optional<Which> row(const auto& table, std::string_view name) {
  const auto at = std::ranges::find(table, name, [](const auto& q) { return q.name; });
  return at == table.end() ? std::nullopt : std::optional(Which(at - table.begin()));
}

}  // namespace

const InputQuantity& quantity(Input input) { return kInputTable[std::size_t(input)]; }
const OutputQuantity& quantity(Output output) { return kOutputTable[std::size_t(output)]; }
std::optional<Input> input_of(std::string_view name) { return row<Input>(kInputTable, name); }
std::optional<Output> output_of(std::string_view name) { return row<Output>(kOutputTable, name); }

double get(const Blow& blow, Input input) {
  return quantity(input).of(const_cast<Blow&>(blow));  // only looked at
}
void set(Blow& blow, Input input, double value) { quantity(input).of(blow) = value; }

}  // namespace hosel
