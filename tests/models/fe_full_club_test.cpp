// The whole club against the free head: what [@shaft-influence] found, and limits that must hold.
#include "models/fe/impact.hpp"

#include <gtest/gtest.h>

#include "models/club/hosel_load.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "tests/support/coarse_impact.hpp"

namespace hosel::models {
namespace {

using test::driver_blow;

FeImpactOptions coarse() { return test::coarse_impact(2, 1); }

TEST(FeFullClub, MoreBallSpeedLessTurningLessGearEffect) {
  for (double toe : {0.02, -0.02}) {
    const Blow blow = driver_blow(toe);
    const FeOutcome free = Impact(coarse()).run(blow), full = Impact(coarse(), ShaftMount{}).run(blow);
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
  const FeOutcome bare = Impact(coarse()).run(blow);
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
  const FeOutcome full = Impact(coarse(), ShaftMount{.grip = Grip::free, .elements = 4, .growth = 1}).run(blow);
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
  const FeOutcome together = Impact(coarse()).run(lump);
  const double gain = (together.launch.velocity - bare.launch.velocity).norm();
  ASSERT_GT(gain, 0.5);
  EXPECT_LT((full.launch.velocity - together.launch.velocity).norm(), 0.004 * gain);
  EXPECT_LT((full.launch.spin - together.launch.spin).norm(), 0.01 * (together.launch.spin - bare.launch.spin).norm());
}

TEST(FeFullClub, AShaftOfNothingIsAFreeHead) {
  Blow blow = driver_blow(0.02);
  const FeOutcome free = Impact(coarse()).run(blow);
  for (ShaftStation& s : blow.club.shaft->stations) {
    for (double* x : {&s.bending_stiffness_y, &s.bending_stiffness_z, &s.torsional_stiffness, &s.axial_stiffness,
                      &s.shear_stiffness, &s.mass_per_length, &s.rotary_inertia_y, &s.rotary_inertia_z})
      *x *= 1e-7;
  }
  const FeOutcome full = Impact(coarse(), ShaftMount{.grip = Grip::free}).run(blow);
  EXPECT_LT((full.launch.velocity - free.launch.velocity).norm(), 1e-4 * free.launch.ball_speed());
  EXPECT_LT((full.launch.spin - free.launch.spin).norm(), 1e-3 * free.launch.spin_rate());
  EXPECT_LT((full.launch.head_spin - free.launch.head_spin).norm(), 1e-3 * free.launch.head_spin.norm());
}

/// Springs as stiff as a hinge holds its other axes are a rigid joint; without the one about YG nothing is left of that
/// moment, and the head turns more. The ball knows: what the hinge takes is far above what the welds' yielding changes.
TEST(FeFullClub, AHingedHeadFeelsTheShaftButNotItsMomentAboutTheHinge) {
  const Blow blow = driver_blow(0.0, 0.015);  // high: the blow turns the head about the hinge
  const Vec3 across = face_to_grip(blow.club.geometry).transpose().col(1);
  const auto solve = [&](const HeadJoint& joint, double& moment) {
    ShaftMount mount;
    mount.joint = joint;
    return Impact(coarse(), mount).run(blow, [&](const ImpactView& v) {
      moment = std::max(moment, std::abs(hosel_load(*v.shaft, v.state).moment.dot(across)));
    });
  };
  HeadJoint weld{.kind = HeadJoint::Kind::spring};
  weld.stiffness.translation = Vec3::Constant(2e9);
  weld.stiffness.rotation = Vec3::Constant(2e5);
  double rigid_moment = 0, weld_moment = 0, hinge_moment = 0;
  const FeOutcome free = Impact(coarse()).run(blow), rigid = solve({}, rigid_moment), welded = solve(weld, weld_moment),
                  hinged = solve({.kind = HeadJoint::Kind::hinge}, hinge_moment);
  for (const FeOutcome* o : {&rigid, &welded, &hinged}) {
    ASSERT_GT(o->result.peak_force, 1e4);
    EXPECT_LT(std::abs(o->result.ledger.closure), 5e-3 * o->result.ledger.initial);
  }
  ASSERT_GT(rigid_moment, 1);
  EXPECT_LT(hinge_moment, 1e-3 * rigid_moment);
  const double shaft = (rigid.launch.spin - free.launch.spin).norm();
  EXPECT_LT((welded.launch.spin - rigid.launch.spin).norm(), 0.02 * shaft);
  EXPECT_GT((hinged.launch.spin - rigid.launch.spin).norm(), 0.2 * shaft);
  // The shaft is still carried along: more ball speed than a free head gives, less than the rigid joint does.
  EXPECT_GT(hinged.launch.ball_speed(), free.launch.ball_speed() + 0.05);
  EXPECT_GT(rigid.launch.ball_speed(), hinged.launch.ball_speed());
  // The condensed shaft with its slope let go says the same of the head's turn.
  const auto turn = [&](bool is_hinged) { return ShaftCoupled({}, {}, {.hinged = is_hinged}).launch(blow).head_spin; };
  const Vec3 by_fe = hinged.launch.head_spin - rigid.launch.head_spin, reduced = turn(true) - turn(false);
  EXPECT_LT((by_fe - reduced).norm(), 0.15 * by_fe.norm());
}

/// Sections that stay normal to the axis cost a blow no more than sections that do not: the same steps, none refused,
/// and the shaft's own shear a million times as stiff gives the same ball. Shear itself moves it by a thousandth of a
/// m/s.
TEST(FeFullClub, AShaftWithoutShearIsTheLimitOfAStiffOne) {
  Blow blow = driver_blow(0.02);
  blow.delivery.head_angular_velocity = {5, -15, 40};
  const auto solve = [&](double stiffer, bool shear) {
    Blow b = blow;
    for (ShaftStation& s : b.club.shaft->stations) s.shear_stiffness *= stiffer;
    return Impact(coarse(), ShaftMount{.elements = 20, .growth = 0.92, .shear = shear}).run(b);
  };
  const FeOutcome yields = solve(1, true), held = solve(1, false), stiff = solve(1e6, true);
  ASSERT_GT(held.result.peak_force, 1e4);
  for (const FeOutcome* o : {&held, &stiff}) {
    EXPECT_EQ(o->result.counts.rejected, 0);
    EXPECT_LT(o->result.counts.iterations, 1.2 * double(yields.result.counts.iterations));
  }
  const auto moves = [](const FeOutcome& a, const FeOutcome& b) {
    return (a.launch.velocity - b.launch.velocity).norm();
  };
  ASSERT_GT(moves(held, yields), 3e-4) << "shear matters";
  EXPECT_LT(moves(held, stiff), 0.01 * moves(held, yields));
}

TEST(FeFullClub, RefusesALoadedHinge) {
  ShaftMount mount;
  mount.joint.kind = HeadJoint::Kind::hinge;
  mount.load = GripLoad{};
  EXPECT_THROW(Impact(coarse(), mount).run(driver_blow(0)), std::invalid_argument);
}

TEST(FeFullClub, RefusesAClubWithoutShaft) {
  Blow blow = driver_blow(0);
  blow.club.shaft.reset();
  EXPECT_THROW(Impact(coarse(), ShaftMount{}).run(blow), std::invalid_argument);
}

/// A club of every part that remembers: hands that push and hold, a joint that gives, a shaft that is viscous. What is
/// not remembered would show in the ledger.
TEST(FeFullClub, GoesOnFromACheckpointToTheSameBits) {
  Blow blow = driver_blow(0.01);
  ShaftMount mount{.grip = Grip::hands, .elements = 4, .growth = 1};
  mount.hands = {.translation = Vec3::Constant(2e4),
                 .rotation = Vec3::Constant(50),
                 .translation_damping = Vec3::Constant(100),
                 .rotation_damping = Vec3::Constant(1)};
  mount.joint = {.kind = HeadJoint::Kind::spring,
                 .stiffness = {.translation = Vec3::Constant(1e7),
                               .rotation = Vec3::Constant(1e4),
                               .translation_damping = Vec3::Constant(100),
                               .rotation_damping = Vec3::Constant(1)}};
  mount.loaded = LoadedShaft{};
  mount.loaded->gravity = Vec3(-2, 0, -9.6);  // face axes
  for (const mesh::LineNode& n : shaft_line(blow.club, 0, 4, 1))
    mount.loaded->nodes.push_back({.position = n.position});
  mount.loaded->grip = {Vec3(100, -50, 300), Vec3(2, 1, 0)};

  std::optional<ImpactCheckpoint> half;
  int steps = 0;
  const FeOutcome whole = Impact(coarse(), mount).run(blow, [&](const ImpactView& view) {
    if (++steps == 30) half = view.checkpoint();
  });
  ASSERT_GT(steps, 45);
  ASSERT_TRUE(half && half->touched && !half->over);
  const FeOutcome rest = Impact(coarse(), mount).run(blow, {}, &*half);
  EXPECT_EQ(rest.launch.velocity, whole.launch.velocity);
  EXPECT_EQ(rest.launch.spin, whole.launch.spin);
  EXPECT_EQ(rest.launch.head_spin, whole.launch.head_spin);
  EXPECT_EQ(rest.result.penetration, whole.result.penetration);
  const solvers::Ledger &a = rest.result.ledger, &b = whole.result.ledger;
  EXPECT_NE(b.external, 0);
  EXPECT_GT(b.viscous, 0);
  EXPECT_EQ(a.external, b.external);
  EXPECT_EQ(a.viscous, b.viscous);
  EXPECT_EQ(a.friction, b.friction);
  EXPECT_EQ(a.numerical, b.numerical);
  EXPECT_EQ(a.closure, b.closure);
  EXPECT_LT(std::abs(b.closure), 5e-3 * b.initial);

  // Of another club, with fewer parts that remember: not gone on from.
  mount.grip = Grip::free;
  EXPECT_ANY_THROW(Impact(coarse(), mount).run(blow, {}, &*half));
}

}  // namespace
}  // namespace hosel::models
