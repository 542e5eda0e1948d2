#include "fem/section.hpp"

#include <limits>

namespace hosel::fem {

SectionLaw shaft_sections(const Shaft& shaft, bool shear, double from) {
  return [shaft, shear, from](double s) {
    const ShaftStation st = shaft.at(s + from);
    const bool yields = shear && st.shear_stiffness > 0;
    const double kga = yields ? st.shear_stiffness : std::numeric_limits<double>::infinity();
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
