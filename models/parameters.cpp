#include "models/parameters.hpp"

#include <algorithm>
#include <array>

#include "golf/units.hpp"
#include "models/sliding_friction.hpp"

namespace hosel::models {
namespace {

// A parameter that is one number of the blow or of the options.
#define PLAIN(name, unit, low, high, place)   \
  NamedParameter {                            \
    name, unit, low, high,                    \
        [](const Options& o, const Blow& b) { \
          (void)o, (void)b;                   \
          return double(place);               \
        },                                    \
        [](Options& o, Blow& b, double x) {   \
          (void)o, (void)b;                   \
          (place) = x;                        \
        }                                     \
  }
// An error of the recorded delivery: zero in the record, added to what a shot says.
#define OFFSET(name, unit, low, high, place)                                \
  NamedParameter {                                                          \
    name, unit, low, high, [](const Options&, const Blow&) { return 0.0; }, \
        [](Options&, Blow& b, double x) { (place) += x; }                   \
  }

constexpr double kTurn = 1.5;  // [rad]
constexpr double kError = radians(10);

/// Sets the coefficient of sliding; that of vanishing slip keeps its ratio to it.
void slide(VolumetricLaw& law, double friction) {
  law.static_friction = law.friction > 0 ? friction * (law.static_friction / law.friction) : friction;
  law.friction = friction;
}

constexpr std::array kParameters = {
    PLAIN("club_speed", "mps", 0.1, 150, b.delivery.club_speed),
    PLAIN("attack_angle", "deg", -kTurn, kTurn, b.delivery.attack_angle),
    PLAIN("club_path", "deg", -kTurn, kTurn, b.delivery.club_path),
    PLAIN("face_angle", "deg", -kTurn, kTurn, b.delivery.face_angle),
    PLAIN("dynamic_loft", "deg", -kTurn, kTurn, b.delivery.dynamic_loft),
    PLAIN("impact_toe", "mm", -0.1, 0.1, b.delivery.impact_toe),
    PLAIN("impact_high", "mm", -0.1, 0.1, b.delivery.impact_high),
    PLAIN("head_mass", "kg", 0.15, 0.35, b.club.head.mass),
    PLAIN("cg_x", "mm", -0.08, 0.02, b.club.head.cg.x()),
    PLAIN("cg_y", "mm", -0.03, 0.03, b.club.head.cg.y()),
    PLAIN("cg_z", "mm", -0.03, 0.03, b.club.head.cg.z()),
    PLAIN("inertia_x", "kg_m2", 2e-5, 2e-3, b.club.head.inertia(0, 0)),
    PLAIN("inertia_y", "kg_m2", 2e-5, 2e-3, b.club.head.inertia(1, 1)),
    PLAIN("inertia_z", "kg_m2", 2e-5, 2e-3, b.club.head.inertia(2, 2)),
    PLAIN("restitution", "", 0.3, 1.0, b.contact.restitution),
    PLAIN("restitution_slope", "s_per_m", -0.02, 0.01, b.contact.restitution_slope),
    PLAIN("restitution_falloff", "",  // [1/m^2]
          -200, 500, b.contact.restitution_falloff),
    PLAIN("tangential_restitution", "", -0.5, 1.0, b.contact.tangential_restitution),
    PLAIN("friction", "", 0.0, 2.0, b.contact.friction),
    PLAIN("normal_force_offset", "", -0.3, 0.3, b.contact.normal_force_offset),
    PLAIN("volumetric_stiffness", "N_per_m3", 1e8, 1e11, o.volumetric.stiffness),
    PLAIN("volume_exponent", "", 0.5, 1.5, o.volumetric.volume_exponent),
    PLAIN("volumetric_damping", "s_per_m", 0.0, 0.05, o.volumetric.damping),
    NamedParameter{"volumetric_friction", "", 0.01, 2.0,
                   [](const Options& o, const Blow&) { return o.volumetric.friction; },
                   [](Options& o, Blow&, double x) { slide(o.volumetric, x); }},
    PLAIN("volumetric_transition_speed", "mps", 0.01, 20.0, o.volumetric.transition_speed),
    PLAIN("joint_stiffness", "N_m_per_rad", 0.1, 1e4, o.volumetric.joint_stiffness),
    PLAIN("joint_damping", "N_m_s_per_rad", 0.0, 1.0, o.volumetric.joint_damping),
    PLAIN("cover_thickness", "mm", 1e-4, 1e-2, o.volumetric.cover_thickness),
    NamedParameter{"common_friction", "", 0.01, 2.0, [](const Options&, const Blow& b) { return b.contact.friction; },
                   [](Options& o, Blow& b, double x) {
                     slide(o.volumetric, x);
                     models::slide(b.contact.patch, x);
                     b.contact.friction = o.hertz_maw.friction = x;
                   }},
    PLAIN("hertz_modulus", "MPa", 1e6, 1e9, o.hertz_maw.modulus),
    PLAIN("hertz_poisson", "", 0.0, 0.5, o.hertz_maw.poisson),
    PLAIN("hertz_friction", "", 0.0, 2.0, o.hertz_maw.friction),
    PLAIN("hertz_damping", "s_per_m", 0.0, 0.05, o.hertz_maw.damping),
    OFFSET("loft_error", "deg", -kError, kError, b.delivery.dynamic_loft),
    OFFSET("face_error", "deg", -kError, kError, b.delivery.face_angle),
    OFFSET("path_error", "deg", -kError, kError, b.delivery.club_path),
    OFFSET("attack_error", "deg", -kError, kError, b.delivery.attack_angle),
    OFFSET("toe_error", "mm", -0.03, 0.03, b.delivery.impact_toe),
    OFFSET("high_error", "mm", -0.03, 0.03, b.delivery.impact_high),
};
#undef PLAIN
#undef OFFSET

}  // namespace

std::span<const NamedParameter> parameters() { return kParameters; }

const NamedParameter* find_parameter(std::string_view name) {
  const auto it = std::ranges::find(kParameters, name, &NamedParameter::name);
  return it == kParameters.end() ? nullptr : &*it;
}

}  // namespace hosel::models
