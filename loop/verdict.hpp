/// The report on a selection: verdict, places, the holdout read once, errors on training and held-out rows, the next
/// experiment.
#pragma once

#include "loop/result.hpp"
#include "loop/study.hpp"

namespace hosel::loop {

/// Completes `result` (whose forms the study used).
void conclude(const Study& study, LoopResult& result);

/// Of a channel on the two sets of rows; `of`: before or after.
Errors errors(const std::vector<UsedRow>& rows, std::vector<double> UsedRow::*of, std::size_t channel);

}  // namespace hosel::loop
