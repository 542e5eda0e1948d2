/// Contact by an augmented Lagrangian: a penalty and a multiplier, which converges to the pressure.
#pragma once

#include "fem/contact_method/method.hpp"

namespace hosel::fem {

/// p = max(0, l - stiffness g) with the gap g and the multiplier l. A step is solved with l fixed; then l becomes p,
/// and the step is solved again until no point's p - l exceeds the stiffness times the penetration that is allowed
/// (Uzawa's iteration, [@augmented-lagrangian]). The next step begins with the last p.
///
/// No state function holds the energy, since l follows the motion. A point has stored the work of its pressure since it
/// touched, - sum of (p_n + p_{n+1}) / 2 times the change of g. Where it lets go nothing is stored: what the pressure
/// did not give back shows in the closure of the ledger.
class AugmentedLagrangian final : public ContactMethod {
 public:
  /// `stiffness` per reference area [N/m^3]; `penetration` allowed in an accepted step [m].
  AugmentedLagrangian(double stiffness, double penetration) : stiffness_(stiffness), penetration_(penetration) {}
  NormalSpring at(double gap, double multiplier) const override { return {stiffness_, multiplier / stiffness_ - gap}; }
  bool multipliers() const override { return true; }
  double next(double gap, double multiplier) const override;
  bool repeats(double gap, double multiplier) const override;
  double offset(const NormalState& before, const NormalState& now) const override;
  std::vector<std::string> faults() const override;

 private:
  double stiffness_, penetration_;
};

}  // namespace hosel::fem
