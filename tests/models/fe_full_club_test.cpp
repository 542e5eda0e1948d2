// The whole club against the free head: what [@shaft-influence] found, and limits that must hold.
#include "hosel/models/fe_full_club.hpp"

#include <gtest/gtest.h>

#include "tests/support/coarse_impact.hpp"

namespace hosel::models {
namespace {

using test::driver_blow;

FeImpactOptions coarse() { return test::coarse_impact(2, 1); }

TEST(FeFullClub, MoreBallSpeedLessTurningLessGearEffect) {
  for (double toe : {0.02, -0.02}) {
    const Blow blow = driver_blow(toe);
    const FeOutcome free = solve_free_body(blow, coarse()), full = solve_full_club(blow, {coarse(), {}});
    // The blow happened: a ball of driver speed, a force of more than 10 kN over about 0.45 ms.
    for (const FeOutcome* o : {&free, &full}) {
      EXPECT_GT(o->launch.ball_speed(), 55);
      EXPECT_GT(o->result.peak_force, 1e4);
      EXPECT_NEAR(o->result.contact_time, 0.45e-3, 0.08e-3);
      EXPECT_LT(std::abs(o->result.ledger.closure), 5e-3 * o->result.ledger.initial);
    }
    EXPECT_GT(full.launch.ball_speed(), free.launch.ball_speed() + 0.05);
    EXPECT_GT(full.launch.head_velocity.norm(), free.launch.head_velocity.norm());
    EXPECT_LT(full.launch.head_spin.norm(), free.launch.head_spin.norm());
    // Towards the toe more fade, towards the heel more draw than the free head gives.
    EXPECT_GT((toe > 0 ? 1 : -1) * (full.launch.sidespin() - free.launch.sidespin()), 0);
    // The head's speed after a central blow would put the shaft's part at a few grams.
    const double J = 0.04593 * free.launch.velocity.norm();
    const double apparent = 0.204 * (full.launch.head_velocity.norm() - free.launch.head_velocity.norm()) / (J / 0.204);
    EXPECT_GT(apparent, 0.5e-3);
    EXPECT_LT(apparent, 20e-3);
  }
}

TEST(FeFullClub, AShaftOfNothingIsAFreeHead) {
  Blow blow = driver_blow(0.02);
  const FeOutcome free = solve_free_body(blow, coarse());
  for (ShaftStation& s : blow.club.shaft->stations) {
    for (double* x : {&s.bending_stiffness_y, &s.bending_stiffness_z, &s.torsional_stiffness, &s.axial_stiffness,
                      &s.shear_stiffness, &s.mass_per_length, &s.rotary_inertia_y, &s.rotary_inertia_z})
      *x *= 1e-7;
  }
  const FeOutcome full = solve_full_club(blow, {coarse(), {.grip = Grip::free}});
  EXPECT_LT((full.launch.velocity - free.launch.velocity).norm(), 1e-4 * free.launch.ball_speed());
  EXPECT_LT((full.launch.spin - free.launch.spin).norm(), 1e-3 * free.launch.spin_rate());
  EXPECT_LT((full.launch.head_spin - free.launch.head_spin).norm(), 1e-3 * free.launch.head_spin.norm());
}

TEST(FeFullClub, RefusesAClubWithoutShaft) {
  Blow blow = driver_blow(0);
  blow.club.shaft.reset();
  EXPECT_THROW(solve_full_club(blow, {coarse(), {}}), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::models
