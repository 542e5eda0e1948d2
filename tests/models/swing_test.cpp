// The swing: convergence, statics, an independent integrator, and the hands' wrench fed back.
#include "models/club/swing.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "fem/modal_damping.hpp"
#include "models/club/changed_swing.hpp"
#include "solvers/modes.hpp"
#include "tests/support/swing_motion.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::models {
namespace {

using test::driver_club;

const GripMotion& grip() {
  static const GripMotion motion(test::swing_track(), 0);
  return motion;
}
fem::Motion motion() {
  return [](double t) { return grip().at(t); };
}

std::vector<SwingSample> swing(const SwingOptions& options, double begin = -1.1, double end = 0) {
  Swing s(driver_club(), options, {.motion = motion()});
  std::vector<SwingSample> out;
  s.run(s.start(begin, s.equilibrium(begin)), end, [&](const SwingSample& x) { out.push_back(x); });
  return out;
}

double peak(const std::vector<SwingSample>& x) {
  double p = 0;
  for (const SwingSample& s : x) p = std::max({p, std::abs(s.lead), std::abs(s.droop)});
  return p;
}

/// The downswing, with mesh and step halved twice.
TEST(Swing, LeadAndDroopConverge) {
  const double begin = -0.35;
  const auto coarse = swing({.elements = 10, .step = 1e-3}, begin),
             middle = swing({.elements = 20, .step = 5e-4}, begin),
             fine = swing({.elements = 40, .step = 2.5e-4}, begin);
  const double scale = peak(fine);
  ASSERT_GT(scale, 0.05);
  const auto worst = [](const std::vector<SwingSample>& a, const std::vector<SwingSample>& b) {
    EXPECT_EQ(b.size(), 2 * a.size() - 1);
    double out = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      out = std::max({out, std::abs(a[i].lead - b[2 * i].lead), std::abs(a[i].droop - b[2 * i].droop)});
    return out;
  };
  const double before = worst(coarse, middle), after = worst(middle, fine);
  EXPECT_LT(after, 0.005 * scale);
  EXPECT_NEAR(std::log2(before / after), 2, 0.3) << "of second order in the step";
  RecordProperty("convergence", std::to_string(after / scale));
  const Delivery d = delivery_of(fine.back().head);
  EXPECT_GT(d.club_speed, 45);
  EXPECT_LT(d.club_speed, 55);
}

/// In the club's own axes the tangent hardly changes while it turns over the player's head.
TEST(Swing, OneTangentServesManySteps) {
  Swing s(driver_club(), {.elements = 10}, {.motion = motion()});
  std::vector<Eigen::Quaterniond> attitudes;
  s.run(s.start(-1.1, s.equilibrium(-1.1)), 0, [&](const SwingSample& x) { attitudes.push_back(x.grip.rotation); });
  double turned = 0;
  for (std::size_t i = 1; i < attitudes.size(); ++i) turned += attitudes[i - 1].angularDistance(attitudes[i]);
  ASSERT_GT(turned, kPi);
  ASSERT_EQ(s.counts().rejected, 0);
  EXPECT_GT(s.counts().steps, 1000);
  // Fixed factors would diverge from a few hundredths of a radian on: one step of the downswing.
  EXPECT_LT(s.counts().factorisations, s.counts().steps / 5);
}

TEST(Swing, EquilibriumByNewtonKinsolAndAHold) {
  Club club = driver_club();
  club.shaft->damping_time = 2 * 0.5 / (2 * kPi * 4);  // half critical, so that one second is enough
  Swing s(club, {.elements = 8}, {.motion = motion()}),
      by_kinsol(club, {.kinsol = true, .elements = 8}, {.motion = motion()});
  const fem::State newton = s.equilibrium(-1.1), kinsol = by_kinsol.equilibrium(-1.1), held = s.hold(-1.1, 1.0);
  const fem::Vector none = fem::Vector::Zero(s.system().dof_map.size());
  const SwingSample a = s.sample(newton, none), b = s.sample(kinsol, none), c = s.sample(held, none);
  EXPECT_GT(std::hypot(a.lead, a.droop), 5e-3);  // the head hangs
  EXPECT_NEAR(a.lead, b.lead, 1e-7);
  EXPECT_NEAR(a.droop, b.droop, 1e-7);
  // A second of hold leaves e^(-0.5 * 25) of the fall.
  EXPECT_NEAR(a.lead, c.lead, 1e-4);
  EXPECT_NEAR(a.droop, c.droop, 1e-4);
}

TEST(Swing, IdaAgrees) {
  // The downswing, 10 elements, both integrators at tight tolerances: 0.2 % of the peak deflection. IDA's steps are
  // bounded: what it chooses itself hangs on the machine's last digits, and erred by 0.08 to 0.4 %.
  const double begin = -0.3;
  Swing s(driver_club(), {.elements = 10, .step = 2.5e-4}, {.motion = motion()});
  const fem::State from = s.start(begin, s.equilibrium(begin));
  std::vector<SwingSample> ours;
  s.run(from, 0, [&](const SwingSample& x) { ours.push_back(x); });
  const double scale = peak(ours);
  EXPECT_GT(scale, 0.05);
  std::size_t i = 0;
  double worst = 0, wrench = 0, pull = 0;
  Swing other(driver_club(), {.integrator = SwingIntegrator::ida, .elements = 10, .step = 1e-3}, {.motion = motion()});
  other.run(from, 0, [&](const SwingSample& x) {
    const SwingSample& own = ours[4 * i++];
    ASSERT_NEAR(x.time, own.time, 1e-9);
    worst = std::max({worst, std::abs(own.lead - x.lead), std::abs(own.droop - x.droop)});
    wrench = std::max(wrench, (own.force - x.force).norm());
    pull = std::max(pull, own.force.norm());
  });
  EXPECT_EQ(i, 301u);
  EXPECT_LT(worst, 0.002 * scale);
  EXPECT_GT(pull, 200);
  EXPECT_LT(wrench, 0.01 * pull);  // accelerations are a derivative rougher than places
  RecordProperty("ida", std::to_string(worst / scale));
}

TEST(Swing, WhatTheShaftCarriesAtTheGripIsTheHandsWrench) {
  Swing s(driver_club(), {.elements = 20, .step = 1e-3}, {.motion = motion()});
  double pull = 0, bend = 0, force_error = 0, moment_error = 0;
  s.watch(s.start(-0.2, s.equilibrium(-0.2)), 0, [&](const SwingSample& x, const fem::State& state) {
    const auto at = s.shaft().resultants(state);
    const double w = (0 - at[0].arc_length) / (at[1].arc_length - at[0].arc_length);
    const Vec3 force = (1 - w) * at[0].force + w * at[1].force, moment = (1 - w) * at[0].moment + w * at[1].moment;
    pull = std::max(pull, force.x());
    bend = std::max(bend, moment.norm());
    // What the rest of the shaft does to the section at the grip, the hands undo.
    const Mat3& axes = s.shaft().line().front().frame;
    force_error = std::max(force_error, (x.grip.rotation * Vec3(axes * force) + x.force).norm());
    moment_error = std::max(moment_error, (axes * moment + x.moment).norm());
  });
  EXPECT_GT(pull, 200);  // a head of 0.2 kg at some 50 m/s pulls: tension is positive
  EXPECT_GT(bend, 5);
  // Linear extrapolation over a fifth of an element, whose own inertia (a fiftieth of the club's) the node carries.
  EXPECT_LT(force_error, 0.02 * pull);
  EXPECT_LT(moment_error, 0.02 * bend);
}

/// Springs that hardly give hold the club with the wrench of the motion that they follow.
/// A hosel that yields is a joint of springs: it would take the place of the one that is declared.
TEST(Swing, AYieldingHoselNeedsARigidJoint) {
  const ClubChange yielding{.hosel = Vec3::Constant(1e-3)};
  const auto lead = [&](HeadJoint::Kind kind, const ClubChange& c) {
    SwingOptions o{.elements = 4};
    o.joint.kind = kind;
    o.joint.stiffness = {.translation = Vec3::Constant(1e7), .rotation = Vec3::Constant(1e3)};
    return changed_swing(driver_club(), o, grip(), c, -0.35, -0.3).back().lead;
  };
  EXPECT_NE(lead(HeadJoint::Kind::rigid, yielding), lead(HeadJoint::Kind::rigid, {}));
  for (const auto kind : {HeadJoint::Kind::hinge, HeadJoint::Kind::spring, HeadJoint::Kind::none})
    EXPECT_THROW(lead(kind, yielding), std::invalid_argument);
  EXPECT_TRUE(std::isfinite(lead(HeadJoint::Kind::spring, {})));
}

/// An equilibrium that fails lets go of the grip: the swing after it moves as the one before.
TEST(Swing, AFailedEquilibriumHoldsNothing) {
  bool broken = false;
  Swing tried(driver_club(), {.elements = 4}, {.motion = [&](double t) {
                if (broken) throw std::runtime_error("no motion");
                return grip().at(t);
              }});
  const fem::State from = tried.start(-0.3, tried.equilibrium(-0.3));
  const auto moved = [&] {
    Vec3 at;
    tried.run(from, -0.29, [&](const SwingSample& s) { at = s.grip.position; });
    return at;
  };
  const Vec3 before = moved();
  ASSERT_GT((before - grip().at(-0.3).position).norm(), 1e-3);
  for (const bool by_holding : {false, true}) {
    broken = true;
    EXPECT_THROW(by_holding ? tried.hold(-0.3, 0.01) : tried.equilibrium(-0.3), std::runtime_error);
    broken = false;
    EXPECT_EQ(moved(), before);
  }
}

TEST(Swing, StiffHandsHoldWithThePrescribedWrench) {
  const SwingOptions options{.elements = 10, .step = 5e-4};
  const double begin = -0.3;
  fem::JointStiffness firm;
  firm.translation = Vec3::Constant(1e6);
  firm.rotation = Vec3::Constant(1e5);
  firm.translation_damping = Vec3::Constant(1000);
  firm.rotation_damping = Vec3::Constant(50);
  Swing driven(driver_club(), options, {.motion = motion()}),
      held(driver_club(), options, {.kind = GripDrive::Kind::hands, .motion = motion(), .hands = firm});
  const fem::State from = driven.start(begin, driven.equilibrium(begin));
  SwingSample exact, by_hands;
  driven.run(from, 0, [&](const SwingSample& x) { exact = x; });
  held.run(from, 0, [&](const SwingSample& x) { by_hands = x; });
  ASSERT_GT(exact.force.norm(), 200);
  ASSERT_GT(exact.moment.norm(), 2);
  EXPECT_GT((by_hands.grip.position - exact.grip.position).norm(), 1e-4);  // they give
  EXPECT_LT((by_hands.force - exact.force).norm(), 0.05 * exact.force.norm());
  EXPECT_LT((by_hands.moment - exact.moment).norm(), 0.05 * exact.moment.norm());
}

TEST(Swing, TheHandsWrenchFedBackReproducesTheGrip) {
  const double step = 2.5e-4;
  Swing driven(driver_club(), {.elements = 10, .step = step}, {.motion = motion()});
  const fem::State from = driven.start(-1.1, driven.equilibrium(-1.1));
  std::vector<SwingSample> record;
  driven.run(from, 0, [&](const SwingSample& x) { record.push_back(x); });
  const auto wrench = [&](double t) {
    const double at = std::clamp((t + 1.1) / step, 0.0, static_cast<double>(record.size() - 1));
    const auto k = std::min(static_cast<std::size_t>(at), record.size() - 2);
    const double w = at - static_cast<double>(k);
    return fem::Wrench{(1 - w) * record[k].force + w * record[k + 1].force,
                       (1 - w) * record[k].moment + w * record[k + 1].moment};
  };
  Swing forced(driver_club(), {.elements = 10, .step = step},
               {.kind = GripDrive::Kind::forced, .motion = motion(), .wrench = wrench});
  double distance = 0, angle = 0;
  forced.run(from, 0, [&](const SwingSample& x) {
    const fem::Pose p = grip().at(x.time);
    distance = std::max(distance, (x.grip.position - p.position).norm());
    angle = std::max(angle, x.grip.rotation.angularDistance(p.rotation));
  });
  EXPECT_LT(distance, 1e-3);
  EXPECT_LT(degrees(angle), 0.1);
  RecordProperty("distance_m", std::to_string(distance));
}

TEST(Swing, ModalDampingTakesTheStatedShareOfEachMode) {
  // The held club set swinging in one of its first two modes loses exp(-2 pi zeta) of its amplitude a period; the
  // damping force has neither force nor moment on the whole, and a rigid motion does not feel it.
  Club club = driver_club();
  club.shaft->damping_time = 0;
  const std::array ratio{0.02, 0.05};
  const fem::Motion still = fem::at_rest(Vec3::Zero());
  Swing s(club,
          {.elements = 6, .step = 5e-4, .rho_inf = 1, .gravity = Vec3::Zero(), .modal_damping = {ratio[0], ratio[1]}},
          {.motion = still});
  const fem::Term* damping = nullptr;
  for (const auto& term : s.system().terms)
    if (dynamic_cast<const fem::ModalDamping*>(term.get())) damping = term.get();
  ASSERT_NE(damping, nullptr);
  const auto& modal = dynamic_cast<const fem::ModalDamping&>(*damping);
  fem::State rest = s.system().dof_map.rest();
  s.shaft().place(rest);
  const solvers::Modes modes = solvers::modes(s.system(), rest, 2);
  for (int k = 0; k < 2; ++k) {
    fem::State from = rest;
    from.v = 1e-3 * modes.shapes.col(k);
    EXPECT_NEAR(modal.speeds(from)[k], 1e-3, 1e-9);
    EXPECT_NEAR(modal.speeds(from)[1 - k], 0, 1e-9);
    // Amplitude at the first crest and ten periods later, from the energy.
    const double omega = modes.omega[static_cast<std::size_t>(k)], zeta = ratio[static_cast<std::size_t>(k)];
    const fem::State after = s.run(from, 10 * 2 * kPi / omega, {});
    const double kept = (s.ledger().kinetic + s.ledger().strain_total()) / s.ledger().initial;
    EXPECT_NEAR(-std::log(kept) / (2 * 10 * 2 * kPi), zeta, 0.01 * zeta) << k;
    EXPECT_NEAR(s.ledger().viscous, (1 - kept) * s.ledger().initial, 0.01 * s.ledger().initial);
  }
  fem::State moving = rest;
  moving.v = test::random_vector(moving.v.size(), 1);
  moving.q = s.system().dof_map.advanced(moving.q, test::random_vector(moving.v.size(), 2, 0.1));
  fem::Vector inertia = fem::Vector::Zero(moving.v.size()), force = inertia;
  damping->residual(moving, inertia, force);
  Vec3 sum = Vec3::Zero(), moment = sum;
  for (const fem::Node& n : s.shaft().nodes()) {
    const Vec3 f = force.segment<3>(n.translation.v), x = moving.q.segment<3>(n.translation.q);
    sum += f;
    moment += x.cross(f) + fem::rotation(moving, n.rotation) * Vec3(force.segment<3>(n.rotation.v));
  }
  EXPECT_GT(force.norm(), 1e-3);
  EXPECT_LT(sum.norm() + moment.norm(), 1e-10 * force.norm());
  const Vec3 v(1, 2, 3), w(3, -2, 1);
  for (const fem::Node& n : s.shaft().nodes()) {
    moving.v.segment<3>(n.translation.v) = v + w.cross(Vec3(moving.q.segment<3>(n.translation.q)));
    moving.v.segment<3>(n.rotation.v) = fem::rotation(moving, n.rotation).conjugate() * w;
  }
  EXPECT_LT(modal.speeds(moving).norm(), 1e-12);
}

TEST(Swing, HingeAndSpringJoints) {
  // A stiff spring is a weld; a hinge lets the head turn about its axis and nothing else.
  const auto last = [](const SwingOptions& o) { return swing(o, -0.3, -0.1).back(); };
  const SwingSample rigid = last({.elements = 8});
  SwingOptions stiff{.elements = 8, .joint = {.kind = HeadJoint::Kind::spring}};
  stiff.joint.stiffness.translation = Vec3::Constant(1e8);
  stiff.joint.stiffness.rotation = Vec3::Constant(1e5);
  const SwingSample spring = last(stiff);
  EXPECT_NEAR(spring.lead, rigid.lead, 1e-3 * std::abs(rigid.lead) + 1e-4);
  for (const Vec3& axis : {Vec3(Vec3::UnitY()), Vec3(Vec3(2, 1, -1).normalized())}) {
    Swing hinged(driver_club(), {.elements = 8, .joint = {.kind = HeadJoint::Kind::hinge, .axis = axis}},
                 {.motion = motion()});
    double turn = 0, across = 0, bend = 0, apart = 0;
    hinged.watch(hinged.start(-0.3, hinged.equilibrium(-0.3)), -0.1, [&](const SwingSample&, const fem::State& state) {
      const fem::Node &tip = hinged.shaft().nodes().back(), &head = hinged.head_node();
      const Vec3 r =
          fem::rotation_log(fem::rotation(state, tip.rotation).conjugate() * fem::rotation(state, head.rotation));
      turn = std::max(turn, std::abs(r.dot(axis)));
      across = std::max(across, r.cross(axis).norm());
      bend = std::max(bend, hinged.shaft().resultants(state).back().moment.norm());
      const Vec3 gap = state.q.segment<3>(head.translation.q) - state.q.segment<3>(tip.translation.q);
      apart = std::max(apart, gap.norm());
    });
    EXPECT_GT(turn, 0.05) << axis.transpose();
    // Across its axis it holds by 1e4 EI / L: what the tip's own bending would give it in a ten-thousandth of the
    // shaft.
    ASSERT_GT(bend, 0.1);
    const Shaft shaft = *driver_club().shaft;
    EXPECT_LT(across, 2 * bend * shaft.length() / (1e4 * shaft.stations.back().bending_stiffness_y));
    EXPECT_LT(apart, 1e-5);
  }
}

TEST(Swing, AClubThatNothingHoldsIsNotHeld) {
  Swing forced(driver_club(), {}, {.kind = GripDrive::Kind::forced, .motion = motion(), .wrench = [](double) {
                                     return fem::Wrench{Vec3::Zero(), Vec3::Zero()};
                                   }});
  EXPECT_THROW(forced.equilibrium(0), std::invalid_argument);
  EXPECT_THROW(forced.hold(0, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::models
