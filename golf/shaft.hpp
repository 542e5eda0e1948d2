/// The shaft as data: properties along the arc length, butt (0) to tip (length).
#pragma once

#include <array>
#include <vector>

#include "golf/vector.hpp"

namespace hosel {

/// Where a section's centres lie off the line of nodes, along local y and z [m]: a seam, a bent or an unevenly
/// wound tube.
struct CentreOffsets {
  std::array<double, 2> elastic = {};  ///< where an axial force bends nothing
  std::array<double, 2> shear = {};    ///< where a transverse force twists nothing
  std::array<double, 2> mass = {};     ///< centre of mass, about which the rotary inertias are
  bool none() const { return *this == CentreOffsets{}; }
  bool operator==(const CentreOffsets&) const = default;
};

/// Properties of one cross-section; local axes: x along the shaft towards the tip, y and z across.
struct ShaftStation {
  double arc_length = 0;           ///< from the butt [m]
  double bending_stiffness_y = 0;  ///< EI for bending about local y [N m^2]
  double bending_stiffness_z = 0;  ///< EI for bending about local z [N m^2]
  double torsional_stiffness = 0;  ///< GJ [N m^2]
  double axial_stiffness = 0;      ///< EA [N]
  double shear_stiffness = 0;      ///< kappa G A, both directions [N]
  double mass_per_length = 0;      ///< [kg/m]
  double rotary_inertia_y = 0;     ///< rho I about local y [kg m]
  double rotary_inertia_z = 0;     ///< rho I about local z [kg m]
  double outer_radius = 0;         ///< mid-wall where a mean radius is declared; for strain and for looking [m]
  CentreOffsets centres = {};
};

struct Shaft {
  std::vector<ShaftStation> stations;  ///< increasing arc length, linear between them
  double damping_time = 0;             ///< stiffness-proportional damping: stress = C (strain + t * rate) [s]

  double length() const { return stations.empty() ? 0 : stations.back().arc_length; }
  ShaftStation at(double arc_length) const;  ///< linear interpolation, ends held
};

}  // namespace hosel
