/// Where and how ball and face meet.
#pragma once

#include "golf/blow.hpp"

namespace hosel {

/// First contact in the global frame, origin at the ball's centre.
struct FirstContact {
  Mat3 face_axes;     ///< columns: face frame in the global one
  Vec3 face_centre;   ///< [m]
  Vec3 point;         ///< contact point P on the face [m]
  Vec3 normal;        ///< unit, out of the face, at P
  Vec3 head_arm;      ///< from the head's centre of gravity to P [m]
  Mat3 head_inertia;  ///< about the cg, global axes [kg m^2]
  Vec3 approach;      ///< velocity of the head's surface at P [m/s]

  /// Speed at which they close along the normal [m/s]. Throws std::invalid_argument where the head moves away.
  double closing_speed() const;
  Vec3 slip() const { return approach - approach.dot(normal) * normal; }  ///< of the face past the ball [m/s]
};
FirstContact first_contact(const Blow& blow);

}  // namespace hosel
