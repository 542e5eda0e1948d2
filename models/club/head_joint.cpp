#include "models/club/head_joint.hpp"

namespace hosel::models {

fem::JointStiffness stiffness_of(const HeadJoint& joint, const Shaft& shaft, const Mat3& grip_axes) {
  fem::JointStiffness k = joint.stiffness;
  if (joint.kind == HeadJoint::Kind::hinge) {
    const double bend = 1e4 * shaft.stations.back().bending_stiffness_y / shaft.length();
    const Vec3 axis = joint.axis.normalized();
    const Vec3 towards = std::abs(axis.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    k.frame.col(0) = axis;
    k.frame.col(1) = axis.cross(towards).normalized();
    k.frame.col(2) = axis.cross(k.frame.col(1));
    k.translation = Vec3::Constant(1e4 * bend / (shaft.length() * shaft.length()));
    k.rotation = {0, bend, bend};
  }
  k.frame = (grip_axes * k.frame).eval();
  return k;
}

}  // namespace hosel::models
