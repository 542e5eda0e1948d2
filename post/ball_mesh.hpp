/// The harmonic ball revolved to three dimensions, for looking.
#pragma once

#include <functional>

#include "fem/contact.hpp"
#include "fem/harmonic_solid.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

/// What acts on the ball's surface at a meridian node and an angle: means of the contact's quadrature points over the
/// one or two edges of the surface that meet in the node, weighted by area, linear between the contact's angles; zero
/// away from the patch. A single quadrature point is no converged pressure: the displacement of a quadratic edge cannot
/// follow what the points of one edge show beside each other, their mean over the edge is.
class SurfaceMeans {
 public:
  struct Value {
    double pressure = 0;           ///< normal to the face [Pa]
    Vec3 traction = Vec3::Zero();  ///< pressure and friction, on the ball per reference area, global [Pa]
  };
  SurfaceMeans(const fem::HarmonicSolid& ball, const std::vector<fem::ContactPoint>& points);
  Value operator()(int node, double theta) const;

 private:
  Value at_angle(int node, std::size_t angle) const;
  Mat3 axes_;
  std::vector<double> angles_;
  std::vector<Value> means_;  // of a node's edges at each angle, node by node
};

/// Numbers of the points of ball_mesh: `angles` around for each node of the meridian, one where it lies on the axis.
class RevolvedPoints {
 public:
  RevolvedPoints(const mesh::Meridian& meridian, int angles);
  std::int64_t at(int node, int angle) const {
    return first_[std::size_t(node)] + (axial_[std::size_t(node)] ? 0 : angle % angles_);
  }
  bool axial(int node) const { return axial_[std::size_t(node)]; }
  std::int64_t count() const { return count_; }  ///< of them all

 private:
  int angles_;
  std::int64_t count_ = 0;
  std::vector<bool> axial_;
  std::vector<std::int64_t> first_;
};

/// Each element is swept quadratically over every second of `angles` steps of the full circle, an even number: cells
/// that have the curved sides and the displacements of the finite elements themselves along the meridian. Point arrays:
/// displacement [m], velocity [m/s], cauchy_stress [Pa], von_mises [Pa], contact_traction [Pa] (on the ball) and
/// contact_pressure [Pa], both as SurfaceMeans gives them; cell arrays: layer, and angle [rad], theta of the cell's
/// middle: below and above pi lie the two sides of the plane of the mesh's axis and the slip.
VtkMesh ball_mesh(const fem::HarmonicSolid& ball, const fem::State& state, const SurfaceMeans& acting, int angles = 32);

}  // namespace hosel::post
