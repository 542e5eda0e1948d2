/// Rigid bodies and the shaft as meshes for looking.
#pragma once

#include "hosel/fem/beam.hpp"
#include "hosel/golf/head.hpp"
#include "hosel/golf/shaft.hpp"
#include "hosel/post/vtk_series.hpp"

namespace hosel::post {

/// Where a body's frame stands: x_global = origin + rotation * x_body.
struct Pose {
  Vec3 origin = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
};

/// The face with its bulge and roll, as quads of an n x n grid over width x height [m], face frame.
VtkMesh face_mesh(const Face& face, double width, double height, int n = 24);
/// A stylised head behind that face: a rounded body twice as deep as the cg lies behind the face. It
/// is for looking; mass and inertia are the case's own.
VtkMesh head_mesh(const Head& head, double width, double height);
/// The mesh moved to `start` (its reference), with the `displacement` and `velocity` of the pose `now`,
/// the velocity of the frame's origin [m/s] and the angular velocity [rad/s], global frame.
VtkMesh placed(VtkMesh mesh, const Pose& start, const Pose& now, const Vec3& velocity, const Vec3& spin);

/// What a section of the shaft carries [N, N m].
struct SectionLoad {
  double axial = 0;    ///< tension is positive
  double torque = 0;   ///< about the line, from its first node to its last
  double bending = 0;  ///< moment across the line
};
/// At each node of a beam: linear in arc length between the Gauss points, and beyond the outermost.
std::vector<SectionLoad> section_loads(const fem::Beam& beam, const fem::State& state);
/// The shaft's line with `radius` for ParaView's Tube filter, displacement and velocity, and what its sections carry.
VtkMesh shaft_mesh(const fem::Beam& beam, const Shaft& shaft, const fem::State& state);

}  // namespace hosel::post
