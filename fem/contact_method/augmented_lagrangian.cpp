#include "fem/contact_method/augmented_lagrangian.hpp"

#include <algorithm>
#include <cmath>

namespace hosel::fem {

double AugmentedLagrangian::next(double gap, double multiplier) const {
  return std::max(0.0, at(gap, multiplier).pressure());
}

bool AugmentedLagrangian::repeats(double gap, double multiplier) const {
  return std::abs(next(gap, multiplier) - multiplier) > stiffness_ * penetration_;
}

double AugmentedLagrangian::offset(const NormalState& before, const NormalState& now) const {
  const auto spring = [](const NormalSpring& s) { return 0.5 * s.stiffness * s.depth * s.depth; };
  const NormalSpring was = at(before.gap, before.multiplier), is = at(now.gap, now.multiplier);
  const bool touched = was.depth > 0;
  // A point that touches first has been pressed from where it met the surface.
  const double pressure = touched ? was.pressure() : 0, gap = touched ? before.gap : std::min(before.gap, 0.0);
  const double stored = touched ? spring(was) + before.offset : 0;
  return stored - 0.5 * (pressure + is.pressure()) * (now.gap - gap) - spring(is);
}

std::vector<std::string> AugmentedLagrangian::faults() const {
  std::vector<std::string> out;
  if (!(stiffness_ > 0) || !std::isfinite(stiffness_)) out.emplace_back("contact: state a positive normal stiffness");
  if (!(penetration_ > 0)) out.emplace_back("contact: an augmented Lagrangian needs a penetration above zero to reach");
  return out;
}

}  // namespace hosel::fem
