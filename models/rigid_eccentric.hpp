/// The eccentric impact of a rigid ball on a free rigid head in three dimensions.
#pragma once

#include "hosel/models/impact_model.hpp"

namespace hosel::models {

/// Where ball and face meet, in the global frame with the origin at the ball's centre.
struct ContactGeometry {
  Vec3 point;         ///< contact point P on the face [m]
  Vec3 normal;        ///< unit, out of the face, at P
  Vec3 head_arm;      ///< from the head's centre of gravity to P [m]
  Mat3 head_inertia;  ///< about the cg, global axes [kg m^2]
  Vec3 approach;      ///< velocity of the head's surface at P before the blow [m/s]
};
ContactGeometry contact_geometry(const Blow& blow);

/// One impulse J acts on ball and head at P. After it the surfaces separate with e times the
/// approach speed along n and -e_t times the approach slip across it (0 sticks); where that needs
/// more than friction allows, the ball slides throughout with |J_t| = mu J_n.
/// Contact mobility K = 1/m + 1/M - [a] I_b^-1 [a] - [c] I_h^-1 [c]; specification "Two base models".
class RigidEccentric final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

}  // namespace hosel::models
