// A club of known motion and deflection, seen by its markers.
#include "models/club/marker_swing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace hosel::models {
namespace {

constexpr double kStill = 0.2, kEnd = 0.8, kLength = 0.9;  // [s], [s], clamp to hosel [m]

struct Bend {
  double lead, droop;
  Vec3 twist;
};
/// Nothing while the club is still.
Bend bend(double t) {
  const double s = std::max(0.0, t - kStill);
  return {0.05 * s, -0.03 * s * s, Vec3(0.2, -0.1, 0.3) * s};
}

struct Seen {
  MarkerTrack track;
  Vec3 clamp;                    // at address
  Mat3 axes = Mat3::Identity();  // of the grip at address
};

Seen seen() {
  Seen out;
  const Vec3 up = Vec3(0, 0.6, 0.8), hosel(0.1, -0.2, 0.05);
  out.axes.col(2) = up;
  out.axes.col(1) = up.cross(Vec3::UnitX()).normalized();
  out.axes.col(0) = out.axes.col(1).cross(up);
  out.clamp = hosel + kLength * up;
  // Each three about a middle: the hosel, and off the shaft's line.
  const std::array<Vec3, 3> head{Vec3(0.03, 0, 0.01), Vec3(-0.02, 0.03, 0), Vec3(-0.01, -0.03, -0.01)},
      body{Vec3(0.06, 0.01, 0.02), Vec3(0.02, 0.05, -0.03), Vec3(0.01, -0.03, 0.01)};
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.005 * i, s = std::max(0.0, t - kStill);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.5 * s * s, Vec3(1, 2, -1).normalized()));
    const Vec3 shift(0.3 * s * s, -0.2 * s * s, 0.1 * s * s);
    const auto moved = [&](const Vec3& x) -> Vec3 { return turn * x + shift; };
    const Bend b = bend(t);
    const Eigen::Quaterniond twist(b.twist.norm() > 0 ? Eigen::AngleAxisd(b.twist.norm(), b.twist.normalized())
                                                      : Eigen::AngleAxisd::Identity());
    out.track.times.push_back(t);
    out.track.shaft.emplace_back();
    out.track.head.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      out.track.shaft.back()[k] = moved(out.clamp + out.axes * body[k]);
      out.track.head.back()[k] = moved(out.clamp + out.axes * (Vec3(b.lead, b.droop, -kLength) + twist * head[k]));
    }
    out.track.wrists.push_back(moved(out.clamp + 0.15 * up));
  }
  out.track.head[100][1].x() = std::numeric_limits<double>::quiet_NaN();  // dropped out at 0.5 s
  return out;
}

TEST(MarkerSwing, ADropOutIsOneSampleOfOneMarker) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MarkerSwing whole = marker_swing(seen().track, kStill, kEnd);
  Seen s = seen();
  s.track.head[3][1].x() = s.track.shaft[5][0].z() = s.track.wrists[7].y() = nan;  // at address
  s.track.shaft[120][2].y() = nan;
  const MarkerSwing swing = marker_swing(s.track, kStill, kEnd);
  EXPECT_EQ(swing.clamp.times.size(), whole.clamp.times.size() - 2);
  EXPECT_EQ(swing.times.size(), whole.times.size() - 3);
  EXPECT_NEAR(swing.length, whole.length, 1e-12);
  EXPECT_LT((swing.clamp.positions.back() - whole.clamp.positions.back()).norm(), 1e-12);
  EXPECT_NEAR(swing.lead.back(), whole.lead.back(), 1e-12);
  for (std::size_t i = 0; i < s.track.times.size(); ++i) s.track.head[i][2].z() = nan;
  EXPECT_THROW(marker_swing(s.track, kStill, kEnd), std::invalid_argument);
}

TEST(MarkerSwing, FindsClampAndDeflection) {
  const Seen s = seen();
  const MarkerSwing swing = marker_swing(s.track, kStill, kEnd);
  EXPECT_NEAR(swing.length, kLength, 1e-12);
  ASSERT_EQ(swing.clamp.times.size(), 161U);
  ASSERT_EQ(swing.times.size(), 160U);  // but the one that dropped out
  EXPECT_LT((swing.clamp.positions.front() - s.clamp).norm(), 1e-12);
  EXPECT_GT((swing.clamp.positions.back() - s.clamp).norm(), 0.1);
  double largest = 0;
  for (std::size_t i = 0; i < swing.times.size(); ++i) {
    const Bend b = bend(swing.times[i]);
    EXPECT_NEAR(swing.lead[i], b.lead, 1e-12);
    EXPECT_NEAR(swing.droop[i], b.droop, 1e-12);
    largest = std::max(largest, swing.lead[i]);
  }
  EXPECT_GT(largest, 0.02);
  EXPECT_THROW(marker_swing(s.track, -1, kEnd), std::invalid_argument);
}

TEST(MarkerSwing, ItsErrorIsWhatTheShaftDidNotDo) {
  const Seen s = seen();
  const MarkerSwing swing = marker_swing(s.track, kStill, kEnd);
  const GripMotion motion(swing.clamp, 0.03);
  std::vector<SwingSample> samples;
  double square = 0;
  int n = 0;
  for (std::size_t i = 0; i < swing.times.size(); ++i) {
    const double t = swing.times[i];
    const Bend b = bend(t);
    samples.push_back({.time = t, .lead = b.lead, .droop = b.droop, .twist = b.twist});
    if (t < 0.3 || t > 0.7) continue;
    const Eigen::Quaterniond twist(Eigen::AngleAxisd(b.twist.norm(), b.twist.normalized()));
    for (const Vec3& reference : swing.head_reference) {
      const Vec3 arm = reference - Vec3(0, 0, -kLength);
      square += (Vec3(b.lead, b.droop, 0) + twist * arm - arm).squaredNorm();
      ++n;
    }
  }
  const double rigid = marker_error(swing, motion, {}, 0.3, 0.7);
  ASSERT_GT(rigid, 0.01);
  EXPECT_NEAR(rigid, std::sqrt(square / n), 1e-4);  // the motion is a spline of the clamp's poses
  EXPECT_LT(marker_error(swing, motion, samples, 0.3, 0.7), 1e-4);
  // One sample, of an undeflected club, is a rigid one.
  EXPECT_DOUBLE_EQ(marker_error(swing, motion, {SwingSample{}}, 0.3, 0.7), rigid);
  EXPECT_THROW(marker_error(swing, motion, samples, 2, 3), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::models
