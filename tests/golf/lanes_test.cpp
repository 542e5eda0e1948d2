// Numbers side by side against one number after the other.
#include "golf/lanes.hpp"

#include <gtest/gtest.h>

#include <array>

namespace hosel {
namespace {

TEST(Lanes, FunctionsAreThoseOfNumbers) {
  for (const double x : {1e-300, 1e-9, 0.3, 1.0, 7.0, 2e5}) {
    const std::array<double, kLanes> all = {x, 2 * x, 3 * x, 5 * x};
    Pack pack;
    for (int l = 0; l < kLanes; ++l) set_lane(pack, l, all[std::size_t(l)]);
    const Pack root = sqrt(pack), falls = exp(-pack), power = pow(pack, 0.6), size = abs(-pack);
    for (int l = 0; l < kLanes; ++l) {
      const double one = all[std::size_t(l)];
      EXPECT_EQ(lane(root, l), std::sqrt(one));
      EXPECT_EQ(lane(size, l), one);
      // Below the least normal number the lanes give zero.
      EXPECT_NEAR(lane(falls, l), std::exp(-one), 4e-16 * std::exp(-one) + 3e-308);
      // Logarithms of up to 700 lose as many units.
      EXPECT_NEAR(lane(power, l), std::pow(one, 0.6), 4e-13 * std::pow(one, 0.6));
    }
  }
}

TEST(Lanes, SelectionGoesLaneByLane) {
  Pack x;
  for (int l = 0; l < kLanes; ++l) set_lane(x, l, l - 1.5);
  const Pack positive = select(x > 0, x, Pack(0)), most = larger(x, Pack(0));
  EXPECT_TRUE(any(x > 0));
  EXPECT_FALSE(any(x > 9));
  for (int l = 0; l < kLanes; ++l) {
    EXPECT_EQ(lane(positive, l), std::max(0.0, l - 1.5));
    EXPECT_EQ(lane(most, l), std::max(0.0, l - 1.5));
    EXPECT_EQ(lane(x > 0, l), l - 1.5 > 0);
  }
}

}  // namespace
}  // namespace hosel
