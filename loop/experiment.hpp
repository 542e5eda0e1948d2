/// What to measure next: inputs at which rival explanations differ most, in units of noise.
#pragma once

#include "hosel/loop/run.hpp"

namespace hosel::loop {

/// Greedy design over the feasible box (the recorded range, widened by a quarter) that separates every two rivals of a
/// tie to 4.8 noise units with as few shots as possible, whichever is the truth and whatever usual form (of `forms`)
/// the other takes; where as many shots as the session had do not separate two, the quantity to measure.
NextExperiment design(const LoopCase& c, const Problem& problem, const std::vector<int>& rows,
                      const Selection& selection, const std::vector<const Form*>& forms, const Loss& loss,
                      const std::vector<Location>& unexplained, Verdict verdict);

}  // namespace hosel::loop
