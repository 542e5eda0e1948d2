/// What the contact may do that no effect of the library says: of a part of the rows, or in one direction of the face.
#pragma once

#include <array>

#include "loop/effect.hpp"

namespace hosel::loop {

struct ContactChange {
  Parametrisation form;  ///< one parameter: the change
  double largest;        ///< that is plausible
};

/// Another ball: restitution, tangential restitution.
std::array<ContactChange, 2> of_another_ball();
/// Tangential energy comes back along one axis of the face alone: across it, up it.
std::array<ContactChange, 2> of_one_direction();

}  // namespace hosel::loop
