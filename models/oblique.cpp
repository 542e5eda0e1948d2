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

WallBounce off_wall(const Blow& blow, const Launch& launch) {
  const Vec3 n = first_contact(blow).normal, before = -blow.delivery.velocity(), after = launch.velocity + before;
  WallBounce w{.into = -before.dot(n), .out = after.dot(n)};
  const Vec3 across = before + w.into * n;
  w.along = across.norm();
  if (w.along > 0) w.direction = across / w.along;
  w.along_after = after.dot(w.direction);
  return w;
}

Bounce bounce(const ImpactModel& model, const Ball& ball, double speed, double angle, const ContactLaw& contact) {
  Blow blow;
  blow.ball = ball;
  blow.contact = contact;
  blow.club.head.mass = INFINITY;
  blow.delivery.club_speed = speed;  // the plate moves, the ball rests: the same thing
  blow.delivery.club_path = angle;
  const Launch launch = checked_launch(model, blow);
  const WallBounce w = off_wall(blow, launch);
  Bounce b{.speed = speed, .angle = angle};
  b.normal_restitution = w.restitution();
  b.tangential_ratio = w.along_after / w.along;
  b.spin = launch.spin.dot(first_contact(blow).normal.cross(w.direction));
  b.tangential_restitution = b.spin * ball.radius / w.along - b.tangential_ratio;
  b.rebound_angle = w.rebound_angle();
  return b;
}

}  // namespace hosel::models
