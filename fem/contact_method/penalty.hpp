/// Contact by a penalty: a layer of springs on the surface.
#pragma once

#include <cmath>

#include "fem/contact_method/method.hpp"

namespace hosel::fem {

/// p = -stiffness g where the gap g is negative: a point sinks in by p over the stiffness.
class Penalty final : public ContactMethod {
 public:
  /// `stiffness` per reference area [N/m^3].
  explicit Penalty(double stiffness) : stiffness_(stiffness) {}
  NormalSpring at(double gap, double) const override { return {stiffness_, -gap}; }
  std::vector<std::string> faults() const override {
    if (stiffness_ > 0 && std::isfinite(stiffness_)) return {};
    return {"contact: state a positive normal stiffness"};
  }

 private:
  double stiffness_;
};

}  // namespace hosel::fem
