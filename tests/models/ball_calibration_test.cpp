// A ball's material found again from what a ball of known material did.
#include "models/calibration/ball_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "golf/units.hpp"

namespace hosel::models {
namespace {

constexpr double kElastic = 1.3, kViscous = 0.7, kFriction = 0.9;  // factors of the true ball over the start

FeImpactOptions few_elements() {
  FeImpactOptions o;
  o.resolve(Accuracy::look);
  o.mesh.sector = 1;
  o.mesh.rings = 1;
  o.harmonics = 0;
  o.steps_per_contact = 30;
  return o;
}

using What = FreeParameter::What;
constexpr PatchFriction kStart{.coefficient = 0.2};
const std::vector<FreeParameter> kModuli{{What::long_term}, {What::branches}};

/// The start with all moduli changed as the calibration may change them.
FeImpactOptions true_ball(FeImpactOptions o) {
  for (BallLayer& layer : o.ball.layers) {
    layer.material.elastic = layer.material.elastic.stiffened(kElastic);
    for (auto& branch : layer.material.branches) branch.modulus *= kViscous;
  }
  return o;
}

/// What that ball does at the wall: a line through two speeds is a line through all there are.
NormalImpactTarget at_the_wall(FeImpactOptions truth) {
  truth.harmonics = 0;
  truth.steps_per_contact = 120;  // as the calibration meets the wall
  const NormalImpactPoint slow = normal_impact(truth, {}, 25), fast = normal_impact(truth, {}, 45);
  const double slope = (fast.restitution - slow.restitution) / 20;
  return {.speeds = {25, 45},
          .restitution = slow.restitution - 25 * slope,
          .restitution_slope = slope,
          .restitution_sigma = 1e-3,
          .contact_speed = 45,
          .contact_time = fast.contact_time,
          .contact_time_sigma = 1e-6};
}

TEST(BallCalibration, FindsTheModuliFromBounces) {
  const FeImpactOptions start = few_elements(), truth = true_ball(start);
  const NormalImpactTarget target = at_the_wall(truth);
  const NormalImpactPoint before = normal_impact(start, {}, 45);
  ASSERT_GT(std::abs(before.contact_time - target.contact_time), 10 * target.contact_time_sigma);
  int told = 0;
  const BallCalibration fit = calibrate_ball({.options = start, .friction = kStart, .wall = target, .free = kModuli},
                                             [&](int n, double) { told = n; });
  EXPECT_TRUE(fit.converged) << fit.report;
  EXPECT_GT(told, 0);
  EXPECT_GE(fit.evaluations, told);  // the derivatives at the solution come after the last residuals
  ASSERT_EQ(fit.values.size(), 2U);
  // Within three of the errors that it tells, which are those of the targets' sigmas.
  for (const int k : {0, 1}) {
    const double truth_log = std::log(k ? kViscous : kElastic), sd = std::sqrt(fit.covariance(k, k));
    EXPECT_NEAR(std::log(fit.values[std::size_t(k)] / fit.start[std::size_t(k)]), truth_log, 3 * sd) << k;
    EXPECT_LT(sd, 0.2 * std::abs(truth_log)) << k;
  }
  ASSERT_EQ(fit.points.size(), 2U);
  EXPECT_NEAR(fit.points[1].restitution, fit.points[1].target, target.restitution_sigma);
  EXPECT_EQ(fit.ball.layers[0].material.branches[0].modulus, fit.values[1]);
  EXPECT_EQ(fit.friction, kStart.coefficient);
}

/// A steep blow slides to its end: its spin is the friction's, and its loft is found from the launch angle.
TEST(BallCalibration, FindsFrictionFromAnObliqueBlowWhoseLoftIsNotKnown) {
  FeImpactOptions start = few_elements();
  start.harmonics = 1;
  const FeImpactOptions truth = true_ball(start);
  Blow blow;
  blow.contact.patch.coefficient = kFriction * kStart.coefficient;
  blow.club.head.mass = 0.25;
  blow.club.head.inertia = Vec3(3e-4, 2e-4, 3e-4).asDiagonal();
  blow.delivery = {.club_speed = 35, .dynamic_loft = radians(48)};
  const Launch made = Impact(truth).launch(blow);
  blow.delivery.dynamic_loft = radians(46);
  const ObliqueTarget shot{.name = "steep",
                           .blow = blow,
                           .launch_angle = made.launch_angle(),
                           .spin_rate = made.spin_rate(),
                           .spin_sigma = 0.01,
                           .ball_speed = made.ball_speed(),
                           .ball_speed_sigma = 0.01};
  std::vector<FreeParameter> free = kModuli;
  free.push_back({What::friction});
  const BallCalibration fit =
      calibrate_ball({.options = start, .friction = kStart, .wall = at_the_wall(truth), .shots = {shot}, .free = free});
  EXPECT_TRUE(fit.converged) << fit.report;
  ASSERT_EQ(fit.values.size(), 3U);
  EXPECT_NEAR(fit.friction / kStart.coefficient, kFriction, 0.02);
  EXPECT_EQ(fit.values[2], fit.friction);
  ASSERT_EQ(fit.shots.size(), 1U);
  EXPECT_NEAR(degrees(fit.shots[0].loft), 48, 0.2);
  EXPECT_NEAR(fit.shots[0].spin_rate / made.spin_rate(), 1, 0.01);
  EXPECT_NEAR(fit.shots[0].ball_speed / made.ball_speed(), 1, 0.005);
}

/// Two shots of one ball, one of them struck higher than its blow says: the height is found, each shot is predicted by
/// the fit without it, and the shot that nothing has seen is predicted too.
TEST(BallCalibration, FindsWhereAShotWasStruckAndPredictsTheShotsThatItLeavesOut) {
  FeImpactOptions start = few_elements();
  start.harmonics = 1;
  const FeImpactOptions truth = true_ball(start);
  const auto shot = [&](const char* name, double loft, double high) {
    Blow blow;
    blow.contact.patch.coefficient = kFriction * kStart.coefficient;
    blow.club.head.mass = 0.2;
    blow.club.head.cg = Vec3(-0.03, 0, 0);
    blow.club.head.inertia = Vec3(3e-4, 3e-4, 5e-4).asDiagonal();
    blow.delivery = {.club_speed = 40, .dynamic_loft = radians(loft), .impact_high = high};
    const Launch made = Impact(truth).launch(blow);
    blow.delivery.impact_high = 0;
    return ObliqueTarget{.name = name,
                         .blow = blow,
                         .launch_angle = made.launch_angle(),
                         .spin_rate = made.spin_rate(),
                         .spin_sigma = 0.01,
                         .ball_speed = made.ball_speed(),
                         .ball_speed_sigma = 0.005};
  };
  std::vector<ObliqueTarget> shots{shot("high", 20, 0.006), shot("steep", 40, 0), shot("between", 30, 0)};
  shots.back().seen = false;
  std::vector<FreeParameter> free = kModuli;
  free.push_back({What::friction});
  free.push_back({.what = What::impact_high, .shots = {0}});
  const BallCalibration fit = calibrate_ball({.options = start,
                                              .friction = kStart,
                                              .wall = at_the_wall(truth),
                                              .shots = shots,
                                              .free = free,
                                              .leave_one_out = true});
  EXPECT_TRUE(fit.converged) << fit.report;
  ASSERT_EQ(fit.values.size(), 4U);
  // The strike moves the spin by some 3 % a millimetre: its error is that of a spin known to 1 %.
  EXPECT_NEAR(fit.values[3], 0.006, 0.0015);
  ASSERT_EQ(fit.shots.size(), 3U);
  EXPECT_NEAR(fit.shots[2].spin_rate / shots[2].spin_rate, 1, 0.02);  // never seen
  ASSERT_EQ(fit.left_out.size(), 2U);
  EXPECT_EQ(fit.left_out[0].name, "high");
  EXPECT_NEAR(fit.left_out[0].spin_rate / shots[0].spin_rate, 1, 0.03);  // its own nuisance is fitted to it
  EXPECT_GT(fit.left_out_values[1][3], 0.3);  // [cm]: without the steep one the strike is still found
}

TEST(BallCalibration, WhatNoDataSeeIsRefused) {
  const FeImpactOptions start = few_elements();
  const auto refused = [](BallCalibrationProblem problem) {
    EXPECT_FALSE(problem.faults().empty());
    EXPECT_THROW(calibrate_ball(problem), std::invalid_argument);
  };
  refused({.options = start, .free = {{What::layer}}});
  refused({.options = start, .free = {{What::friction}}});
  refused({.options = start, .wall = {.contact_speed = 41}, .free = kModuli});
  refused({.options = start, .wall = {.restitutions = {0.8}}, .free = kModuli});
  refused({.options = start, .shots = {ObliqueTarget{}}, .free = {{.what = What::face_stiffness, .shots = {0}}}});
  refused({.options = start, .shots = {ObliqueTarget{}}, .free = {{What::impact_high}}});
  refused({.options = start});
  refused({.options = start, .shots = {ObliqueTarget{}}, .free = {{.what = What::layer, .layer = 0}}});
  FeImpactOptions elastic = start;
  for (BallLayer& layer : elastic.ball.layers) layer.material.branches.clear();
  refused({.options = elastic, .free = kModuli});
}

}  // namespace
}  // namespace hosel::models
