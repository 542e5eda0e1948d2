/// The smallest effect that the data would show.
#pragma once

#include "loop/fit.hpp"
#include "loop/result.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {

/// Of each effect, by the first parameter of its first form that the data show at all: the size at which it would be
/// adopted nine times in ten, beside what the base fits.
std::vector<Detectable> minimum_detectable(const Problem& problem, const Fit& base,
                                           const std::vector<const Parametrisation*>& forms, const Rules& rules);

}  // namespace hosel::loop
