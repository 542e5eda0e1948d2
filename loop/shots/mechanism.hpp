/// A free function of one quantity that acts through one mechanism: a rival of every set of names. The mechanism tells
/// how the channels move together, whatever the function is.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "loop/shots/structure.hpp"

namespace hosel::loop {

/// Mechanisms: the normal and the tangential restitution, an error of each input, an error of each reading. Functions:
/// Gaussian processes [@gp-ml] with a level, along each column of `columns_of` and the angle of incidence, over the
/// place of impact, a value for each group of a text column. Made linear about `base`, on `rows`, with the weights of
/// the shots in `chosen`. `session`: the place in the session is a time. `noisy`: the inputs whose noise is declared;
/// where nothing is chosen, what noise of the others does in the mean is no function's. The likeliest first, those
/// within `rules.tie` of it.
std::vector<Mechanism> mechanisms(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                  const std::vector<int>& rows, bool session, const std::set<std::string>& noisy,
                                  const Fit& base, const Fit& chosen, const Rules& rules);

}  // namespace hosel::loop
