#include "golf/shaft.hpp"

#include <algorithm>

namespace hosel {

ShaftStation Shaft::at(double s) const {
  const auto after = std::upper_bound(stations.begin(), stations.end(), s,
                                      [](double x, const ShaftStation& st) { return x < st.arc_length; });
  if (after == stations.begin()) return stations.front();
  if (after == stations.end()) return stations.back();
  const ShaftStation &a = *(after - 1), &b = *after;
  const double w = (s - a.arc_length) / (b.arc_length - a.arc_length);
  const auto mix = [w](double x, double y) { return (1 - w) * x + w * y; };
  const auto both = [&](const std::array<double, 2>& x, const std::array<double, 2>& y) {
    return std::array{mix(x[0], y[0]), mix(x[1], y[1])};
  };
  return {.arc_length = s,
          .bending_stiffness_y = mix(a.bending_stiffness_y, b.bending_stiffness_y),
          .bending_stiffness_z = mix(a.bending_stiffness_z, b.bending_stiffness_z),
          .torsional_stiffness = mix(a.torsional_stiffness, b.torsional_stiffness),
          .axial_stiffness = mix(a.axial_stiffness, b.axial_stiffness),
          .shear_stiffness = mix(a.shear_stiffness, b.shear_stiffness),
          .mass_per_length = mix(a.mass_per_length, b.mass_per_length),
          .rotary_inertia_y = mix(a.rotary_inertia_y, b.rotary_inertia_y),
          .rotary_inertia_z = mix(a.rotary_inertia_z, b.rotary_inertia_z),
          .outer_radius = mix(a.outer_radius, b.outer_radius),
          .centres = {both(a.centres.elastic, b.centres.elastic), both(a.centres.shear, b.centres.shear),
                      both(a.centres.mass, b.centres.mass)}};
}

}  // namespace hosel
