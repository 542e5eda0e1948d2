/// The loop on a base that takes seconds to answer: audit and a first look by the closed form, a surrogate over blows
/// and effects, more answers where the decision hangs on them, and the corrected base itself on the held-out shots.
#pragma once

#include "hosel/loop/result.hpp"
#include "hosel/loop/shots/case.hpp"
#include "hosel/loop/shots/problem.hpp"

namespace hosel::loop {

/// `c.slow` is set. Throws DataError where the data cannot be used, or the base has no answer near them.
LoopResult run_slow(const ShotCase& c);

/// What a pass on a surrogate would have the base asked about: training shots at what it chose, some at the base and
/// at the likeliest candidates.
std::vector<Shot> decisive(const ShotProblem& problem, const LoopResult& result);
/// The base itself (`c.closing`) on held-out shots, at the fits before and after.
Corrected close(const ShotCase& c, const ShotProblem& problem, const Fit& before, const Fit& after);

}  // namespace hosel::loop
