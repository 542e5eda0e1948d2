#include "golf/units.hpp"

#include <array>

namespace hosel {
namespace {

using enum Dimension;
constexpr double kKgPerPound = 0.45359237;
constexpr std::array kUnits = {
    Unit{"m", length, 1.0},
    Unit{"mm", length, 1e-3},
    Unit{"um", length, 1e-6},
    Unit{"yd", length, 0.9144},
    Unit{"rad", angle, 1.0},
    Unit{"deg", angle, kRadPerDeg},
    Unit{"mps", speed, 1.0},
    Unit{"kmh", speed, 1.0 / 3.6},
    Unit{"mph", speed, kMpsPerMph},
    Unit{"rad_per_s", angular_velocity, 1.0},
    Unit{"rpm", angular_velocity, kRadPerSecPerRpm},
    Unit{"deg_per_s", angular_velocity, kRadPerDeg},
    Unit{"kg", mass, 1.0},
    Unit{"g", mass, 1e-3},
    Unit{"s", time, 1.0},
    Unit{"ms", time, 1e-3},
    Unit{"us", time, 1e-6},
    Unit{"Hz", frequency, 1.0},
    Unit{"kHz", frequency, 1e3},
    Unit{"cpm", frequency, 1.0 / 60.0},
    Unit{"N", force, 1.0},
    Unit{"kN", force, 1e3},
    Unit{"N_m", moment, 1.0},
    Unit{"Pa", pressure, 1.0},
    Unit{"hPa", pressure, 1e2},
    Unit{"kPa", pressure, 1e3},
    Unit{"MPa", pressure, 1e6},
    Unit{"GPa", pressure, 1e9},
    Unit{"kg_per_m3", density, 1.0},
    Unit{"kg_m2", inertia, 1.0},
    Unit{"g_cm2", inertia, 1e-7},
    Unit{"N_m2", bending_stiffness, 1.0},
    Unit{"kg_per_m", line_density, 1.0},
    Unit{"g_per_m", line_density, 1e-3},
    Unit{"N_per_m", translational_stiffness, 1.0},
    Unit{"MN_per_m", translational_stiffness, 1e6},
    Unit{"N_m_per_rad", rotational_stiffness, 1.0},
    Unit{"N_s_per_m", translational_damping, 1.0},
    Unit{"N_m_s_per_rad", rotational_damping, 1.0},
    Unit{"N_per_m3", volume_stiffness, 1.0},
    Unit{"s_per_m", inverse_speed, 1.0},
    Unit{"m_per_s2", acceleration, 1.0},
    Unit{"J", energy, 1.0},
    Unit{"m2", area, 1.0},
    Unit{"mm2", area, 1e-6},
    Unit{"pct", percent, 0.01},
    // Not in units().
    Unit{"in", length, 0.0254},
    Unit{"ft", length, 0.3048},
    Unit{"oz", mass, kKgPerPound / 16},
    Unit{"lb", mass, kKgPerPound},
    Unit{"lbf", force, kKgPerPound* kGravity},
};
constexpr std::size_t kWrittenAlone = 5;

}  // namespace

std::span<const Unit> all_units() { return kUnits; }
std::span<const Unit> units() { return all_units().first(kUnits.size() - kWrittenAlone); }

std::string_view name(Dimension dimension) {
  switch (dimension) {
    case length: return "length";
    case angle: return "angle";
    case speed: return "speed";
    case angular_velocity: return "angular velocity";
    case mass: return "mass";
    case time: return "time";
    case frequency: return "frequency";
    case force: return "force";
    case moment: return "moment";
    case pressure: return "pressure";
    case density: return "density";
    case inertia: return "moment of inertia";
    case bending_stiffness: return "bending stiffness";
    case line_density: return "mass per length";
    case translational_stiffness: return "stiffness";
    case rotational_stiffness: return "rotational stiffness";
    case translational_damping: return "damping";
    case rotational_damping: return "rotational damping";
    case volume_stiffness: return "volumetric stiffness";
    case inverse_speed: return "inverse speed";
    case acceleration: return "acceleration";
    case energy: return "energy";
    case area: return "area";
    case percent: return "percentage";
  }
  return "";
}

SplitName split_unit(std::string_view name) {
  const Unit* best = nullptr;
  for (const Unit& unit : kUnits) {
    if (name.size() < unit.suffix.size() + 2) continue;
    const auto at = name.size() - unit.suffix.size();
    if (name.substr(at) != unit.suffix || name[at - 1] != '_') continue;
    if (!best || unit.suffix.size() > best->suffix.size()) best = &unit;
  }
  if (!best) return {std::string(name), std::nullopt};
  return {std::string(name.substr(0, name.size() - best->suffix.size() - 1)), *best};
}

}  // namespace hosel
