/// How the head arrives at the ball, at first contact. Signs and frames: docs/code.md.
#pragma once

#include "golf/vector.hpp"

namespace hosel {

struct Delivery {
  double club_speed = 0;                      ///< magnitude of the velocity of the head's centre of gravity [m/s]
  double attack_angle = 0;                    ///< positive upwards [rad]
  double club_path = 0;                       ///< positive right of target [rad]
  double dynamic_loft = 0;                    ///< of the face at its centre [rad]
  double face_angle = 0;                      ///< positive right of target (open) [rad]
  double impact_toe = 0;                      ///< from the face centre, positive towards the toe [m]
  double impact_high = 0;                     ///< from the face centre, positive up the face [m]
  Vec3 head_angular_velocity = Vec3::Zero();  ///< global frame [rad/s]

  /// Velocity of the head's centre of gravity, global frame [m/s].
  Vec3 velocity() const;
  /// Columns are the face axes (Xc out of the face, Yc to the heel, Zc up) in the global frame.
  Mat3 face_to_global() const;
};

}  // namespace hosel
