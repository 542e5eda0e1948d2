#include "models/rigid/rigid_planar.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/rigid/restitution.hpp"

namespace hosel::models {

Launch RigidPlanar::launch(const Blow& blow) const {
  const Delivery& d = blow.delivery;
  const Ball& ball = blow.ball;
  const double M = blow.club.head.mass, m = ball.mass, r = ball.radius, I = ball.inertia();
  const double a = d.dynamic_loft - d.attack_angle;  // spin loft
  const double approach = d.club_speed * std::cos(a);
  if (!(M > 0)) throw std::invalid_argument("the head has no mass");
  if (!(approach > 0)) throw std::invalid_argument("the head moves away from the ball");

  const double distance = std::hypot(d.impact_toe, d.impact_high);
  const double e = normal_restitution(blow.contact, approach, distance);
  const double vn = approach * (1 + e) / (1 + m / M);
  const double arm = blow.contact.normal_force_offset * r;
  // The offset normal impulse already spins the ball: friction need not close that part of the slip.
  const double closed = d.club_speed * std::sin(a) * (1 + blow.contact.tangential_restitution) - arm * r * m * vn / I;
  double vp = closed / (1 + m / M + m * r * r / I);
  vp = std::clamp(vp, -blow.contact.friction * vn, blow.contact.friction * vn);
  const double spin = m * (vp * r + arm * vn) / I;

  const double up = d.dynamic_loft - std::atan2(vp, vn), speed = std::hypot(vn, vp);
  Launch out;
  out.velocity = speed * Vec3(std::cos(up), 0, std::sin(up));
  out.spin = Vec3(0, -spin, 0);
  const Vec3 head_in = d.club_speed * Vec3(std::cos(d.attack_angle), 0, std::sin(d.attack_angle));
  out.head_velocity = head_in - m / M * out.velocity;
  out.head_spin = d.head_angular_velocity;  // a blow in the plane of the centres turns no head
  return out;
}

}  // namespace hosel::models
