// Loops inside loops.
#include "golf/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>

namespace hosel {
namespace {

constexpr std::size_t kBodies = 100;

/// How many bodies of a loop are run inside one that has been told to end.
template <class Inner>
std::size_t run_inside_an_ended_loop(const Inner& inner) {
  std::atomic<std::size_t> run = 0;
  tbb::task_group_context outer;
  tbb::parallel_for(
      0, 1,
      [&](int) {
        outer.cancel_group_execution();  // as the exception of another body does
        inner(std::size_t{0}, kBodies, [&](std::size_t) { ++run; });
      },
      outer);
  return run;
}

TEST(Parallel, ALoopInsideOneThatEndsRunsEveryBody) {
  const auto plain = [](auto&&... loop) { tbb::parallel_for(loop...); };
  ASSERT_LT(run_inside_an_ended_loop(plain), kBodies);  // what this is about
  const auto all = [](auto&&... loop) { for_all(loop...); };
  EXPECT_EQ(run_inside_an_ended_loop(all), kBodies);
  const auto alone = [](auto&&... loop) { for_all_alone(loop...); };
  EXPECT_EQ(run_inside_an_ended_loop(alone), kBodies);
}

TEST(Parallel, ItsOwnExceptionEndsIt) {
  std::atomic<int> run = 0;
  const auto body = [&](int k) {
    ++run;
    if (k == 0) throw k;
  };
  EXPECT_THROW(for_all(0, 100000, body), int);
  EXPECT_LT(run, 100000);
}

}  // namespace
}  // namespace hosel
