#include "hosel/fem/section.hpp"

#include <limits>

namespace hosel::fem {

namespace {
/// Without shear the shear stiffness is this many times the shaft's own. A section held without limit (fem/beam.cpp) is
/// exact in statics and modes, but the turning of a blow's steps times that stiffness is more than kept factors bear.
constexpr double kHeldShear = 1e3;
}  // namespace

SectionLaw shaft_sections(const Shaft& shaft, bool shear) {
  return [shaft, shear](double s) {
    const ShaftStation st = shaft.at(s);
    const double kga = st.shear_stiffness > 0 ? (shear ? 1 : kHeldShear) * st.shear_stiffness
                                              : std::numeric_limits<double>::infinity();
    return Section{.axial = st.axial_stiffness,
                   .shear_y = kga,
                   .shear_z = kga,
                   .torsion = st.torsional_stiffness,
                   .bending_y = st.bending_stiffness_y,
                   .bending_z = st.bending_stiffness_z,
                   .mass = st.mass_per_length,
                   .rotary = {st.rotary_inertia_y + st.rotary_inertia_z, st.rotary_inertia_y, st.rotary_inertia_z},
                   .centres = st.centres};
  };
}

}  // namespace hosel::fem
