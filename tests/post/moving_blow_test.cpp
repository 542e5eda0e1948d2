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

/// Cells count points by 16 bits: a body of more is not drawn from other points.
TEST(MovingBlow, AFaceOfMorePointsThanCellsCountIsRefused) {
  MovingBlow blow;
  constexpr int points = 65'540;
  blow.bodies.push_back({.name = "face", .points = points, .grid = {}, .cells = {0, 1, 65'535}, .radius = {}});
  blow.frames.push_back({.force = 1, .bodies = {{std::vector<float>(3 * points, 0.1F), {}, {}}}});
  EXPECT_FALSE(json_for_viewer(blow).empty());
  blow.bodies.front().cells.back() = 65'536;
  EXPECT_TRUE(json_for_viewer(blow).empty());
}

}  // namespace
}  // namespace hosel::post
