#include "models/rigid/jointed_club.hpp"

#include <Eigen/LU>
#include <stdexcept>

namespace hosel::models {

Mat6 jointed_mobility(const Blow& blow, bool hinged) {
  const Club& club = blow.club;
  if (!club.shaft || club.shaft->stations.size() < 2)
    throw std::invalid_argument("this model needs a club with a shaft");
  // Face axes; the butt is the origin.
  const Vec3 axis = club.geometry.shaft_axis.normalized();
  const Vec3 hosel = -club.shaft->length() * axis, cg = hosel + club.head.cg - club.geometry.hosel;
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
  mass = B.transpose() * head * B;
  mass.topLeftCorner(3, 3) += rod;
  const Mat6 face = B * mass.inverse() * B.transpose();
  Mat6 turn = Mat6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = blow.delivery.face_to_global();
  return turn * face * turn.transpose();
}

}  // namespace hosel::models
