#include "models/rigid/jointed_club.hpp"

#include <stdexcept>

#include "golf/dense.hpp"
#include "models/rigid/stick_slip.hpp"

namespace hosel::models {
namespace {

/// The hosel and the head's cg from the butt, face axes.
struct FromButt {
  Vec3 axis, hosel, cg;
  explicit FromButt(const Club& club) {
    if (!club.shaft || club.shaft->stations.size() < 2)
      throw std::invalid_argument("this model needs a club with a shaft");
    axis = club.geometry.shaft_axis.normalized();
    hosel = -club.shaft->length() * axis;
    cg = hosel + club.head.cg - club.geometry.hosel;
  }
};

/// Generalised velocities' effect on the head's twist, and their mass; face axes.
struct Jointed {
  Eigen::MatrixXd B, mass;
};

Jointed jointed(const Blow& blow, bool hinged) {
  const Club& club = blow.club;
  const auto [axis, hosel, cg] = FromButt(club);
  const Vec3 hinge = axis.cross(Vec3::UnitX()).normalized();

  double second_moment = 0, about_axis = 0, across = 0;
  const auto& st = club.shaft->stations;
  for (std::size_t i = 1; i < st.size(); ++i) {
    const double s[3] = {st[i - 1].arc_length, (st[i - 1].arc_length + st[i].arc_length) / 2, st[i].arc_length};
    const double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};  // Simpson: exact for the cubic mass(s) s^2
    for (int k = 0; k < 3; ++k) {
      const ShaftStation at = club.shaft->at(s[k]);
      const double w = weight[k] * (s[2] - s[0]);
      second_moment += w * at.mass_per_length * s[k] * s[k];
      about_axis += w * (at.rotary_inertia_y + at.rotary_inertia_z);
      across += w * (at.rotary_inertia_y + at.rotary_inertia_z) / 2;
    }
  }
  const Mat3 along = axis * axis.transpose();
  const Mat3 rod = (second_moment + across) * (Mat3::Identity() - along) + about_axis * along;

  const int n = hinged ? 4 : 3;
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(6, n), mass = Eigen::MatrixXd::Zero(n, n);
  B.topLeftCorner(3, 3) = -skew(cg);
  B.bottomLeftCorner(3, 3) = Mat3::Identity();
  if (hinged) {
    B.topRightCorner(3, 1) = hinge.cross(cg - hosel);
    B.bottomRightCorner(3, 1) = hinge;
  }
  Mat6 head = Mat6::Zero();
  head.topLeftCorner<3, 3>() = club.head.mass * Mat3::Identity();
  head.bottomRightCorner<3, 3>() = club.head.inertia;
  mass = dense::congruent(head, B);
  mass.topLeftCorner(3, 3) += rod;
  return {B, mass};
}

Launch jointed_launch(const Blow& blow, bool hinged) {
  const ImpulseProblem p = impulse_problem(blow, jointed_mobility(blow, hinged));
  return launch_after(blow, p, stick_slip_path(blow, p).impulse);
}

}  // namespace

Launch PendulumClub::launch(const Blow& blow) const { return jointed_launch(blow, false); }

Launch HingedHead::launch(const Blow& blow) const { return jointed_launch(blow, true); }

Mat6 jointed_mobility(const Blow& blow, bool hinged) {
  const auto [B, mass] = jointed(blow, hinged);
  const Mat6 face = dense::congruent(dense::inverse(mass), B.transpose());
  Mat6 turn = Mat6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = blow.delivery.face_to_global();
  return turn * face * turn.transpose();
}

Vec3 butt_velocity(const Blow& blow) {
  const Vec3 cg = blow.delivery.face_to_global() * FromButt(blow.club).cg;
  return blow.delivery.velocity() - blow.delivery.head_angular_velocity.cross(cg);
}

double jointed_energy(const Blow& blow, bool hinged, const Vec3& velocity, const Vec3& spin) {
  const auto [B, mass] = jointed(blow, hinged);
  const Mat3 to_face = blow.delivery.face_to_global().transpose();
  Vec6 twist;
  twist << to_face * velocity, to_face * spin;
  const Eigen::VectorXd rates = dense::PivotedQr(B).solve(Eigen::VectorXd(twist));
  return rates.dot(mass * rates) / 2;
}

}  // namespace hosel::models
