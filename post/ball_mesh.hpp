/// The harmonic ball revolved to three dimensions, for looking.
#pragma once

#include <functional>

#include "fem/harmonic_solid.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

/// Contact pressure [Pa] and traction [Pa, global] on the ball's surface at a meridian node and an
/// angle; zero away from the patch.
using SurfaceTraction = std::function<Vec3(int node, double theta)>;

/// Each element becomes four quadrilaterals, swept over `angles` steps of the full circle. Point arrays:
/// displacement [m], velocity [m/s], cauchy_stress [Pa], von_mises [Pa], contact_traction [Pa] (on the
/// ball), contact_pressure [Pa]; cell array: layer.
VtkMesh ball_mesh(const fem::HarmonicSolid& ball, const fem::State& state, const SurfaceTraction& traction,
                  int angles = 32);

}  // namespace hosel::post
