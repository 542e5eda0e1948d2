// Frames and signs: the global frame has X at the target, Y left, Z up; the face's Xc out of the face, Yc to the heel,
// Zc up. A right-handed player's toe is away from him, right of the target line as seen from behind the ball: -Y.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "golf/blow.hpp"
#include "golf/face_compliance.hpp"
#include "golf/first_contact.hpp"
#include "golf/launch.hpp"
#include "golf/units.hpp"

namespace hosel {
namespace {

constexpr double kRoundOff = 1e-14;

TEST(Frames, AClubMovesWhereItsAnglesSay) {
  const Delivery up{.club_speed = 40, .attack_angle = radians(30)}, right{.club_speed = 40, .club_path = radians(30)};
  EXPECT_NEAR((up.velocity() - Vec3(40 * std::sqrt(0.75), 0, 20)).norm(), 0, 40 * kRoundOff);
  EXPECT_NEAR((right.velocity() - Vec3(40 * std::sqrt(0.75), -20, 0)).norm(), 0, 40 * kRoundOff);
}

TEST(Frames, AFaceLooksWhereItsAnglesSay) {
  const auto axes = [](double loft, double open) {
    return Delivery{.dynamic_loft = radians(loft), .face_angle = radians(open)}.face_to_global();
  };
  EXPECT_NEAR((axes(0, 0) - Mat3::Identity()).norm(), 0, kRoundOff);
  EXPECT_NEAR((axes(30, 0).col(0) - Vec3(std::sqrt(0.75), 0, 0.5)).norm(), 0, kRoundOff);   // up
  EXPECT_NEAR((axes(0, 30).col(0) - Vec3(std::sqrt(0.75), -0.5, 0)).norm(), 0, kRoundOff);  // right
  // Loft first, then open: the leading edge stays level, and the loft is what a level sees.
  const Mat3 both = axes(45, 30);
  EXPECT_NEAR(both(2, 1), 0, kRoundOff);
  EXPECT_NEAR(std::asin(both(2, 0)), radians(45), kRoundOff);
  EXPECT_NEAR(std::atan2(-both(1, 0), both(0, 0)), radians(30), kRoundOff);
  EXPECT_NEAR((both.transpose() * both - Mat3::Identity()).norm(), 0, kRoundOff);
  EXPECT_NEAR(both.determinant(), 1, kRoundOff);
}

TEST(Frames, ALaunchIsReadAsItWasSent) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 100; ++k) {
    const double up = 1.5 * unit(random), right = 3 * unit(random), speed = 40 + 30 * unit(random);
    Launch l;
    l.velocity = Delivery{.club_speed = speed, .attack_angle = up, .club_path = right}.velocity();
    EXPECT_NEAR(l.ball_speed(), speed, 100 * kRoundOff);
    EXPECT_NEAR(l.launch_angle(), up, 100 * kRoundOff);  // asin and atan2 near their steep ends
    EXPECT_NEAR(l.azimuth(), right, 100 * kRoundOff);
  }
  Launch l;
  l.velocity = Vec3(60, 0, 0);
  // A ball whose lower side runs forward spins back: its lift, velocity and spin crossed the other way, is up.
  l.spin = Vec3(0, -300, 0);
  EXPECT_EQ(l.backspin(), 300);
  EXPECT_GT(l.spin.cross(l.velocity).z(), 0);
  // A fade turns to the right, -Y.
  l.spin = Vec3(0, 0, -100);
  EXPECT_EQ(l.sidespin(), 100);
  EXPECT_LT(l.spin.cross(l.velocity).y(), 0);
  l.spin = Vec3(20, -300, -400);
  EXPECT_DOUBLE_EQ(l.spin_axis(), std::atan2(4, 3));
  EXPECT_DOUBLE_EQ(l.spin_rate(), std::sqrt(250400.0));
  EXPECT_EQ(l.riflespin(), 20);
}

/// The ball's centre is the origin; ball and face touch in one point and have one normal there.
TEST(FirstContact, BallAndFaceTouch) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 100; ++k) {
    Blow b;
    b.delivery = {.club_speed = 45,
                  .attack_angle = 0.1 * unit(random),
                  .club_path = 0.1 * unit(random),
                  .dynamic_loft = 0.4 + 0.3 * unit(random),
                  .face_angle = 0.1 * unit(random),
                  .impact_toe = 0.03 * unit(random),
                  .impact_high = 0.02 * unit(random),
                  .head_angular_velocity = 20 * Vec3(unit(random), unit(random), unit(random))};
    b.club.head.cg = Vec3(-0.03, 0.004, 0.002);
    b.club.head.face = {.bulge = 0.3, .roll = 0.25};
    b.club.head.inertia = Vec3(2e-4, 3e-4, 4.5e-4).asDiagonal();
    const FirstContact c = first_contact(b);
    EXPECT_NEAR(c.point.norm(), b.ball.radius, 1e-15);
    // The same point, found from the head: toe is -Yc, high is Zc.
    const Face& face = b.club.head.face;
    const Vec3 there = c.face_axes.transpose() * (c.point - c.face_centre);
    EXPECT_NEAR(there.y(), -b.delivery.impact_toe, 1e-15);
    EXPECT_NEAR(there.z(), b.delivery.impact_high, 1e-15);
    EXPECT_NEAR(there.x(), face.height(there.y(), there.z()), 1e-15);
    // The normal stands square to the surface: by differences, whose error is the step squared times nought.
    const double h = 1e-6;
    const Vec3 n = c.face_axes.transpose() * c.normal;
    for (const Vec3& d : {Vec3(0, h, 0), Vec3(0, 0, h)}) {
      const Vec3 along =
          (face.point(there.y() + d.y(), there.z() + d.z()) - face.point(there.y() - d.y(), there.z() - d.z())) /
          (2 * h);
      EXPECT_NEAR(along.dot(n), 0, 1e-10);
    }
    EXPECT_NEAR(n.norm(), 1, kRoundOff);
    EXPECT_GT(n.x(), 0.9);
    // The head's particle there moves as a rigid body's.
    const Vec3 cg = c.face_centre + c.face_axes * b.club.head.cg;
    EXPECT_NEAR((c.head_arm - (c.point - cg)).norm(), 0, 1e-15);
    EXPECT_NEAR((c.approach - b.delivery.velocity() - b.delivery.head_angular_velocity.cross(c.point - cg)).norm(), 0,
                1e-12);
    EXPECT_NEAR(c.head_inertia.trace(), b.club.head.inertia.trace(), 1e-18);
    EXPECT_NEAR((c.head_inertia * c.face_axes.col(1) - 3e-4 * c.face_axes.col(1)).norm(), 0, 1e-18);
  }
  Blow away;
  away.delivery = {.club_speed = 40, .attack_angle = radians(120)};
  EXPECT_THROW(first_contact(away).closing_speed(), std::invalid_argument);
}

