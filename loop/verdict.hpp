/// From a selection to what is said of it: verdict, places, errors on both sets, what to measure next.
#pragma once

#include "hosel/loop/study.hpp"

namespace hosel::loop {

/// Completes `study.result`. The holdout is read here, once.
void conclude(Study& study);

}  // namespace hosel::loop
