/// Angular functions about the axis of revolution: how a displacement varies with theta.
#pragma once

#include <vector>

#include "golf/vector.hpp"

namespace hosel::fem {

/// One unknown's direction over theta, in Cartesian components (1 along the axis, 2 where theta = 0,
/// 3 where theta = 90 degrees): cosine * cos(order theta) + sine * sin(order theta). Only functions of
/// order 0 survive on the axis, where the direction may not depend on theta.
struct AngularFunction {
  int order = 0;
  Vec3 cosine = Vec3::Zero();
  Vec3 sine = Vec3::Zero();

  Vec3 at(double theta) const;
  Vec3 derivative(double theta) const;
  /// Whether it changes sign with the mirror about the plane of axes 1 and 2.
  bool odd() const { return sine.x() != 0 || sine.y() != 0 || cosine.z() != 0; }
};

/// The displacement of a meridian point is sum_k U_k f_k(theta).
using FourierBasis = std::vector<AngularFunction>;

/// Axial and radial displacement of a solid of revolution: 2 unknowns a node.
FourierBasis axisymmetric_basis();
/// Cartesian components, 1 and 2 in cos m theta (m = 0...symmetric), 3 in sin m theta: 3 N + 2
/// unknowns, mirror symmetry about the plane of axes 1 and 2; then, up to `antisymmetric`, the other
/// half (1 and 2 in sin, 3 in cos): with antisymmetric = symmetric the full family of 3 (2 N + 1)
/// unknowns; -1 leaves it out. Rigid rotations of any size are exact from order 1 on, in the plane of
/// symmetry, and in space where antisymmetric >= 1.
FourierBasis cartesian_basis(int symmetric, int antisymmetric = -1);
/// The displacements u = U cos m theta, v = V sin m theta, w = W cos m theta in cylindrical components:
/// the linear problem of one harmonic; with m = 0 the radial and axial part.
FourierBasis cylindrical_basis(int order);
/// Rotation of every meridian point about the axis.
FourierBasis torsion_basis();

/// Equidistant angles of equal weight.
struct AngularRule {
  std::vector<double> theta;
  double weight = 0;  ///< of each; the weights sum to 2 pi
};
/// One angle, for integrands that do not depend on theta.
AngularRule single_angle();
/// `count` angles over the full circle; exact for harmonics below `count`.
AngularRule full_circle(int count);
/// `count` angles over the half circle, for integrands symmetric about it; as exact as 2 count on the full.
AngularRule half_circle(int count);
/// Trigonometric polynomial that is 1 at angle 0 and 0 at the other of `count` equidistant angles of the full circle.
double cardinal(double theta, int count);

}  // namespace hosel::fem
