#include <algorithm>
#include <array>

#include "hosel/loop/effects/all.hpp"

namespace hosel::loop {
namespace {

using namespace forms;
constexpr std::array kEffects = {
    EffectEntry{"ball-tangential-compliance",
                "tangential energy stored in the ball and given back: more spin than rolling",
                "slip at the end of contact (high-speed video of the ball's markings)", ball_tangential_compliance},
    EffectEntry{"friction-limit", "the ball slides throughout at high obliquity: spin below rolling",
                "friction coefficient of face and cover", friction_limit},
    EffectEntry{"restitution-law", "level or speed dependence of the normal coefficient of restitution",
                "head speed after impact", restitution_law},
    EffectEntry{"restitution-falloff", "restitution drops away from the face centre",
                "normal restitution of the bare face at several points", restitution_falloff},
    EffectEntry{"head-rotation", "a free head turns under an off-centre blow (gear effect)",
                "angular velocity of the head after impact", head_rotation},
    EffectEntry{"head-mass", "effective head mass differs from the declared one", "head speed after impact", head_mass},
    EffectEntry{"head-inertia", "effective rotational inertia differs (a shaft resists the turn)",
                "angular velocity of the head after impact", head_inertia},
    EffectEntry{"shaft-coupling", "the club behind the head, where the base is a free head",
                "velocity and angular velocity of the head after impact, with and without shaft", shaft_coupling},
    EffectEntry{"cg-shift", "the centre of gravity is not where it is declared",
                "centre of gravity of the head (balance)", cg_shift},
    EffectEntry{"head-closure", "the head has an angular velocity at impact",
                "angular velocity of the head before impact", head_closure},
    EffectEntry{"ball-inertia", "the ball's moment of inertia is not the declared one",
                "moment of inertia of the ball (torsion pendulum)", ball_inertia},
    EffectEntry{"normal-force-offset", "the resultant normal force does not pass through the ball's centre",
                "contact patch over time (pressure film, high-speed video)", normal_force_offset},
    EffectEntry{"loft-bias", "the recorded loft is not the loft that the ball met",
                "loft by a second instrument (camera at impact)", loft_bias},
    EffectEntry{"monitor-misalignment", "the launch monitor's axes are turned against the target frame",
                "the monitor's axes against a surveyed line", monitor_misalignment},
    EffectEntry{"session-drift", "something drifts slowly and steadily with the shot number",
                "a repeated reference shot through the session", session_drift},
};

}  // namespace

std::span<const EffectEntry> effects() { return kEffects; }

const EffectEntry* find_effect(std::string_view name) {
  const auto it = std::ranges::find(kEffects, name, &EffectEntry::name);
  return it == kEffects.end() ? nullptr : &*it;
}

}  // namespace hosel::loop
