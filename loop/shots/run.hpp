/// The loop on shots: after the audit, after a second look at it, without a doubted input, each cluster left out.
#pragma once

#include "loop/result.hpp"
#include "loop/shots/case.hpp"

namespace hosel::loop {

/// More rows than this are refused: everything is held in memory, and no effect needs so many.
inline constexpr std::size_t kMostShots = 200'000;

/// Throws DataError where the data cannot be used at all.
LoopResult run(const ShotCase& c);

}  // namespace hosel::loop
