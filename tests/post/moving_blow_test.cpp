#include "post/moving_blow.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hosel::post {
namespace {

/// The last of an odd number of frames is kept with every second, and counts.
TEST(MovingBlow, APageTakesAtMostFourMegabytes) {
  MovingBlow blow;
  blow.radius = 0.02;
  constexpr int points = 400'000;
  blow.bodies.push_back({.name = "face", .points = points, .grid = {}, .cells = {}, .radius = {}});
  for (int k = 0; k < 3; ++k)
    blow.frames.push_back(
        {.time = 1e-4 * k, .force = 1, .bodies = {{std::vector<float>(3 * points, 0.1F * float(k)), {}, {}}}});
  const std::string json = json_for_viewer(blow);
  EXPECT_LT(json.size(), 4'000'000U);
  EXPECT_EQ(nlohmann::json::parse(json).at("time_ms").size(), 1U);
}

}  // namespace
}  // namespace hosel::post
