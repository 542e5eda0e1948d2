/// What to measure next: inputs at which rival explanations differ most, in units of noise.
#pragma once

#include "loop/result.hpp"
#include "loop/shots/case.hpp"
#include "loop/shots/model.hpp"

namespace hosel::loop {

/// Greedy design over the feasible box that separates every two rivals of a tie to 4.8 noise units with as few shots as
/// possible, whichever is the truth and whatever usual form the other takes. The box is the recorded range, a tenth
/// wider on each side; a narrow range is widened to what aim alone makes, and the club speed may be 15 % lower. If one
/// and a half times the training shots, at least twelve, do not separate two rivals, the text names the quantity to
/// measure. `rows`: those that effects were selected on, as in `problem`.
NextExperiment design(const ShotCase& c, const Problem& problem, const ShotModel& model, const std::vector<int>& rows,
                      const LoopResult& so_far);

}  // namespace hosel::loop
