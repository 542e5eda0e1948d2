/// FE blows for tests: coarse, since what is tested holds on any mesh.
#pragma once

#include "fem/materials/hyperelastic.hpp"
#include "models/fe/impact.hpp"
#include "tests/support/swing_motion.hpp"

namespace hosel::test {

/// The tests' own ball, which no calibration of the library's moves.
inline models::FeBall test_ball() {
  return {
      "test",
      {{1, {.elastic = fem::Hyperelastic{.c10 = 12.5e6, .bulk = 1e9}, .branches = {{27e6, 2e-5}}, .density = 1129}}}};
}

inline models::FeImpactOptions coarse_impact(int harmonics, int antisymmetric = 2) {
  models::FeImpactOptions o;
  o.ball = test_ball();
  o.harmonics = harmonics;
  o.antisymmetric = antisymmetric;
  o.mesh = {.sector = 2, .rings = 2, .pole = 0.5, .skin = 0.6, .core = 0.4};
  o.penalty = 200;
  o.steps_per_contact = 40;
  return o;
}

/// A driver whose shaft has a damping ratio of 1 % at 1 kHz: the frequencies of the blow, not those of the swing.
inline Blow driver_blow(double toe, double high = 0) {
  Blow b;
  b.club = driver_club();
  b.club.shaft->damping_time = 2 * 0.01 / (2 * kPi * 1000);
  b.delivery = {.club_speed = 45,
                .attack_angle = radians(2),
                .dynamic_loft = radians(11),
                .impact_toe = toe,
                .impact_high = high};
  return b;
}

}  // namespace hosel::test
