/// The effects' forms, one function per file of this folder.
#pragma once

#include "hosel/loop/effect.hpp"

namespace hosel::loop::forms {

std::vector<Form> ball_tangential_compliance(const Setting&);
std::vector<Form> friction_limit(const Setting&);
std::vector<Form> restitution_law(const Setting&);
std::vector<Form> restitution_falloff(const Setting&);
std::vector<Form> head_rotation(const Setting&);
std::vector<Form> head_mass(const Setting&);
std::vector<Form> head_inertia(const Setting&);
std::vector<Form> shaft_coupling(const Setting&);
std::vector<Form> cg_shift(const Setting&);
std::vector<Form> head_closure(const Setting&);
std::vector<Form> ball_inertia(const Setting&);
std::vector<Form> normal_force_offset(const Setting&);
std::vector<Form> loft_bias(const Setting&);
std::vector<Form> monitor_misalignment(const Setting&);
std::vector<Form> session_drift(const Setting&);

std::vector<Form> shaft_stiffness(const HistorySetting&);
std::vector<Form> shaft_damping(const HistorySetting&);
std::vector<Form> clamp_compliance(const HistorySetting&);
std::vector<Form> hosel_compliance(const HistorySetting&);
std::vector<Form> tip_mass(const HistorySetting&);
std::vector<Form> head_inertia(const HistorySetting&);
std::vector<Form> cg_shift(const HistorySetting&);
std::vector<Form> rotational_stiffening(const HistorySetting&);
std::vector<Form> sensor_delay(const HistorySetting&);
std::vector<Form> sensor_gain(const HistorySetting&);
std::vector<Form> sensor_offset(const HistorySetting&);

}  // namespace hosel::loop::forms
