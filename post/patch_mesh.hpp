/// The contact patch as points: what presses, pulls and slides where.
#pragma once

#include <vector>

#include "fem/traction_field.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

/// One vertex a quadrature point of the ball's surface (half of them where the blow has a plane of symmetry).
/// Point arrays: displacement [m], contact_traction [Pa] (on the ball, per reference area), contact_pressure
/// [Pa], both of the field; station_traction and station_pressure, what the quadrature point itself has, whose values
/// alternate; slip [m] (path slid so far), sliding (1 where the friction limit is reached).
VtkMesh patch_mesh(const std::vector<fem::ContactPoint>& points, const fem::TractionField& field);

}  // namespace hosel::post
