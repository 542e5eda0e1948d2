/// The effects on shots beside a fit: how much alike they look.
#pragma once

#include "hosel/loop/absorption.hpp"
#include "hosel/loop/fit.hpp"

namespace hosel::loop {

/// One column per effect: its first form with one parameter, a finite probe where the gradient at zero vanishes.
Likeness alike(const Problem& problem, const std::vector<int>& rows, const Fit& at,
               const std::vector<const Form*>& forms);

}  // namespace hosel::loop
