/// Loops over all cores, as they may stand inside one another.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <utility>

namespace hosel {

/// `tbb::parallel_for`, of whose bodies every one is run unless one of its own throws. TBB's own ends early, without a
/// word, where a loop around it ends by an exception: what it was to compute would be taken for computed.
template <class... Loop>
void for_all(Loop&&... loop) {
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_for(std::forward<Loop>(loop)..., own);
}

/// The same inside a blow: a thread that waits here takes no other blow meanwhile.
template <class... Loop>
void for_all_alone(Loop&&... loop) {
  tbb::this_task_arena::isolate([&] { for_all(std::forward<Loop>(loop)...); });
}

}  // namespace hosel
