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

}  // namespace hosel::loop::forms
