/// The two constants of isotropic elasticity.
#pragma once

#include <string>
#include <vector>

namespace hosel::fem {

/// First Lame parameter and shear modulus of linear elasticity [Pa].
struct Lame {
  double lambda = 0, mu = 0;
  static Lame of(double young, double poisson) {
    return {young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))};
  }

  double shear() const { return mu; }
  double bulk_modulus() const { return lambda + 2 * mu / 3; }
  void stiffen(double factor) {
    lambda -= 2 * mu * (factor - 1) / 3;  // the bulk modulus is kept
    mu *= factor;
  }
  std::vector<std::string> faults() const { return {}; }
};

}  // namespace hosel::fem
