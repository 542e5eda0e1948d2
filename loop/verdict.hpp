/// What is said of a selection: verdict, places, the holdout read once, errors on both sets, what to measure next.
#pragma once

#include "loop/result.hpp"
#include "loop/study.hpp"

namespace hosel::loop {

/// Completes `result` (whose forms the study used).
void conclude(const Study& study, LoopResult& result);

/// Of a channel on the two sets of rows; `of`: before or after.
Errors errors(const std::vector<UsedRow>& rows, std::vector<double> UsedRow::*of, std::size_t channel);

}  // namespace hosel::loop
