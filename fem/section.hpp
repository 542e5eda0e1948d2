/// A beam's cross-section: stiffness and inertia per unit of arc length, referred to the line of nodes.
#pragma once

#include <functional>

#include "golf/shaft.hpp"

namespace hosel::fem {

/// Local axes: x along the beam, y and z across (principal).
struct Section {
  double axial = 0;                     ///< EA [N]
  double shear_y = 0, shear_z = 0;      ///< kappa G A along y, z [N]; inf holds the section normal to the axis
  double torsion = 0;                   ///< GJ [N m^2]
  double bending_y = 0, bending_z = 0;  ///< EI about y, z [N m^2]
  double mass = 0;                      ///< rho A [kg/m]
  Vec3 rotary = Vec3::Zero();           ///< rho times second moments about x, y, z through the centre of mass [kg m]
  CentreOffsets centres = {};
};

/// The section at an arc length [m].
using SectionLaw = std::function<Section(double)>;

/// Sections of a shaft from its table. Rayleigh beam theory where `shear` is false or the table has no shear stiffness:
/// rotary inertia counts, and sections stay normal to the axis. The beam begins at `from` on the shaft [m].
SectionLaw shaft_sections(const Shaft& shaft, bool shear = true, double from = 0);

}  // namespace hosel::fem
