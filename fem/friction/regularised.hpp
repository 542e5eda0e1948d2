/// Friction regularised by velocity: no sticking, but creep at low slip speed.
#pragma once

#include "fem/friction/law.hpp"

namespace hosel::fem {

/// |t| = coefficient * pressure * tanh(4 v / transition_speed) of the slip speed v.
class RegularisedFriction final : public FrictionLaw {
 public:
  /// `coefficient` [-], `transition_speed` [m/s].
  RegularisedFriction(double coefficient, double transition_speed)
      : coefficient_(coefficient), transition_speed_(transition_speed) {}
  Friction at(const Slip& slip, bool derivatives) const override;
  bool rate_dependent() const override { return true; }
  std::vector<std::string> faults() const override;

 private:
  double coefficient_, transition_speed_;
};

}  // namespace hosel::fem
