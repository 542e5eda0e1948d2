// Stands for oneTBB's loop where ThreadSanitizer watches: oneTBB's scheduler is not compiled with it, so that what its
// tasks hand to each other would look like a race. Two threads of the standard library to a loop, each with its own pieces.
#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace tbb {
namespace watched {

/// piece(0) to piece(n - 1); ends early by an exception of one of them.
template <class Piece>
void pieces(long n, const Piece& piece) {
  std::atomic<long> next = 0;
  std::exception_ptr thrown;
  std::mutex guard;
  const auto work = [&] {
    for (long k = next++; k < n; k = next++) try {
        piece(k);
      } catch (...) {
        next = n;
        const std::lock_guard lock(guard);
        if (!thrown) thrown = std::current_exception();
      }
  };
  if (n > 1) {
    std::thread other(work);
    work();
    other.join();
  } else {
    work();
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace watched

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body, const task_group_context&) {
  const long size = long(range.size()), step = std::max<long>(long(range.grainsize()), (size + 7) / 8);
  watched::pieces(step ? (size + step - 1) / step : 0, [&](long k) {
    body(Range(range.begin() + k * step, range.begin() + std::min((k + 1) * step, size), range.grainsize()));
  });
}

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body, const simple_partitioner&, const task_group_context& own) {
  parallel_for(range, body, own);
}

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body, const task_group_context&) {
  watched::pieces(long(last - first), [&](long k) { body(Index(first + Index(k))); });
}

}  // namespace tbb
