/// A rigid head on a rigid rod that turns about its butt: the pendulum, and the hinged club of Cochran and Stobbs.
#pragma once

#include "models/impact_model.hpp"
#include "models/rigid/impulse.hpp"

namespace hosel::models {

/// The club as one rigid pendulum: head and a rigid straight rod with the shaft's mass per length, free
/// to turn about its butt in all directions; the butt keeps the velocity that the club's motion gives it.
/// After the cylinder pendulum of Tanaka et al. (reference [2] of [@shaft-influence]). Contact as stick-slip.
/// Throws std::invalid_argument where the club has no shaft.
class PendulumClub final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

/// As the pendulum club, but the head turns freely about a hinge at the hosel, whose axis is
/// perpendicular to the shaft and to the face's normal: the shaft cannot push the head on.
/// Cochran and Stobbs (1968), The Search for the Perfect Swing.
/// Throws std::invalid_argument where the club has no shaft.
class HingedHead final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

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
