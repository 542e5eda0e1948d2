/// Which friction law a contact has.
#pragma once

#include <memory>

#include "fem/friction/law.hpp"
#include "golf/contact_law.hpp"

namespace hosel::fem {

/// The law that `friction` states; null where nothing holds, not even a point at rest. `sticking`: stiffness of the
/// spring of a point that sticks, per reference area [N/m^3].
std::unique_ptr<const FrictionLaw> friction_law(const PatchFriction& friction, double sticking);

}  // namespace hosel::fem
