/// Friction with a static coefficient that falls to the sliding one over a slip distance.
#pragma once

#include "fem/friction/coulomb.hpp"
#include "golf/contact_law.hpp"

namespace hosel::fem {

/// Coulomb's law with a coefficient that falls from the static to the sliding one with the path that the point has
/// slid: junctions break after a slip of their own size, about a micrometre between hard solids. [@slip-distance]
/// A step has the mean coefficient over what it slides beyond the limit at its start, where a point touches first
/// weighted with the pressure that grows there: its impulse does not hang on how many steps cover the fall.
class SlipWeakening final : public FrictionLaw {
 public:
  /// `sliding`: coefficient [-]; `stiffness` of the sticking spring per reference area [N/m^3].
  SlipWeakening(double sliding, StaticFriction rest, double stiffness)
      : sliding_(sliding), rest_(rest), stiffness_(stiffness) {}
  Friction at(const Slip& slip, bool derivatives) const override;
  bool rate_dependent() const override { return false; }
  std::vector<std::string> faults() const override;

 private:
  double sliding_;
  StaticFriction rest_;
  double stiffness_;
};

}  // namespace hosel::fem
