/// What is said of a selection: verdict, places, the holdout read once, errors on both sets, what to measure next.
#pragma once

#include "hosel/loop/result.hpp"
#include "hosel/loop/study.hpp"

namespace hosel::loop {

/// Completes `result` (whose forms the study used).
void conclude(const Study& study, LoopResult& result);

/// Of a channel's residuals on the two sets of rows.
Errors errors(const std::vector<Problem::Row>& rows, const Eigen::MatrixXd& residuals, int channel);

}  // namespace hosel::loop
