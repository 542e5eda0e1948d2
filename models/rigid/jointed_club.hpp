/// A rigid head on a rigid rod that turns about its butt.
#pragma once

#include "models/rigid/impulse.hpp"

namespace hosel::models {

/// Mobility of the head (models/rigid/impulse.hpp) with the rod rigid at the hosel, or hinged there.
/// Generalised velocities: the rod's angular velocity and, hinged, the head's rate about the hinge;
/// mobility = B (B' M B + rod)^-1 B' with B their effect on the head's twist.
Mat6 jointed_mobility(const Blow& blow, bool hinged);

/// Velocity of the butt before the blow, global frame [m/s]: it keeps it.
Vec3 butt_velocity(const Blow& blow);
/// Kinetic energy of head and rod in the frame of the butt [J] where the head's cg moves with `velocity` past the butt
/// and the head turns with `spin` (global frame): no part of a blow but the ball gives energy there or takes it.
double jointed_energy(const Blow& blow, bool hinged, const Vec3& velocity, const Vec3& spin);

}  // namespace hosel::models
