#include "fem/friction/laws.hpp"

#include "fem/friction/coulomb.hpp"
#include "fem/friction/regularised.hpp"
#include "fem/friction/slip_weakening.hpp"

namespace hosel::fem {

std::unique_ptr<const FrictionLaw> friction_law(const PatchFriction& friction, double sticking) {
  if (!(friction.coefficient > 0 || (friction.at_rest && friction.at_rest->coefficient > 0))) return nullptr;
  if (friction.transition_speed)
    return std::make_unique<RegularisedFriction>(friction.coefficient, *friction.transition_speed);
  if (friction.at_rest) return std::make_unique<SlipWeakening>(friction.coefficient, *friction.at_rest, sticking);
  return std::make_unique<Coulomb>(friction.coefficient, sticking);
}

}  // namespace hosel::fem
