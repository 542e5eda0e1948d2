#include "fem/contact_method/penalty.hpp"

#include <cmath>

namespace hosel::fem {

std::vector<std::string> Penalty::faults() const {
  if (stiffness_ > 0 && std::isfinite(stiffness_)) return {};
  return {"contact: state a positive normal stiffness"};
}

}  // namespace hosel::fem
