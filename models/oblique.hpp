/// Quantities of an oblique blow: tangential restitution, launch ratio, and the bounce off a plate.
#pragma once

#include <cmath>
#include <optional>

#include "models/impact_model.hpp"

namespace hosel::models {

/// e_t: slip of ball over face at the point of first contact after the blow, over that before it, reversed. 1 returns
/// everything, 0 rolls, below 0 the ball still slides. Ball and head are taken in the attitude of first contact. None
/// where there was no slip.
std::optional<double> tangential_restitution(const Blow& blow, const Launch& launch);

/// Where the ball starts between path and face in the vertical plane: (launch angle - attack angle) / (elevation of
/// the face's normal at the point of impact - attack angle). 1 along the normal, 0 along the path. None where the two
/// coincide. E. Henrikson et al., Proceedings 49 (2020) 27.
std::optional<double> launch_ratio(const Blow& blow, const Launch& launch);

/// A blow by a wall as a bounce off it: the ball's centre in the wall's frame.
struct WallBounce {
  double into = 0, along = 0;       ///< before: towards the wall and along it [m/s]
  double out = 0, along_after = 0;  ///< after: away from the wall; along it, in the direction of before [m/s]
  Vec3 direction = Vec3::Zero();    ///< along the wall before; zero where the ball came straight
  double restitution() const { return out / into; }
  /// From the normal; beyond pi/2 where the ball does not leave the wall [rad].
  double rebound_angle() const { return std::atan2(along_after, out); }
};
WallBounce off_wall(const Blow& blow, const Launch& launch);

/// A ball thrown at a rigid, flat plate; the plate's frame, tangential figures along the incoming slip.
struct Bounce {
  double speed = 0, angle = 0;        ///< before: of the centre [m/s]; from the normal, in (0, pi/2) [rad]
  double normal_restitution = 0;      ///< e
  double tangential_restitution = 0;  ///< e_t
  double tangential_ratio = 0;        ///< tangential velocity of the centre, after over before
  double spin = 0;                    ///< rolling along the slip positive [rad/s]
  double rebound_angle = 0;           ///< from the normal [rad]
};
/// The ball does not turn before the bounce. Throws what the model throws.
Bounce bounce(const ImpactModel& model, const Ball& ball, double speed, double angle, const ContactLaw& contact = {});

}  // namespace hosel::models
