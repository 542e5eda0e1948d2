/// A smooth swing of the project's own: arms and wrists in one plane, the club rolling about its shaft; it ends
/// at impact, t = 0, with a head speed near 50 m/s.
#pragma once

#include <cmath>

#include "golf/shaft_library.hpp"
#include "golf/units.hpp"
#include "models/grip_motion.hpp"
#include "models/swing.hpp"

namespace hosel::test {

/// Pose of the grip frame at t in [-1.1, 0] s. The plane leans 40 degrees off the vertical towards the golfer.
inline std::pair<Vec3, Eigen::Quaterniond> swing_pose(double t) {
  constexpr double top = -0.3, begin = -1.1, arm = 0.65;
  const auto back = [](double s) { return s * s * s * (10 + s * (-15 + 6 * s)); };
  const auto down = [](double s, double a, double b, double c) { return 1 - s * s * s * (a + s * (b + s * c)); };
  double arms = 1.9, club = 3.4, roll = 1.2;  // at the top [rad]
  if (t < top) {
    const double f = back(std::max(0.0, (t - begin) / (top - begin)));
    arms *= f, club *= f, roll *= f;
  } else {
    const double s = (t - top) / -top;
    arms *= down(s, 1.95, -0.95, 0);
    club *= down(s, -1.74, 5.17, -2.43);
    roll *= down(s, -1.0, 4.0, -2.0);
  }
  const Vec3 e1 = Vec3::UnitX(), e2(0, std::cos(radians(50)), std::sin(radians(50)));
  const Vec3 hub = (0.65 + 1.2) * e2;
  Mat3 R;
  R.col(0) = std::cos(club) * e1 - std::sin(club) * e2;
  R.col(2) = std::cos(club) * e2 + std::sin(club) * e1;
  R.col(1) = R.col(2).cross(R.col(0));
  R = (R * Eigen::AngleAxisd(roll, Vec3::UnitZ())).eval();
  return {hub - arm * (std::cos(arms) * e2 + std::sin(arms) * e1), Eigen::Quaterniond(R)};
}

inline models::GripTrack swing_track(double rate = 500) {
  models::GripTrack track;
  const int n = static_cast<int>(std::lround(1.1 * rate));
  for (int i = 0; i <= n; ++i) {
    const double t = -1.1 + 1.1 * i / n;
    const auto [x, q] = swing_pose(t);
    track.times.push_back(t);
    track.positions.push_back(x);
    track.attitudes.push_back(q);
  }
  return track;
}

/// The club of the reference data: 60 g shaft with 1 % damping in the first mode, 0.204 kg driver head.
inline Club driver_club() {
  Club club;
  club.head.mass = 0.204;
  club.head.cg = {-0.0423, 0.001, 0.0029};
  club.head.inertia << 2.843e-4, 0.530e-4, -0.733e-4, 0.530e-4, 4.085e-4, 0.0005e-4, -0.733e-4, 0.0005e-4, 5.679e-4;
  club.head.face = {0.305, 0.305};
  club.shaft = shaft_library().front().make();
  club.shaft->damping_time = 2 * 0.01 / (2 * kPi * 4.0);
  club.geometry.hosel = Vec3(-0.02, 0.055, 0.02);
  club.geometry.shaft_axis = Vec3(0, std::cos(radians(58)), std::sin(radians(58)));
  return club;
}

}  // namespace hosel::test
