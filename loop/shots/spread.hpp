/// Sample points for the surrogate of a slow base: blows that fill the range of the recorded ones, with effects at
/// several sizes.
#pragma once

#include <vector>

#include "loop/effect.hpp"

namespace hosel::loop {

/// A Latin hypercube over the box of the shots' inputs (two per cent to spare on either side; where an effect changes
/// an input, half of how far it may), and in each shot some three in ten of the quantities that the parametrisations
/// change, small changes more often than large ones. Blows that cannot happen are drawn anew.
std::vector<Shot> spread(const std::vector<Shot>& recorded, const std::vector<Parametrisation>& effects, int points,
                         unsigned long seed);
/// How many quantities the parametrisations change.
int changed_quantities(const std::vector<Shot>& recorded, const std::vector<Parametrisation>& effects);

}  // namespace hosel::loop
