/// What club and contact may do that no effect of the library says: of a part of the rows, or in one direction of the
/// face.
#pragma once

#include <array>

#include "loop/effect.hpp"

namespace hosel::loop {

struct ContactChange {
  Parametrisation form;  ///< one parameter: the change
  double largest;        ///< that is plausible
};

/// Another ball: restitution, tangential restitution, inertia.
std::array<ContactChange, 3> of_another_ball();
/// Another head: its centre of gravity along each axis of the face.
std::array<ContactChange, 3> of_another_head();
/// Along one axis of the face alone, across it or up it: tangential energy comes back; a share of the impulse is not
/// transmitted.
std::array<ContactChange, 4> of_one_direction();

}  // namespace hosel::loop
