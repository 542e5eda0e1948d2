// [@moving-beams]: the grip's motion between samples and at its end, impact.
#include "models/club/grip_motion.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hosel::models {
namespace {

const Vec3 kAxis = Vec3(0.3, -0.5, 0.81).normalized();

/// Rotation about one axis at 40 + 400 t rad/s, sampled at 723 Hz, ending at t = 0.1 s.
GripTrack reference_track(double noise, unsigned seed) {
  GripTrack track;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int i = 0; i <= 72; ++i) {
    const double t = 0.1 - (72 - i) / 723.0;
    track.times.push_back(t);
    track.positions.push_back(Vec3(std::sin(20 * t), std::cos(15 * t), t * t) +
                              Vec3(noise * normal(random), noise * normal(random), noise * normal(random)));
    track.attitudes.emplace_back(Eigen::AngleAxisd(40 * t + 200 * t * t, kAxis));
  }
  return track;
}

TEST(GripMotion, RatesAreRightUpToImpact) {
  const GripMotion motion(reference_track(0, 1), 0);
  // Reference: inside 2.5e-5 rad/s and 0.18 rad/s^2; at the last sample 6e-4 and 1.7 with a not-a-knot end
  // (0.31 and 730 with a natural one), all for a cubic. A quintic is two orders better: a tenth of it is asked.
  const auto errors = [&](double t) {
    const fem::Pose p = motion.at(t);
    return std::pair((p.angular_velocity - (40 + 400 * t) * kAxis).norm(),
                     (p.angular_acceleration - 400 * kAxis).norm());
  };
  const auto [w_end, a_end] = errors(0.1);
  EXPECT_LT(w_end, 6e-5);
  EXPECT_LT(a_end, 0.17);
  for (double t = 0.04; t < 0.06; t += 1e-4) {
    EXPECT_LT(errors(t).first, 2.5e-6) << t;
    EXPECT_LT(errors(t).second, 0.018) << t;
  }
}

TEST(GripMotion, IsItsOwnDerivative) {
  const GripMotion motion(reference_track(0, 1), 0.015);
  const double h = 1e-6, t = 0.0512;
  const fem::Pose a = motion.at(t - h), b = motion.at(t + h), p = motion.at(t);
  EXPECT_LT(((b.position - a.position) / (2 * h) - p.velocity).norm(), 1e-6);
  EXPECT_LT(((b.velocity - a.velocity) / (2 * h) - p.acceleration).norm(), 1e-4);
  EXPECT_LT((fem::rotation_log(a.rotation.conjugate() * b.rotation) / (2 * h) - p.angular_velocity).norm(), 1e-5);
  EXPECT_LT(((b.angular_velocity - a.angular_velocity) / (2 * h) - p.angular_acceleration).norm(), 1e-3);
}

TEST(GripMotion, SmoothingTamesTheAccelerationOfNoise) {
  // 0.1 mm at 723 Hz is 314 m/s^2 at the knots of an interpolating spline; knots 20 ms apart leave a few.
  const double noise = 1e-4;
  const GripMotion raw(reference_track(noise, 2), 0), smooth(reference_track(noise, 2), 0.02);
  double worst_raw = 0, worst_smooth = 0;
  for (double t = 0.01; t < 0.1; t += 1e-3) {
    const Vec3 exact(-400 * std::sin(20 * t), -225 * std::cos(15 * t), 2);
    worst_raw = std::max(worst_raw, (raw.at(t).acceleration - exact).norm());
    worst_smooth = std::max(worst_smooth, (smooth.at(t).acceleration - exact).norm());
  }
  EXPECT_GT(worst_raw, 300);
  EXPECT_LT(worst_smooth, 60);
}

TEST(GripMotion, WhatComesAfterTheEndDoesNotReachBack) {
  GripTrack struck = reference_track(0, 1);
  const double end = struck.times[50];
  for (std::size_t i = 51; i < struck.times.size(); ++i)  // as a grip does that an impact stops
    struck.positions[i] = struck.positions[50];
  const double wrong =
      (GripMotion(struck, 0.02).at(end).velocity - GripMotion(reference_track(0, 1), 0.02).at(end).velocity).norm();
  EXPECT_GT(wrong, 0.5);
  struck.cut(end);
  ASSERT_EQ(struck.times.size(), 51u);
  ASSERT_EQ(struck.attitudes.size(), 51u);
  const GripMotion motion(struck, 0.02);
  EXPECT_DOUBLE_EQ(motion.last(), end);
  const Vec3 exact(20 * std::cos(20 * end), -15 * std::sin(15 * end), 2 * end);
  EXPECT_LT((motion.at(end).velocity - exact).norm(), 0.01 * wrong);
}

/// Turns about y, then the new x, then the new z: the columns by hand.
TEST(GripMotion, AnglesTurnAboutYThenXThenZ) {
  const double a = 0.7, b = -0.4, c = 1.9, sa = std::sin(a), ca = std::cos(a), sb = std::sin(b), cb = std::cos(b),
               sc = std::sin(c), cc = std::cos(c);
  const Mat3 R = from_yxz(a, b, c).toRotationMatrix();
  EXPECT_LT((R.col(2) - Vec3(sa * cb, -sb, ca * cb)).norm(), 1e-14);
  EXPECT_LT((R.col(0) - Vec3(ca * cc + sa * sb * sc, cb * sc, ca * sb * sc - sa * cc)).norm(), 1e-14);
}

TEST(GripMotion, NamesWhatIsWrong) {
  GripTrack track = reference_track(0, 1);
  EXPECT_TRUE(track.faults(0.01).empty());
  std::swap(track.times[5], track.times[6]);
  EXPECT_NE(track.faults(0.01).at(0).find("backwards"), std::string::npos);
  track = reference_track(0, 1);
  track.times.erase(track.times.begin() + 30, track.times.begin() + 50);
  track.positions.erase(track.positions.begin() + 30, track.positions.begin() + 50);
  track.attitudes.erase(track.attitudes.begin() + 30, track.attitudes.begin() + 50);
  EXPECT_NE(track.faults(0.01).at(0).find("gap"), std::string::npos);
  track = reference_track(0, 1);
  track.attitudes[7] = track.attitudes[7] * Eigen::Quaterniond(Eigen::AngleAxisd(2, Vec3::UnitX()));
  EXPECT_NE(track.faults(0.01).at(0).find("jumps"), std::string::npos);
  EXPECT_THROW(from_axes(Vec3(1, 0, 0), Vec3(0.1, 1, 0), 1e-3), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::models
