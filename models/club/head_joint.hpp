/// The joint between the shaft's tip and the head's node in one fem::System.
#pragma once

#include "fem/supports.hpp"
#include "golf/shaft.hpp"

namespace hosel::models {

struct HeadJoint {
  enum class Kind {
    rigid,   ///< head and tip share a node
    hinge,   ///< turns freely about one axis
    spring,  ///< six stiffnesses
    none,    ///< no head (swings and modes only)
  };
  Kind kind = Kind::rigid;
  /// Of the hinge, grip axes of the unbent club; YG lies across the shaft and the face's normal, so that the head of a
  /// hinge about it gives way to the ball as that of Cochran and Stobbs (1968).
  Vec3 axis = Vec3::UnitY();
  fem::JointStiffness stiffness = {};  ///< of springs, along and about the grip's axes

  bool gives() const { return kind == Kind::hinge || kind == Kind::spring; }
  bool hinge_across() const { return kind == Kind::hinge && axis.cross(Vec3::UnitY()).norm() < 1e-9 * axis.norm(); }
};

/// Of a joint that gives, in a system whose reference placement has `grip_axes` as columns. A hinge lets one axis go
/// and holds the rest as a weld would: stiff against the shaft's own tip, soft enough for the tangent's conditioning.
fem::JointStiffness stiffness_of(const HeadJoint& joint, const Shaft& shaft, const Mat3& grip_axes);

}  // namespace hosel::models
