/// The effects' forms, one function per file of this folder.
#pragma once

#include "loop/effect.hpp"

namespace hosel::loop::forms {

using OnShots = std::vector<Parametrisation>(const Setting&);
OnShots ball_tangential_compliance, friction_limit, restitution_law, restitution_falloff, face_compliance,
    head_rotation, head_mass, head_inertia, shaft_coupling, cg_shift, head_closure, ball_inertia, normal_force_offset,
    loft_bias, monitor_misalignment, session_drift, ball_cover_stiffness, ball_relaxation, hosel_place, shaft_stiffness,
    drag_level, lift_law, spin_decay, air_density, wind, spin_axis_bias;

using OnTests = std::vector<Parametrisation>(const HistorySetting&);
OnTests shaft_stiffness, shaft_damping, clamp_compliance, hosel_compliance, tip_mass, head_inertia, cg_shift,
    rotational_stiffening, sensor_delay, sensor_gain, sensor_offset;

}  // namespace hosel::loop::forms
