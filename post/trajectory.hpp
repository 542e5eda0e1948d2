/// A flight as a picture and as lines for ParaView.
#pragma once

#include "post/figure.hpp"
#include "post/flight_table.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

struct NamedFlight {
  std::string title;
  ShotFlight shot;  ///< with its path
};

/// Side view (height over distance) and, unless all fly straight, top view (left of the target over distance), a line
/// a flight.
Figure trajectory_figure(std::string title, const std::vector<NamedFlight>& flights);

/// The path as a line (global frame, the launch at its origin) with time, velocity, spin and what the air does.
VtkMesh trajectory_mesh(const models::Flight& flight);

}  // namespace hosel::post