TEST(Head, SaysWhatNoBodyCanHave) {
  const Head good{.mass = 0.2, .inertia = Vec3(2e-4, 3e-4, 4.5e-4).asDiagonal()};
  EXPECT_TRUE(good.faults().empty());
  const auto faults = [&](auto&& change) {
    Head h = good;
    change(h);
    return h.faults().size();
  };
  EXPECT_EQ(faults([](Head& h) { h.mass = 0; }), 1u);
  EXPECT_EQ(faults([](Head& h) { h.mass = NAN; }), 1u);
  EXPECT_EQ(faults([](Head& h) { h.inertia(0, 1) = 1e-5; }), 1u);
  EXPECT_EQ(faults([](Head& h) { h.inertia(1, 1) = -3e-4; }), 1u);
  EXPECT_EQ(faults([](Head& h) { h.inertia(2, 2) = 5.1e-4; }), 1u);  // more than the sum of the others
  EXPECT_EQ(faults([](Head& h) { h.inertia(2, 2) = NAN; }), 1u);
  EXPECT_EQ(faults([](Head& h) { h.face.roll = -0.3; }), 1u);
}

TEST(Shaft, IsLinearBetweenItsStations) {
  Shaft shaft;
  shaft.stations = {
      {.arc_length = 0, .bending_stiffness_y = 60, .mass_per_length = 0.07, .centres = {.mass = {1e-3, 0}}},
      {.arc_length = 0.4, .bending_stiffness_y = 40, .mass_per_length = 0.06},
      {.arc_length = 1.1, .bending_stiffness_y = 19, .mass_per_length = 0.05}};
  EXPECT_EQ(shaft.length(), 1.1);
  EXPECT_NEAR(shaft.at(0.1).bending_stiffness_y, 55, 1e-12);
  EXPECT_NEAR(shaft.at(0.1).centres.mass[0], 0.75e-3, 1e-15);
  EXPECT_NEAR(shaft.at(0.7).bending_stiffness_y, 31, 1e-12);
  EXPECT_NEAR(shaft.at(0.75).mass_per_length, 0.055, 1e-15);
  EXPECT_EQ(shaft.at(-1).bending_stiffness_y, 60);
  EXPECT_EQ(shaft.at(2).bending_stiffness_y, 19);
  EXPECT_EQ(Shaft{}.length(), 0);
}

TEST(FaceCompliance, ItsSlopesAreThoseOfItsShape) {
  const FaceCompliance f{.mass = 0.01, .stiffness = 1e7, .half_width = 0.04, .half_height = 0.02};
  EXPECT_EQ(f.shape(0, 0).value, 1);
  for (const auto& [y, z] : {std::pair{0.04, 0.0}, {0.0, -0.02}, {0.03, 0.02}, {0.5, 0.5}}) {
    EXPECT_NEAR(f.shape(y, z).value, 0, 1e-15);
    EXPECT_NEAR(f.shape(y, z).slope.norm(), 0, 1e-12) << "clamped at its rim";
  }
  // Differences of a polynomial of degree four: the error is its third derivative, 1e6 / m^3, times h^2 / 6.
  const double h = 1e-6, y = 0.011, z = -0.007;
  const auto at = [&](double dy, double dz) { return f.shape(y + dy, z + dz); };
  EXPECT_NEAR(at(0, 0).slope.x(), (at(h, 0).value - at(-h, 0).value) / (2 * h), 1e-6);
  EXPECT_NEAR(at(0, 0).slope.y(), (at(0, h).value - at(0, -h).value) / (2 * h), 1e-6);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(at(0, 0).second(i, 0), (at(h, 0).slope[i] - at(-h, 0).slope[i]) / (2 * h), 1e-4);
    EXPECT_NEAR(at(0, 0).second(i, 1), (at(0, h).slope[i] - at(0, -h).slope[i]) / (2 * h), 1e-4);
  }
  EXPECT_GT(std::abs(at(0, 0).second(0, 1)), 100) << "the mixed one is there";
  EXPECT_EQ(FaceCompliance{}.shape(0.3, 0.2).value, 1) << "the same everywhere";
}

}  // namespace
}  // namespace hosel
