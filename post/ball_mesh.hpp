/// The harmonic ball revolved to three dimensions, for looking.
#pragma once

#include <cstdint>
#include <vector>

#include "fem/harmonic_solid.hpp"
#include "fem/traction_field.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

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
/// contact_pressure [Pa], both of the field; cell arrays: layer, and angle [rad], theta of the cell's
/// middle: below and above pi lie the two sides of the plane of the mesh's axis and the slip.
VtkMesh ball_mesh(const fem::HarmonicSolid& ball, const fem::State& state, const fem::TractionField& acting,
                  int angles);

}  // namespace hosel::post
