/// The loop on a base that takes seconds per blow: audit and a first loop with the closed form, a surrogate over blows
/// and effects, further blows where a decision depends on them, and the corrected base itself on the held-out shots.
#pragma once

#include <memory>

#include "loop/result.hpp"
#include "loop/shots/case.hpp"
#include "loop/shots/problem.hpp"

namespace hosel::loop {

/// `c.slow` is set. Throws DataError where the data cannot be used, or the base has no answer near them.
LoopResult run_slow(const ShotCase& c);

/// A slow base made quick over blows like those of a case and the effects that may act in them.
struct Learnt {
  std::vector<Shot> shots;                  ///< as recorded, without bad rows
  std::shared_ptr<const Surrogate> coarse;  ///< of a base that is corrected at the case's own accuracy
  Surrogate best;                           ///< learns as the loop asks
};
/// `c.slow` is set. Throws as run_slow.
Learnt learn(const ShotCase& c);
/// Goes on from what is known of the base, by other shots of the same range too, and adds to it.
LoopResult run_slow(const ShotCase& c, Learnt& learnt);

/// What a pass on a surrogate would have the base asked about, of training shots at what it chose, at the base and at
/// rivals that the surrogate's error may hide: `decisive` and `checks` of the result.
void ask_further(const ShotProblem& problem, const Rules& rules, LoopResult& result);
/// The base itself (`c.closing`) on held-out shots, at the fits before and after.
Corrected close(const ShotCase& c, const ShotProblem& problem, const Fit& before, const Fit& after);

}  // namespace hosel::loop
