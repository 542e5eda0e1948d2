#include "fem/friction/slip_weakening.hpp"

#include <cmath>

namespace hosel::fem {

Friction SlipWeakening::at(const Slip& slip, bool derivatives) const {
  const double left = std::exp(-slip.path / rest_.distance);
  return Coulomb(sliding_ + (rest_.coefficient - sliding_) * left, stiffness_).at(slip, derivatives);
}

std::vector<std::string> SlipWeakening::faults() const {
  std::vector<std::string> out = Coulomb(sliding_, stiffness_).faults();
  if (!(rest_.coefficient >= sliding_) || !std::isfinite(rest_.coefficient))
    out.emplace_back("contact: static friction must be finite and at least that of sliding");
  if (!(rest_.distance > 0)) out.emplace_back("contact: the slip over which static friction falls must be positive");
  return out;
}

}  // namespace hosel::fem
