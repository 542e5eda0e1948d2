// The energy ledger of an FE impact: it closes, and its gap falls with the step at the integrator's order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "golf/units.hpp"
#include "tests/support/coarse_impact.hpp"

namespace hosel::models {
namespace {

/// A coarse ball on a patch soft enough for the step to resolve: the layer's own frequency is
/// sqrt(penalty E / (R rho h)), and order is to be seen below it alone.
FeImpactOptions resolved(int harmonics, int steps, bool viscosity) {
  FeImpactOptions o;
  o.ball = test::test_ball();
  o.harmonics = harmonics;
  o.mesh = {.sector = 2, .rings = 2, .pole = 0.5, .skin = 0.6, .core = 0.4};
  o.penalty = 50;
  o.newton_relative = 1e-9;
  o.steps_per_contact = steps;
  if (!viscosity)
    for (BallLayer& layer : o.ball.layers) layer.material.branches.clear();
  return o;
}

Blow normal() {
  Blow blow;
  blow.club.head.mass = INFINITY;
  blow.delivery.club_speed = 45;
  return blow;
}

Blow oblique(bool friction) {
  Blow blow;
  blow.contact.patch.coefficient = friction ? 0.3 : 0;
  blow.club.head.mass = 0.2643;
  blow.club.head.inertia = Vec3(2.752e-4, .577e-4, 2.889e-4).asDiagonal();
  blow.delivery.club_speed = 36.7;
  blow.delivery.dynamic_loft = radians(22);
  return blow;
}

/// |closure| over the initial kinetic energy, the event having happened.
double gap(const Blow& blow, const FeImpactOptions& options) {
  const FeImpactResult r = Impact(options).run(blow).result;
  EXPECT_GT(r.peak_force, 8e3);
  EXPECT_GT(r.contact_time, 0.3e-3);
  EXPECT_EQ(r.ledger.viscous > 0.01 * r.ledger.initial, !options.ball.layers.front().material.branches.empty());
  EXPECT_EQ(r.ledger.friction > 0, options.harmonics > 0 && blow.contact.patch.coefficient > 0);
  return std::abs(r.ledger.closure) / r.ledger.initial;
}

TEST(EnergyLedger, GapOfANormalBlowFallsAtSecondOrder) {
  for (const bool viscosity : {false, true}) {
    const double coarse = gap(normal(), resolved(0, 240, viscosity));
    const double fine = gap(normal(), resolved(0, 1920, viscosity));
    EXPECT_LT(coarse, 1e-3);
    // Generalized-alpha is of second order; contact begins and ends within steps, which scatters the figure.
    EXPECT_GT(std::log(coarse / fine) / std::log(8.0), viscosity ? 1.2 : 1.8) << coarse << " -> " << fine;
  }
}

TEST(EnergyLedger, ClosesWithFrictionAndViscosityOnAndOff) {
  for (const bool friction : {false, true})
    for (const bool viscosity : {false, true}) {
      const double coarse = gap(oblique(friction), resolved(2, 120, viscosity));
      const double fine = gap(oblique(friction), resolved(2, 480, viscosity));
      SCOPED_TRACE(testing::Message() << "friction " << friction << ", viscosity " << viscosity);
      EXPECT_LT(coarse, 1e-3);
      EXPECT_GT(std::log(coarse / fine) / std::log(4.0), 1.5) << coarse << " -> " << fine;
    }
}

/// Linear momentum of ball and free head together is kept to round-off, angular momentum (about the global
/// origin) at the integrator's order: friction and pressure act on both bodies at one point.
TEST(EnergyLedger, MomentumOfBallAndFreeHeadIsKept) {
  const Blow blow = oblique(true);
  std::vector<double> drift;
  for (int steps : {60, 240}) {
    Vec3 linear0 = Vec3::Zero(), angular0 = linear0;
    double linear_gap = 0, angular_gap = 0, force = 0;
    Impact(resolved(2, steps, true)).run(blow, [&](const ImpactView& view) {
      const fem::MeanMotion ball = view.ball.motion(view.state);
      const fem::RigidBody& head = *view.bodies.head;
      const Vec3 linear = ball.momentum + head.linear_momentum(view.state);
      const Vec3 angular = ball.angular_momentum + ball.centre.cross(ball.momentum) + head.angular_momentum(view.state);
      if (view.state.time == 0) linear0 = linear, angular0 = angular;
      linear_gap = std::max(linear_gap, (linear - linear0).norm() / linear0.norm());
      angular_gap = std::max(angular_gap, (angular - angular0).norm());
      force = std::max(force, view.report.normal_force);
    });
    ASSERT_GT(force, 8e3);
    EXPECT_LT(linear_gap, 1e-10);
    drift.push_back(angular_gap /
                    (0.4 * blow.ball.mass * blow.ball.radius * blow.ball.radius * 600));  // of the ball's spin
  }
  EXPECT_LT(drift[0], 5e-3);
  EXPECT_GT(std::log(drift[0] / drift[1]) / std::log(4.0), 1.5) << drift[0] << " -> " << drift[1];
}

}  // namespace
}  // namespace hosel::models
