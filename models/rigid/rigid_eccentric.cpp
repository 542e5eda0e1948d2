#include "models/rigid/rigid_eccentric.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "golf/first_contact.hpp"
#include "models/rigid/restitution.hpp"

namespace hosel::models {

Launch RigidEccentric::launch(const Blow& blow) const {
  const FirstContact g = first_contact(blow);
  const Ball& ball = blow.ball;
  const Head& head = blow.club.head;
  const double approach = g.closing_speed();
  const Vec3 slip = g.slip();
  const double slip_speed = slip.norm();
  // The normal force passes offset * r from the ball's centre, on the side that adds spin.
  const Vec3 along = slip_speed > 0 ? Vec3(slip / slip_speed) : Vec3::Zero();
  const Vec3 offset = blow.contact.normal_force_offset * ball.radius * along;
  const Vec3 arm = -ball.radius * g.normal;  // from the ball's centre to P

  // A head of infinite mass is a wall: it gives way to nothing.
  const bool wall = std::isinf(head.mass);
  const Mat3 inverse_inertia = wall ? Mat3(Mat3::Zero()) : Mat3(g.head_inertia.inverse());
  const Mat3 head_mobility = Mat3::Identity() / head.mass - skew(g.head_arm) * inverse_inertia * skew(g.head_arm);
  const Mat3 ball_mobility = (1 / ball.mass + arm.squaredNorm() / ball.inertia()) * Mat3::Identity() -
                             arm * arm.transpose() / ball.inertia();
  const Mat3 K = ball_mobility + head_mobility;
  if (!K.allFinite()) throw std::invalid_argument("the head's mass and inertia must be positive");

  // Columns of `effect`: change of the relative surface velocity at P by an impulse along n (with
  // its offset couple) and across n.
  Mat3 effect = K;
  const Vec3 couple = offset.cross(g.normal) / ball.inertia();
  effect += couple.cross(arm) * g.normal.transpose();

  const double distance = std::hypot(blow.delivery.impact_toe, blow.delivery.impact_high);
  const double e = normal_restitution(blow.contact, approach, distance);
  const double et = blow.contact.tangential_restitution;
  const Vec3 wanted = (1 + e) * approach * g.normal + (1 + et) * slip;
  Vec3 J = effect.inverse() * wanted;
  const double Jn = J.dot(g.normal);
  const Vec3 Jt = J - Jn * g.normal;
  if (Jt.norm() > blow.contact.friction * Jn) {
    const Vec3 d = g.normal + blow.contact.friction * Jt.normalized();
    J = (1 + e) * approach / g.normal.dot(effect * d) * d;
  }

  Launch out;
  out.velocity = J / ball.mass;
  out.spin = (arm.cross(J) + offset.cross(g.normal) * J.dot(g.normal)) / ball.inertia();
  // The velocity of the delivery from the approach: its sines are not computed again.
  out.head_velocity = g.approach - blow.delivery.head_angular_velocity.cross(g.head_arm) - J / head.mass;
  out.head_spin = blow.delivery.head_angular_velocity - inverse_inertia * g.head_arm.cross(J);
  return out;
}

}  // namespace hosel::models
