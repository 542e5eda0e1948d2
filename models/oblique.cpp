#include "models/oblique.hpp"

#include <cmath>

#include "golf/first_contact.hpp"
#include "models/checked_launch.hpp"

namespace hosel::models {

std::optional<double> tangential_restitution(const Blow& blow, const Launch& launch) {
  const FirstContact g = first_contact(blow);
  const Vec3 slip = g.slip();
  if (slip.norm() < 1e-9 * g.approach.norm()) return std::nullopt;
  const bool wall = std::isinf(blow.club.head.mass);
  const Vec3 face = wall ? g.approach : Vec3(launch.head_velocity + launch.head_spin.cross(g.head_arm));
  const Vec3 ball = launch.velocity + launch.spin.cross(g.point);
  return (ball - face).dot(slip) / slip.squaredNorm();
}

std::optional<double> launch_ratio(const Blow& blow, const Launch& launch) {
  const Vec3 normal = first_contact(blow).normal;
  const double path = blow.delivery.attack_angle, face = std::atan2(normal.z(), std::hypot(normal.x(), normal.y()));
  if (std::abs(face - path) < 1e-9) return std::nullopt;
  return (launch.launch_angle() - path) / (face - path);
}

Bounce bounce(const ImpactModel& model, const Ball& ball, double speed, double angle, const ContactLaw& contact) {
  Blow blow;
  blow.ball = ball;
  blow.contact = contact;
  blow.club.head.mass = INFINITY;
  blow.delivery.club_speed = speed;  // the plate moves, the ball rests: the same thing
  blow.delivery.club_path = angle;
  const Launch launch = checked_launch(model, blow);
  const Vec3 n = first_contact(blow).normal, before = -blow.delivery.velocity();
  const Vec3 after = launch.velocity + before;
  const double v_n = -before.dot(n);
  const Vec3 across = before + v_n * n;
  const double v_t = across.norm();
  const Vec3 along = across / v_t;
  Bounce b{.speed = speed, .angle = angle};
  b.normal_restitution = after.dot(n) / v_n;
  b.tangential_ratio = after.dot(along) / v_t;
  b.spin = launch.spin.dot(n.cross(along));
  b.tangential_restitution = b.spin * ball.radius / v_t - b.tangential_ratio;
  b.rebound_angle = std::atan2(after.dot(along), after.dot(n));
  return b;
}

}  // namespace hosel::models
