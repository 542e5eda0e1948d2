/// The effects' forms, one function per file of this folder.
#pragma once

#include "loop/effect.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> ball_tangential_compliance(const Setting&);
std::vector<Parametrisation> friction_limit(const Setting&);
std::vector<Parametrisation> restitution_law(const Setting&);
std::vector<Parametrisation> restitution_falloff(const Setting&);
std::vector<Parametrisation> face_compliance(const Setting&);
std::vector<Parametrisation> head_rotation(const Setting&);
std::vector<Parametrisation> head_mass(const Setting&);
std::vector<Parametrisation> head_inertia(const Setting&);
std::vector<Parametrisation> shaft_coupling(const Setting&);
std::vector<Parametrisation> cg_shift(const Setting&);
std::vector<Parametrisation> head_closure(const Setting&);
std::vector<Parametrisation> ball_inertia(const Setting&);
std::vector<Parametrisation> normal_force_offset(const Setting&);
std::vector<Parametrisation> loft_bias(const Setting&);
std::vector<Parametrisation> monitor_misalignment(const Setting&);
std::vector<Parametrisation> session_drift(const Setting&);
std::vector<Parametrisation> ball_cover_stiffness(const Setting&);
std::vector<Parametrisation> ball_relaxation(const Setting&);
std::vector<Parametrisation> hosel_place(const Setting&);
std::vector<Parametrisation> shaft_stiffness(const Setting&);

std::vector<Parametrisation> drag_level(const Setting&);
std::vector<Parametrisation> lift_law(const Setting&);
std::vector<Parametrisation> spin_decay(const Setting&);
std::vector<Parametrisation> air_density(const Setting&);
std::vector<Parametrisation> wind(const Setting&);
std::vector<Parametrisation> spin_axis_bias(const Setting&);

std::vector<Parametrisation> shaft_stiffness(const HistorySetting&);
std::vector<Parametrisation> shaft_damping(const HistorySetting&);
std::vector<Parametrisation> clamp_compliance(const HistorySetting&);
std::vector<Parametrisation> hosel_compliance(const HistorySetting&);
std::vector<Parametrisation> tip_mass(const HistorySetting&);
std::vector<Parametrisation> head_inertia(const HistorySetting&);
std::vector<Parametrisation> cg_shift(const HistorySetting&);
std::vector<Parametrisation> rotational_stiffening(const HistorySetting&);
std::vector<Parametrisation> sensor_delay(const HistorySetting&);
std::vector<Parametrisation> sensor_gain(const HistorySetting&);
std::vector<Parametrisation> sensor_offset(const HistorySetting&);

}  // namespace hosel::loop::forms
