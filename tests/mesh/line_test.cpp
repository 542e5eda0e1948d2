#include "mesh/line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hosel::mesh {
namespace {

TEST(Line, ElementsGrowAsAsked) {
  const auto ends = graded(1.2, 7, 0.8);
  ASSERT_EQ(ends.size(), 8u);
  EXPECT_EQ(ends.front(), 0);
  EXPECT_EQ(ends.back(), 1.2);
  for (std::size_t i = 2; i < ends.size(); ++i)
    EXPECT_NEAR((ends[i] - ends[i - 1]) / (ends[i - 1] - ends[i - 2]), 0.8, 1e-13);
  EXPECT_NEAR(graded(3, 3)[1], 1, 1e-15);
  EXPECT_THROW(graded(0, 3), std::invalid_argument);
  EXPECT_THROW(graded(1, 0), std::invalid_argument);
  EXPECT_THROW(graded(1, 3, 0), std::invalid_argument);
}

TEST(Line, AnArcLiesOnItsCircleAndItsFramesFollowIt) {
  const Mat3 frame = frame_along(Vec3(1, 2, -1), Vec3(0, 1, 1));
  const Vec3 start(0.1, 0.2, 0.3);
  const double radius = 0.5;
  const auto ends = graded(0.9, 6, 1.1);
  const auto nodes = arc(ends, radius, start, frame);
  ASSERT_EQ(nodes.size(), 13u);
  const Vec3 centre = start + radius * frame.col(1);
  const auto at = [&](double s) {  // the same arc, from its centre
    return Vec3(centre + radius * (std::sin(s / radius) * frame.col(0) - std::cos(s / radius) * frame.col(1)));
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const LineNode& n = nodes[i];
    EXPECT_NEAR(n.arc_length, i % 2 ? (ends[i / 2] + ends[i / 2 + 1]) / 2 : ends[i / 2], 1e-15);
    EXPECT_NEAR((n.position - at(n.arc_length)).norm(), 0, 1e-14);
    EXPECT_NEAR((n.frame.transpose() * n.frame - Mat3::Identity()).norm(), 0, 1e-14);
    EXPECT_NEAR(n.frame.determinant(), 1, 1e-14);
    const double h = 1e-5;  // error of the difference: h^2 / (6 radius^2)
    EXPECT_NEAR((n.frame.col(0) - (at(n.arc_length + h) - at(n.arc_length - h)) / (2 * h)).norm(), 0, 1e-10);
    EXPECT_NEAR((n.frame.col(1) - (centre - n.position) / radius).norm(), 0, 1e-14);
  }
  EXPECT_THROW(arc({0}, radius, start, frame), std::invalid_argument);
  EXPECT_THROW(arc({0, 1, 1}, radius, start, frame), std::invalid_argument);
}

TEST(Line, AStraightLineIsOne) {
  const Mat3 frame = frame_along(Vec3(0, 0, -2), Vec3(1, 0, 3));
  EXPECT_NEAR((frame.col(0) - Vec3(0, 0, -1)).norm(), 0, 1e-15);
  EXPECT_NEAR((frame.col(1) - Vec3(1, 0, 0)).norm(), 0, 1e-15);  // what of it is square to the line
  EXPECT_NEAR(frame.determinant(), 1, 1e-15);
  for (const LineNode& n : straight(graded(2, 4), Vec3(0, 1, 0), frame)) {
    EXPECT_NEAR((n.position - Vec3(0, 1, -n.arc_length)).norm(), 0, 1e-15);
    EXPECT_EQ(n.frame, frame);
  }
}

}  // namespace
}  // namespace hosel::mesh
