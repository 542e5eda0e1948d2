/// Coulomb's law with elastic sticking, by return map.
#pragma once

#include "fem/friction/law.hpp"

namespace hosel::fem {

/// Sticking is a spring, t = stiffness * stretch; |t| <= coefficient * pressure, beyond which the anchor
/// is dragged along. P. Wriggers, Computational Contact Mechanics (2006), ch. 5.
class Coulomb final : public FrictionLaw {
 public:
  /// `coefficient` [-], `stiffness` of the sticking spring per reference area [N/m^3].
  Coulomb(double coefficient, double stiffness) : coefficient_(coefficient), stiffness_(stiffness) {}
  Friction at(const Slip& slip, bool derivatives) const override;
  bool rate_dependent() const override { return false; }
  std::vector<std::string> faults() const override;

 private:
  double coefficient_, stiffness_;
};

}  // namespace hosel::fem
