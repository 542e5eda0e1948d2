#include "models/rigid/impulse.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace hosel::models {

Mat6 free_head_mobility(const Blow& blow, const FirstContact& contact) {
  Mat6 y = Mat6::Zero();
  if (std::isinf(blow.club.head.mass)) return y;  // a wall gives way to nothing
  y.topLeftCorner<3, 3>() = Mat3::Identity() / blow.club.head.mass;
  y.bottomRightCorner<3, 3>() = contact.head_inertia.inverse();
  return y;
}

ImpulseProblem impulse_problem(const Blow& blow) {
  return impulse_problem(blow, free_head_mobility(blow, first_contact(blow)));
}

ImpulseProblem impulse_problem(const Blow& blow, const Mat6& head_mobility) {
  ImpulseProblem p;
  p.contact = first_contact(blow);
  p.head_mobility = head_mobility;
  p.contact.closing_speed();  // a head that moves away strikes nothing
  Eigen::Matrix<double, 3, 6> at_contact;
  at_contact << Mat3::Identity(), -skew(p.contact.head_arm);
  p.mobility = Mat3::Identity() / blow.ball.mass - skew(p.contact.point) * skew(p.contact.point) / blow.ball.inertia() +
               at_contact * head_mobility * at_contact.transpose();
  if (!p.mobility.allFinite()) throw std::invalid_argument("the head's mass and inertia must be positive");
  return p;
}

Launch launch_after(const Blow& blow, const ImpulseProblem& p, const Vec3& J) {
  Launch out;
  out.velocity = J / blow.ball.mass;
  out.spin = p.contact.point.cross(J) / blow.ball.inertia();
  Vec6 wrench;
  wrench << -J, -p.contact.head_arm.cross(J);
  const Vec6 change = p.head_mobility * wrench;
  out.head_velocity = blow.delivery.velocity() + change.head<3>();
  out.head_spin = blow.delivery.head_angular_velocity + change.tail<3>();
  return out;
}

}  // namespace hosel::models
