/// Gent's elastic law: rubber with a limiting chain stretch.
#pragma once

#include <cmath>

#include "fem/materials/energy_law.hpp"

namespace hosel::fem {

/// W = -mu/2 L ln(1 - (I1' - 3)/L) + K/2 (J - 1)^2: neo-Hooke where L is large. A.N. Gent, Rubber Chem. Technol. 69
/// (1996) 59. Beyond I1' = 3 + L there is no answer: NaN, which no step accepts.
struct GentEnergy {
  double modulus = 0;  ///< mu, at zero strain [Pa]
  double limit = 0;    ///< L, what I1' - 3 never reaches [-]
  double bulk = 0;     ///< K [Pa]

  double shear() const { return modulus; }
  double bulk_modulus() const { return bulk; }
  void stiffen(double factor) { modulus *= factor; }
  std::vector<std::string> faults() const {
    if (!(limit > 0)) return {"Gent's limit of I1' - 3 must be positive"};
    return {};
  }

  template <class X, class Y, class Z>
  auto energy(const X& I1, const Y&, const Z& J) const {
    using std::log;
    return -0.5 * modulus * limit * log(1.0 - (I1 - 3.0) / limit) + 0.5 * bulk * (J - 1.0) * (J - 1.0);
  }
};
using Gent = EnergyLaw<GentEnergy>;

}  // namespace hosel::fem
