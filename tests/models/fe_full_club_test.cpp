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
  }
}

/// A shaft that does not bend is part of the head: the same blow on a free body of head and rod together. What the rod
/// changes is met to 0.2 % of itself in velocity (four elements, the coarse ball); 1 % of its mass moves that by 0.4 %.
TEST(FeFullClub, AStiffShaftIsMoreHead) {
  Blow blow = driver_blow(0.01);
  const FeOutcome bare = solve_free_body(blow, coarse());
  Shaft& shaft = *blow.club.shaft;
  // Of 60 g over 0.3 m; the rotary inertia of its sections is nothing beside the head's.
  shaft.damping_time = 0;
  shaft.stations.resize(2);
  for (std::size_t i = 0; i < 2; ++i)
    shaft.stations[i] = {.arc_length = 0.3 * double(i),
                         .bending_stiffness_y = 1e6,
                         .bending_stiffness_z = 1e6,
                         .torsional_stiffness = 1e6,
                         .axial_stiffness = 1e9,
                         .shear_stiffness = 1e9,
                         .mass_per_length = 0.2,
                         .rotary_inertia_y = 1e-8,
                         .rotary_inertia_z = 1e-8};
  const FeOutcome full = solve_full_club(blow, {coarse(), {.grip = Grip::free, .elements = 4, .growth = 1}});
  Blow lump = blow;
  Head& head = lump.club.head;
  const Vec3 middle = blow.club.geometry.hosel + 0.15 * blow.club.geometry.shaft_axis,
             axis = blow.club.geometry.shaft_axis;
  const double rod = 0.06, mass = head.mass + rod;
  const Vec3 cg = (head.mass * head.cg + rod * middle) / mass;
  const auto shifted = [](double m, const Vec3& r) {
    return Mat3(m * (r.squaredNorm() * Mat3::Identity() - r * r.transpose()));
  };
  head.inertia += shifted(head.mass, head.cg - cg) + shifted(rod, middle - cg) +
                  rod * 0.3 * 0.3 / 12 * (Mat3::Identity() - axis * axis.transpose());
  head.cg = cg;
  head.mass = mass;
  const FeOutcome together = solve_free_body(lump, coarse());
  const double gain = (together.launch.velocity - bare.launch.velocity).norm();
  ASSERT_GT(gain, 0.5);
  EXPECT_LT((full.launch.velocity - together.launch.velocity).norm(), 0.004 * gain);
  EXPECT_LT((full.launch.spin - together.launch.spin).norm(), 0.01 * (together.launch.spin - bare.launch.spin).norm());
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
