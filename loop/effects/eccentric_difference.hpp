#pragma once

#include "models/rigid/rigid_eccentric.hpp"

namespace hosel::loop::forms {

/// For bases that do not compute the difference between two blows: the difference by the closed-form eccentric impact.
inline void add_difference(const Blow& with, const Blow& without, double amount, Launch& launch) {
  static const models::RigidEccentric model;
  const Launch a = model.launch(with), b = model.launch(without);
  launch.velocity += amount * (a.velocity - b.velocity);
  launch.spin += amount * (a.spin - b.spin);
  launch.head_velocity += amount * (a.head_velocity - b.head_velocity);
  launch.head_spin += amount * (a.head_spin - b.head_spin);
}

}  // namespace hosel::loop::forms
