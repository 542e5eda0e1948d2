#include "solvers/peak.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "golf/units.hpp"

namespace hosel::test {
namespace {

using solvers::Peak;

/// A half-sine pulse of height 1 and length 1 whose top lies between two steps, `share` of a step behind one of them.
Peak half_sine(int steps, double share, double* largest_step = nullptr) {
  Peak out;
  const double h = 1.0 / steps, first = 0.5 - h * (std::floor(0.5 / h) - 1 + share);
  for (double t = first; t < 1; t += h) {
    out.add(t, std::sin(kPi * t));
    if (largest_step) *largest_step = std::max(*largest_step, std::sin(kPi * t));
  }
  return out;
}

TEST(Peak, OfAHalfSineDoesNotDependOnTheSteps) {
  double step_alone = 0;
  half_sine(11, 0.5, &step_alone);
  ASSERT_LT(step_alone, 0.991) << "the top lies between the steps";
  for (const int steps : {11, 40})
    for (const double share : {0.0, 0.25, 0.5, 0.9}) {
      // The third difference of a cosine near its top, times the distances to the three steps: at most x^4 / 24.
      const double x = kPi / steps, bound = std::pow(x, 4) / 24;
      const Peak peak = half_sine(steps, share);
      EXPECT_NEAR(peak.value, 1, bound) << steps << " " << share;
      EXPECT_NEAR(peak.time, 0.5, 0.02 / steps) << steps << " " << share;
    }
}

TEST(Peak, OfAParabolaIsExactOnUnevenSteps) {
  Peak peak;
  for (const double t : {0.0, 0.1, 0.45, 0.52, 0.9, 1.0}) peak.add(t, 3 - 7 * (t - 0.5) * (t - 0.5));
  EXPECT_NEAR(peak.value, 3, 1e-14);
  EXPECT_NEAR(peak.time, 0.5, 1e-14);
}

TEST(Peak, AtAnEndIsThatStep) {
  Peak rising, falling;
  for (const double t : {0.0, 1.0, 2.0}) rising.add(t, t * t), falling.add(t, 4 - t);
  EXPECT_EQ(rising.value, 4);
  EXPECT_EQ(rising.time, 2);
  EXPECT_EQ(falling.value, 4);
  EXPECT_EQ(falling.time, 0);
}

TEST(Peak, OfARingingForceIsTheHighestTop) {
  Peak peak;
  for (int i = 0; i <= 60; ++i) {
    const double t = i / 60.0;
    peak.add(t, std::sin(kPi * t) + 0.05 * std::cos(12 * kPi * t));
  }
  // Between the fourth and the fifth wave: the middle top, where both are largest.
  EXPECT_NEAR(peak.value, 1.05, 1e-3);
  EXPECT_NEAR(peak.time, 0.5, 1e-3);
}

}  // namespace
}  // namespace hosel::test
