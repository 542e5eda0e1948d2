/// A smooth swing of the project's own: a double pendulum of arms and club in an inclined plane, driven at the
/// hub and let go at the wrists; it ends at impact, t = 0, with a head speed near 50 m/s.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "golf/shaft_library.hpp"
#include "golf/units.hpp"
#include "models/club/grip_motion.hpp"
#include "models/club/swing.hpp"

namespace hosel::test {

/// Angles of the arms and of the club from their place at impact, in the plane [rad].
struct SwingAngles {
  std::vector<double> times, arms, club;
};

/// The downswing is the motion of a rigid double pendulum (arms of 0.8 kg m^2 and 0.65 m; club of
/// 0.26 kg m and 0.285 kg m^2 about the grip) under a hub torque that rises to 100 N m within 0.12 s, with wrists
/// that only resist further cocking; the backswing is a smooth polynomial to the top.
inline SwingAngles swing_angles(double rate) {
  constexpr double a = 0.65, I1 = 0.8, mb = 0.26, I2 = 0.285, m = 0.264, cocked = 1.2, hub = 100;
  using V = Eigen::Vector4d;  // arms, club, and their rates
  const auto slope = [&](double t, const V& y) {
    const double c = y[1] - y[0], s = std::min(1.0, t / 0.12);
    const double torque = -hub * s * s * (3 - 2 * s);
    const double wrist = -20 * (std::tanh((c - cocked) / 0.15) + 1) * (c - cocked + 0.15) - 0.2 * (y[3] - y[2]);
    Eigen::Matrix2d M;
    M << I1 + m * a * a, mb * a * std::cos(c), mb * a * std::cos(c), I2;
    const Eigen::Vector2d f(torque - wrist + mb * a * std::sin(c) * y[3] * y[3],
                            wrist - mb * a * std::sin(c) * y[2] * y[2]);
    const Eigen::Vector2d acc = M.inverse() * f;
    return V(y[2], y[3], acc[0], acc[1]);
  };
  // From rest at the top until the club is in line with the arms; then all angles are counted from there.
  const double h = 1e-4;
  std::vector<V> path{V(1.9, 1.9 + cocked - 0.15, 0, 0)};
  for (double t = 0; path.back()[1] - path.back()[0] > 0.05 && t < 1; t += h) {
    const V y = path.back(), k1 = slope(t, y), k2 = slope(t + h / 2, y + h / 2 * k1),
            k3 = slope(t + h / 2, y + h / 2 * k2), k4 = slope(t + h, y + h * k3);
    path.push_back(y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4));
  }
  const double down = h * static_cast<double>(path.size() - 1);
  const V end = path.back();
  const Eigen::Vector2d top = (path.front() - end).head<2>();
  SwingAngles out;
  const int n = static_cast<int>(std::lround(1.1 * rate));
  for (int i = 0; i <= n; ++i) {
    const double t = -1.1 + 1.1 * i / n;
    Eigen::Vector2d x = top;
    if (t < -down) {
      const double s = (t + 1.1) / (1.1 - down);
      x *= s * s * s * (10 + s * (-15 + 6 * s));
    } else {
      const double at = (t + down) / h;
      const auto k = std::min(static_cast<std::size_t>(at), path.size() - 2);
      const double w = at - static_cast<double>(k);
      // Cubic between the integrator's points.
      const V &p = path[k], &q = path[k + 1];
      for (int c = 0; c < 2; ++c)
        x[c] = p[c] * (1 + 2 * w) * (1 - w) * (1 - w) + q[c] * w * w * (3 - 2 * w) +
               h * w * (1 - w) * ((1 - w) * p[c + 2] - w * q[c + 2]) - end[c];
    }
    out.times.push_back(t);
    out.arms.push_back(x[0]);
    out.club.push_back(x[1]);
  }
  return out;
}

inline models::GripTrack swing_track(double rate = 500) {
  const SwingAngles angles = swing_angles(rate);
  const double arm = 0.65, top = angles.club.empty() ? 1 : *std::max_element(angles.club.begin(), angles.club.end());
  const Vec3 e1 = Vec3::UnitX(), e2(0, std::cos(radians(50)), std::sin(radians(50)));
  const Vec3 hub = (arm + 1.2) * e2;
  models::GripTrack track;
  for (std::size_t i = 0; i < angles.times.size(); ++i) {
    const double arms = angles.arms[i], club = angles.club[i], roll = 1.2 * club / top;
    Mat3 R;
    R.col(0) = std::cos(club) * e1 - std::sin(club) * e2;
    R.col(2) = std::cos(club) * e2 + std::sin(club) * e1;
    R.col(1) = R.col(2).cross(R.col(0));
    R = (R * Eigen::AngleAxisd(roll, Vec3::UnitZ())).eval();
    track.times.push_back(angles.times[i]);
    track.positions.push_back(hub - arm * (std::cos(arms) * e2 + std::sin(arms) * e1));
    track.attitudes.emplace_back(R);
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
