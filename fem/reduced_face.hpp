/// A yielding face with a few unknowns: their inertia, their stiffness and damping, and the shapes by which they move
/// the face.
#pragma once

#include <Eigen/Core>

#include "golf/face_compliance.hpp"
#include "golf/vector.hpp"

namespace hosel::fem {

/// The face has moved inwards, along -Xc, by the sum of unknowns w_j times shapes. Integrals are over the face's mass,
/// r from the face's centre, face axes. The mass is part of the head's.
struct ReducedFace {
  Eigen::VectorXd mass;        ///< of shape_j [kg]
  Eigen::Matrix3Xd moment;     ///< of r shape_j [kg m]
  Eigen::MatrixXd transverse;  ///< of shape_i shape_j [kg]
  Eigen::MatrixXd inertia;     ///< `transverse`, and what turns or moves in the face's plane [kg]
  Eigen::MatrixXd stiffness;   ///< [N/m]
  Eigen::MatrixXd damping;     ///< [N s/m]
  Eigen::VectorXd centre;      ///< shapes at the face's centre

  Eigen::Index size() const { return mass.size(); }
  /// A particle of the effective mass at the face's centre, whose travel is the unknown. Throws
  /// std::invalid_argument on a face that cannot be.
  static ReducedFace lumped(const FaceCompliance& face);
};

}  // namespace hosel::fem
