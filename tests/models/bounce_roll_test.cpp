// Bounce and roll against the same rules worked out in the plane, and against what must hold.
#include "models/flight/bounce_roll.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {
using namespace hosel;

models::FlightPoint landing(double speed, double angle_deg, double backspin, double sidespin = 0) {
  models::FlightPoint p{};
  p.position = {200, 0, 0};
  p.velocity = speed * Vec3(std::cos(radians(angle_deg)), 0, -std::sin(radians(angle_deg)));
  p.spin = {0, -backspin, -sidespin};
  return p;
}

TEST(BounceRoll, FollowsThePlanarRules) {
  // Penner's equations as printed, in his own planar quantities.
  const Ball ball;
  const double r = ball.radius, mu = 0.40;
  for (const double backspin : {50.0, 250.0, 700.0}) {
    double x = 200, u = 27 * std::cos(radians(40)), down = 27 * std::sin(radians(40)), w = backspin;
    int bounces = 0;
    for (;; ++bounces) {
      const double sign = u < 0 ? -1 : 1, forward = sign * u, spin = sign * w;
      const double v = std::hypot(u, down);
      const double theta = radians(15.4) * (v / 18.6) * (std::atan2(forward, down) / radians(44.4));
      const double along = forward * std::cos(theta) - down * std::sin(theta);
      const double into = forward * std::sin(theta) + down * std::cos(theta);
      const double e = into > 20 ? 0.12 : 0.510 - 0.0375 * into + 0.000903 * into * into;
      double along2, w2;
      if (const double slip = along + r * spin; mu >= 2 * std::abs(slip) / (7 * (1 + e) * into)) {
        along2 = 5.0 / 7 * along - 2.0 / 7 * r * spin;
        w2 = -along2 / r;
      } else {
        along2 = along - std::copysign(mu * into * (1 + e), slip);
        w2 = spin - std::copysign(5 * mu * into * (1 + e) / (2 * r), slip);
      }
      u = sign * (along2 * std::cos(theta) - e * into * std::sin(theta));
      down = along2 * std::sin(theta) + e * into * std::cos(theta);
      w = sign * w2;
      if (down * down / (2 * kGravity) < 5e-3) break;
      x += u * 2 * down / kGravity;
    }
    x += u * std::abs(u) / (2 * 5.0 / 7 * 0.131 * kGravity);
    const models::Run run = models::run_out(landing(27, 40, backspin), ball, {});
    ASSERT_GT(bounces, 1);
    EXPECT_EQ(run.bounces, bounces);
    EXPECT_NEAR(run.total, x, 1e-9 * x);
    EXPECT_NEAR(run.side, 0, 1e-12);
  }
}

TEST(BounceRoll, RunsLessWhereItShould) {
  const auto total = [](double angle, double spin) { return models::run_out(landing(27, angle, spin), {}, {}).total; };
  EXPECT_GT(total(38, 200), 205);             // a drive runs on
  EXPECT_LT(total(50, 200), total(38, 200));  // steeper
  EXPECT_LT(total(38, 600), total(38, 200));  // more backspin
  const models::Run run = models::run_out(landing(27, 38, 200), {}, {});
  EXPECT_GT(run.total_firm, run.total);
  EXPECT_LT(run.total_slow, run.total);
  EXPECT_GT(models::run_out(landing(27, 38, 200, 100), {}, {}).path.size(), 5u);
}

TEST(BounceRoll, RunsOnASlope) {
  const auto run = [](double slope, double sidespin = 0) {
    return models::run_out(landing(27, 38, 200, sidespin), {}, {.slope = slope});
  };
  const models::Run level = run(0), up = run(radians(2)), down = run(radians(-2));
  EXPECT_GT(level.bounces, 1);
  EXPECT_LT(up.total, level.total - 1);
  EXPECT_GT(down.total, level.total + 1);
  // Every point between two hops lies over the plane through the landing, the rest on it.
  for (const Vec3& x : up.path)
    EXPECT_GT(x.z() - up.path.front().z() - std::tan(radians(2)) * (x.x() - up.path.front().x()), -1e-9);
  EXPECT_NEAR(up.path.back().z() - up.path.front().z(),
              std::tan(radians(2)) * (up.path.back().x() - up.path.front().x()), 1e-9);
  // The steps on a slope of nothing are the closed form on level ground, to the millimetres that they err by.
  const models::Run nearly = run(1e-9, 100), plain = run(0, 100);
  EXPECT_NEAR(nearly.total, plain.total, 5e-3);
  EXPECT_NEAR(nearly.side, plain.side, 5e-3);
  EXPECT_EQ(nearly.bounces, plain.bounces);
}

/// The nearer to the slope on which the hops keep a height, the more of them: some 270 down 3 deg.
TEST(BounceRoll, BouncesDownASlopeUntilItStops) {
  const auto down = [](double slope) { return models::run_out(landing(27, 40, 200), {}, {.slope = radians(-slope)}); };
  const models::Run far = down(3);
  EXPECT_GT(far.bounces, 200);
  EXPECT_GT(far.total, down(2).total + 1);
  EXPECT_THROW(down(3.5), std::invalid_argument);
}

TEST(BounceRoll, RefusesASlopeOnWhichNothingStops) {
  EXPECT_THROW(models::run_out(landing(27, 40, 200), {}, {.slope = -0.1}), std::invalid_argument);
}

/// Beyond 53.6 m/s the ground that the ball makes for itself would face back along its way: 15.4 deg v / 18.6 m/s of
/// its angle's 44.4 deg.
TEST(BounceRoll, KnowsNoImpactsAsFastAsAToppedDrive) {
  for (const double angle : {1.0, 20.0, 45.0}) {
    EXPECT_THROW(models::run_out(landing(54, angle, 0), {}, {}, {}), std::domain_error) << angle;
    EXPECT_GT(models::run_out(landing(53, angle, 0), {}, {}, {}).path.size(), 1u) << angle;
  }
}

}  // namespace
