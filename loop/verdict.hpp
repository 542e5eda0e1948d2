/// The report on a selection: verdict, places, the holdout read once, errors on training and held-out rows, the next
/// experiment.
#pragma once

#include "loop/result.hpp"
#include "loop/study.hpp"

namespace hosel::loop {

/// Completes `result` (whose forms the study used).
void conclude(const Study& study, LoopResult& result);

}  // namespace hosel::loop
