#include "golf/first_contact.hpp"

#include <stdexcept>

namespace hosel {

double FirstContact::closing_speed() const {
  const double speed = approach.dot(normal);
  if (!(speed > 0)) throw std::invalid_argument("the head moves away from the ball");
  return speed;
}

FirstContact first_contact(const Blow& blow) {
  const Delivery& d = blow.delivery;
  const Head& head = blow.club.head;
  const double yc = -d.impact_toe, zc = d.impact_high;
  const Vec3 at = head.face.point(yc, zc);
  FirstContact c;
  c.face_axes = d.face_to_global();
  c.normal = c.face_axes * head.face.normal(yc, zc);
  c.point = -blow.ball.radius * c.normal;
  c.face_centre = c.point - c.face_axes * at;
  c.head_arm = c.face_axes * (at - head.cg);
  c.head_inertia = c.face_axes * head.inertia * c.face_axes.transpose();
  c.approach = d.velocity() + d.head_angular_velocity.cross(c.head_arm);
  return c;
}

}  // namespace hosel
