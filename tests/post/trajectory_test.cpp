#include "post/trajectory.hpp"

#include <gtest/gtest.h>

#include "models/flight/flight.hpp"

namespace hosel::post {
namespace {

/// The target is to the right of both views: seen from above, left of it is up.
TEST(Trajectory, FromAboveLeftOfTheTargetIsUp) {
  Launch l;
  l.velocity = Vec3(60, 0, 15);
  l.spin = Vec3(0, -250, 80);  // turns to the left
  const models::Flight flight = models::fly(l, {}, {}, {.sample = 0.1});
  ASSERT_GT(flight.path.back().position.y(), 5);
  const Figure figure = trajectory_figure("a draw", {{"draw", {.flight = flight, .unit = DistanceUnit::metres}}});
  ASSERT_EQ(figure.panels.size(), 2u);
  const Panel& above = figure.panels[1];
  EXPECT_EQ(above.y_label, "right  <-  [m]  ->  left");
  EXPECT_TRUE(above.y_down);
  EXPECT_NEAR(above.series.front().y.back(), -flight.path.back().position.y(), 1e-9);  // right is positive
  EXPECT_NEAR(above.series.front().y.back(), flight.side, 1e-9);                       // as tables have it
  EXPECT_NEAR(above.series.front().x.back(), flight.path.back().position.x(), 1e-9);
}

}  // namespace
}  // namespace hosel::post
