/// A rigid head on a rigid rod that turns about its butt.
#pragma once

#include "models/rigid/impulse.hpp"

namespace hosel::models {

/// Mobility of the head (models/rigid/impulse.hpp) with the rod rigid at the hosel, or hinged there.
/// Generalised velocities: the rod's angular velocity and, hinged, the head's rate about the hinge;
/// mobility = B (B' M B + rod)^-1 B' with B their effect on the head's twist.
Mat6 jointed_mobility(const Blow& blow, bool hinged);

}  // namespace hosel::models
