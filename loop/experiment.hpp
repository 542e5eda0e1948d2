/// What to measure next: inputs at which rival explanations differ most, in units of noise.
#pragma once

#include "loop/run.hpp"

namespace hosel::loop {

/// Greedy design over the feasible box (the recorded range, widened by a quarter) that separates the two best
/// rivals to 4.8 noise units with as few shots as possible; where no shot separates them, the sensor that would.
NextExperiment design(const LoopCase& c, const Problem& problem, const std::vector<int>& rows, const Selection& selection,
                      const std::vector<Location>& unexplained, Verdict verdict);

}  // namespace hosel::loop
