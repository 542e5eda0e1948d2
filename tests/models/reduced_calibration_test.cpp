// What the reduced models need of a ball, found from its finite elements.
#include "models/calibration/reduced_calibration.hpp"

#include <gtest/gtest.h>

#include "golf/units.hpp"

namespace hosel::models {
namespace {

FeImpactOptions coarse() {
  FeImpactOptions o;
  o.resolve(Accuracy::look);
  o.harmonics = 2;
  return o;
}

std::vector<Blow> blows() {
  std::vector<Blow> out;
  for (const double speed : {30.0, 42.0})
    for (const double loft : {18.0, 26.0, 34.0}) {
      Blow b;
      b.club.head.mass = 0.26;
      b.club.head.cg = Vec3(-0.002, 0, 0);
      b.club.head.inertia = Vec3(2.75e-4, 0.58e-4, 2.9e-4).asDiagonal();
      b.contact.patch.coefficient = 0.3;
      b.delivery = {.club_speed = speed, .dynamic_loft = radians(loft)};
      out.push_back(b);
    }
  return out;
}

TEST(ReducedCalibration, BringsEveryReducedModelToTheFiniteElements) {
  const FeImpactOptions fe = coarse();
  const std::vector<Blow> design = blows();
  const ReducedCalibration fit = calibrate_reduced(fe, design);
  ASSERT_EQ(fit.launches.size(), design.size());
  for (const Launch& l : fit.launches) {  // every blow happened
    ASSERT_GT(l.ball_speed(), 30);
    ASSERT_GT(rpm(l.spin_rate()), 2000);
  }
  ASSERT_EQ(fit.bands.size(), 4U);
  // The reduced models have three to five parameters for six blows of one club: what is left is their form, some 1 % of
  // speed and a few per cent of spin (5,000 rpm).
  for (const ReducedBand& b : fit.bands) {
    EXPECT_LT(b.ball_speed_rms, 0.5) << b.model;
    EXPECT_LT(degrees(b.launch_angle_rms), 0.5) << b.model;
    EXPECT_LT(rpm(b.spin_rms), 400) << b.model;
    EXPECT_LE(b.spin_rms, b.spin_max);
  }
  // The friction is that of the finite elements, not another one that fits.
  EXPECT_EQ(fit.law.friction, 0.3);
  EXPECT_EQ(fit.volume.friction, 0.3);
  EXPECT_EQ(fit.hertz.friction, 0.3);
}

TEST(ReducedCalibration, TooFewBlowsAreRefused) {
  std::vector<Blow> design = blows();
  design.resize(3);
  EXPECT_THROW(calibrate_reduced(coarse(), design), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::models
