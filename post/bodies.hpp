/// Rigid bodies and the shaft as meshes for looking.
#pragma once

#include "fem/supports.hpp"
#include "golf/head.hpp"
#include "golf/shaft.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

/// Where a body's frame stands: x_global = origin + rotation * x_body.
struct Pose {
  Vec3 origin = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
};

/// The face with its bulge and roll, as quads of a grid over width x height [m], face frame.
VtkMesh face_mesh(const Face& face, double width, double height);
/// A stylised head behind that face: a rounded body twice as deep as the cg lies behind the face. It
/// is for looking; mass and inertia are the case's own.
VtkMesh head_mesh(const Head& head, double width, double height);
/// The mesh moved to `start` (its reference), with the `displacement` and `velocity` of the pose `now`,
/// the velocity of the frame's origin [m/s] and the angular velocity [rad/s], global frame. `travel`: of a face that
/// yields, how far each point has moved inwards, against the frame's first axis [m]; part of the displacement, and an
/// array of its own. Its rate is not in the velocity.
VtkMesh placed(VtkMesh mesh, const Pose& start, const Pose& now, const Vec3& velocity, const Vec3& spin,
               const std::vector<double>& travel = {});

/// The shaft's line with `radius` for ParaView's Tube filter, displacement and velocity, `deflection` from the straight
/// shaft that the grip would carry along, and what its sections carry.
VtkMesh shaft_mesh(const fem::Beam& beam, const Shaft& shaft, const fem::State& state);
/// The hands as one point, with their wrench on the club (force [N] and moment [N m], global frame) for arrows.
VtkMesh hands_mesh(const Vec3& place, const fem::Wrench& wrench);

}  // namespace hosel::post
