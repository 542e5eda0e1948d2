#include "models/fe/contact_frame.hpp"

#include <algorithm>
#include <cmath>

namespace hosel::models {

ContactFrame contact_frame(const Blow& blow) {
  const Delivery& d = blow.delivery;
  const Head& head = blow.club.head;
  ContactFrame e{first_contact(blow)};
  e.normal_speed = e.closing_speed();
  const Vec3 slip = e.slip(), &arm = e.head_arm;
  const bool sliding = slip.norm() > 1e-12 * e.approach.norm();
  const bool wall = std::isinf(head.mass);
  Vec3 across = arm - arm.dot(e.normal) * e.normal;  // of the head's centre: the other direction that matters
  const bool central = wall || across.norm() <= 1e-9 * (arm.norm() + blow.ball.radius);
  const bool curved = std::isfinite(head.face.bulge) || std::isfinite(head.face.roll);
  const double tolerance = 1e-9;

  Vec3 direction = sliding ? Vec3(slip) : !central ? across : Vec3(e.face_axes.col(2));
  direction = (direction - direction.dot(e.normal) * e.normal).normalized();
  e.ball_axes.col(0) = -e.normal;
  e.ball_axes.col(1) = direction;
  e.ball_axes.col(2) = e.ball_axes.col(0).cross(direction);
  const Vec3 m = e.ball_axes.col(2);

  // Symmetric about the plane of normal and slip: velocities, arm, inertia and curved face all are.
  const Mat3 inertia = wall ? Mat3(Mat3::Identity()) : e.head_inertia;
  const Vec3 coupling = inertia * m - m.dot(inertia * m) * m;
  const Vec3& w = d.head_angular_velocity;
  e.planar = (wall || std::abs(arm.dot(m)) <= tolerance) && (w - w.dot(m) * m).norm() <= tolerance &&
             (wall || coupling.norm() <= 1e-6 * inertia.trace() || std::isinf(inertia.trace())) &&
             std::abs(d.velocity().dot(m)) <= tolerance * (1 + d.club_speed);
  const Vec3 local = e.face_axes.transpose() * m;
  const bool aligned = std::abs(local.y()) < tolerance || std::abs(local.z()) < tolerance;
  e.principal = aligned && std::abs((e.point - e.face_centre).dot(m)) <= tolerance;
  e.planar = e.planar && (!curved || e.principal);
  e.across_heel_toe = std::abs(local.y()) >= tolerance;
  e.axial = !sliding && central && !curved && w.norm() == 0 &&
            (wall || head.inertia.allFinite() || std::isinf(head.inertia.trace()));
  return e;
}

double hertz_time(double mass, double radius, double young, double speed) {
  const double e = young / (1 - 0.25);  // plane-strain modulus of an incompressible ball
  return 2.868 * std::pow(mass * mass / (radius * e * e * speed), 0.2);
}

double expected_turn(const ContactFrame& e, const Blow& blow, double young) {
  const Ball& ball = blow.ball;
  const double slip = (e.approach - e.normal_speed * e.normal).norm();
  const double gripping = 1.3 * slip / (1 + 1 / ball.inertia_factor + ball.mass / blow.club.head.mass),
               sliding = 1.8 * blow.contact.patch.coefficient * e.normal_speed;
  const double spin = std::min(gripping, sliding) / (ball.inertia_factor * ball.radius);
  return 0.8 * spin * hertz_time(ball.mass, ball.radius, young, e.normal_speed);
}

}  // namespace hosel::models
