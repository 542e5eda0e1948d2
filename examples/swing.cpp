// A flexible club swung about a fixed hub in a vertical plane: lead and droop of the hosel as it goes.
#include <cmath>
#include <cstdio>

#include "golf/shaft_library.hpp"
#include "golf/units.hpp"
#include "models/club/swing.hpp"

int main() {
  using namespace hosel;
  Club club;
  club.head = {.mass = 0.204, .cg = {-0.042, 0.0, 0.003}, .inertia = Vec3(2.8e-4, 4.1e-4, 5.7e-4).asDiagonal()};
  club.shaft = shaft_library().front().make();
  club.geometry.hosel = {-0.02, 0.055, 0.02};
  club.geometry.shaft_axis = Vec3(0, std::cos(radians(58)), std::sin(radians(58)));

  // The grip on a circle about the hub, speeding up from rest to 20 rad/s in half a second.
  const double radius = 0.6, duration = 0.5, last = 20;
  const auto turn = [&](double t) {  // angle, rate, acceleration
    const double s = std::max(t, 0.0) / duration;
    return Vec3(last * duration * s * s * s / 3, last * s * s, 2 * last * s / duration);
  };
  models::GripDrive drive;
  drive.motion = [&](double t) {
    const Vec3 a = turn(t);
    fem::Pose pose;
    const Eigen::AngleAxisd about(-a[0], Vec3::UnitY());
    pose.rotation = Eigen::Quaterniond(about);
    const Vec3 arm = about * Vec3(0, 0, -radius), w(0, -a[1], 0), dw(0, -a[2], 0);
    pose.position = arm;
    pose.velocity = w.cross(arm);
    pose.acceleration = dw.cross(arm) + w.cross(w.cross(arm));
    pose.angular_velocity = w;  // about a fixed axis: the same in the body frame
    pose.angular_acceleration = dw;
    return pose;
  };
  models::Swing swing(club, {.elements = 10, .step = 2e-3}, drive);
  double least = 0;
  swing.run(swing.start(0, swing.equilibrium(0)), duration, [&](const models::SwingSample& now) {
    least = std::min(least, now.lead);
    if (std::lround(now.time / 2e-3) % 50 == 0)
      std::printf("%.2f s  lead %6.1f mm  droop %6.1f mm\n", now.time, 1e3 * now.lead, 1e3 * now.droop);
  });
  // A club that is sped up lags: the hosel stays behind its place on a rigid club by centimetres.
  return least < -0.01 ? 0 : 1;
}
