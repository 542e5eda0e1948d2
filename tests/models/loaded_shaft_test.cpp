// The shaft that the swing bends: carried over from a swing, and found from a delivery with the hands' wrench.
#include "models/club/loaded_shaft.hpp"

#include <gtest/gtest.h>

#include "models/club/hosel_load.hpp"
#include "models/club/mounted_shaft.hpp"
#include "models/fe/impact.hpp"
#include "tests/support/swing_motion.hpp"

namespace hosel::models {
namespace {

constexpr int kElements = 12;
constexpr double kGrowth = 0.9;

struct SwingTaken {
  Club club = test::driver_club();
  std::vector<SwingSample> samples;
  LoadedShaft loaded;      // half a millisecond before the end
  SwingSample from, last;  // there, and at the end
};

/// The test's swing to t = 0, its club taken over at -0.5 ms.
SwingTaken taken_swing(double lie = 0, const HeadJoint& joint = {}) {
  SwingTaken out;
  out.club = turned_about_normal(out.club, lie);
  const GripMotion grip(test::swing_track(), 0);
  Swing swing(out.club, {.elements = kElements, .growth = kGrowth, .step = 2.5e-4, .tolerance = 1e-9, .joint = joint},
              {.motion = [&](double t) { return grip.at(t); }});
  const double at = -0.5e-3;
  const fem::State s = swing.run(swing.start(-0.35, swing.equilibrium(-0.35)), at,
                                 [&](const SwingSample& x) { out.samples.push_back(x); });
  out.from = out.samples.back();
  out.loaded = loaded_by_swing(swing, s, out.samples[out.samples.size() - 2], out.from);
  swing.run(s, 0, [&](const SwingSample& x) { out.last = x; });
  return out;
}

/// A head with the delivery's motion and a mounted shaft, without a ball.
struct Flight {
  fem::System system;
  const fem::RigidBody* head = nullptr;
  const fem::Beam* shaft = nullptr;
  fem::State state;

  Flight(const Club& club, const Delivery& d, const ShaftMount& mount) {
    const fem::Node node{system.dof_map.add_vector(3), system.dof_map.add_rotation()};
    const Mat3 face = d.face_to_global();
    const Vec3 c = club.head.cg - club.geometry.hosel;
    auto body = std::make_unique<fem::RigidBody>(
        "head", node.translation, node.rotation, fem::RigidBodyProperties{club.head.mass, club.head.inertia, c},
        mount.loaded ? Vec3(face * mount.loaded->gravity) : Vec3(Vec3::Zero()));
    head = body.get();
    system.terms.push_back(std::move(body));
    state = system.dof_map.rest();
    fem::set_rotation(state, node.rotation, Eigen::Quaterniond(face));
    state.v.segment<3>(node.rotation.v) = face.transpose() * d.head_angular_velocity;
    state.v.segment<3>(node.translation.v) = d.velocity() - d.head_angular_velocity.cross(face * c);
    shaft = &mount_shaft(system, state, node, club, mount);
  }
  void fly(double end, double step) {
    solvers::GeneralizedAlpha scheme(system,
                                     {.rho_inf = 0.8,
                                      .newton = {.residual_relative = 1e-9,
                                                 .residual_absolute = 1e-9,
                                                 .increment_vector = 1e-10,
                                                 .increment_rotation = 1e-10},
                                      .step_max = step,
                                      .step_min = step / 64},
                                     state);
    while (scheme.time() < end * (1 - 1e-12)) scheme.advance(end);
    state = scheme.state();
  }
  /// The butt from the tip in the head's axes.
  Vec3 butt() const {
    const fem::Node &a = shaft->nodes().front(), &b = shaft->nodes().back();
    return fem::rotation(state, b.rotation).conjugate() *
           Vec3(state.q.segment<3>(a.translation.q) - state.q.segment<3>(b.translation.q));
  }
};

TEST(LoadedShaft, InATurnedFaceFrameTheDeliveryIsTheWholePose) {
  const SwingTaken level = taken_swing();
  const double lie = dynamic_lie(level.from.head);
  EXPECT_GT(std::abs(lie), radians(0.5));
  const SwingTaken end = taken_swing(lie);
  EXPECT_NEAR(end.from.lead, level.from.lead, 1e-9);
  EXPECT_LT((end.from.head.position - level.from.head.position).norm(), 1e-9);
  const Delivery d = delivery_of(end.from.head);
  EXPECT_LT((d.face_to_global() - end.from.head.rotation.toRotationMatrix()).norm(), 1e-9);
  EXPECT_LT((d.velocity() - end.from.head.velocity).norm(), 1e-12 * d.club_speed);
}

class LoadedJoint : public testing::TestWithParam<HeadJoint::Kind> {};

TEST_P(LoadedJoint, TheSwingGoesOnUnderEveryGrip) {
  // Taken over half a millisecond before the end and let fly under the grip's own motion or wrench, head and shaft
  // arrive where the swing itself does.
  const HeadJoint joint{.kind = GetParam()};
  const SwingTaken end = taken_swing(dynamic_lie(taken_swing(0, joint).from.head), joint);
  if (joint.gives()) {
    ASSERT_GT(Eigen::AngleAxisd(end.loaded.nodes.back().rotation).angle(), radians(3)) << "the hinge has turned";
  }
  const Delivery d = delivery_of(end.from.head);
  const double bent = std::hypot(end.from.lead, end.from.droop);
  EXPECT_GT(bent, 0.02);
  for (Grip grip : {Grip::clamped, Grip::forced}) {
    Flight flight(end.club, d,
                  {.grip = grip, .elements = kElements, .growth = kGrowth, .joint = joint, .loaded = end.loaded});
    const Vec3 before = flight.butt();
    flight.fly(0.5e-3, 2.5e-5);
    EXPECT_LT((flight.head->velocity(flight.state) - end.last.head.velocity).norm(), 2e-3) << int(grip);
    EXPECT_LT(
        (flight.head->angular_velocity(flight.state) - end.last.head.rotation * end.last.head.angular_velocity).norm(),
        0.05)
        << int(grip);
    EXPECT_GT((end.last.head.velocity - end.from.head.velocity).norm(), 0.05);  // and something happened meanwhile
    EXPECT_GT((flight.butt() - before).norm(), 1e-4);
    // What the hands hold with is the swing's own wrench then, however the grip is driven: the forced one was told it
    // to first order in time, the clamped one finds it from an acceleration that it holds constant.
    const fem::Wrench hands = grip_load(*flight.shaft, flight.state);
    const Vec3 moment = end.last.grip.rotation * end.last.moment;
    EXPECT_GT(end.last.force.norm(), 100);
    EXPECT_LT((hands.force - end.last.force).norm(), 0.02 * end.last.force.norm()) << int(grip);
    EXPECT_LT((hands.moment - moment).norm(), 0.02 * moment.norm()) << int(grip);
  }
  // Straight and rigid instead, the head goes elsewhere.
  Flight straight(end.club, d, {.grip = Grip::free, .elements = kElements, .growth = kGrowth, .joint = joint});
  straight.fly(0.5e-3, 2.5e-5);
  EXPECT_GT((straight.head->velocity(straight.state) - end.last.head.velocity).norm(), 0.02);
}
INSTANTIATE_TEST_SUITE_P(Every, LoadedJoint, testing::Values(HeadJoint::Kind::rigid, HeadJoint::Kind::hinge),
                         [](const auto& p) { return p.param == HeadJoint::Kind::rigid ? "Rigid" : "Hinge"; });

TEST(LoadedShaft, ASteadyShaftStaysAsItIsOnItsHead) {
  // Wrench, gravity, speed and spin of a swing: the shaft found from them does not move against the head, where a
  // straight one would.
  Blow blow;
  blow.club = test::driver_club();
  blow.delivery = {
      .club_speed = 45, .attack_angle = radians(3), .dynamic_loft = radians(12), .head_angular_velocity = {5, 35, -25}};
  const GripLoad load{.force = {-40, 30, 350}, .moment = {12, -8, 2}};
  const LoadedShaft found = loaded_by_grip(blow, load, 0, kElements, kGrowth, true);
  const double bent = (found.nodes.front().position - blow.club.shaft->length() * blow.club.geometry.shaft_axis).norm();
  EXPECT_GT(bent, 0.01);
  Flight flight(blow.club, blow.delivery,
                {.grip = Grip::forced, .elements = kElements, .growth = kGrowth, .loaded = found});
  const Vec3 before = flight.butt(), v0 = flight.head->velocity(flight.state);
  const double time = 0.5e-3;
  flight.fly(time, 2.5e-5);
  const double moved = (flight.butt() - before).norm();
  Flight straight(blow.club, blow.delivery,
                  {.grip = Grip::forced, .elements = kElements, .growth = kGrowth, .loaded = [&] {
                     LoadedShaft s = found;
                     for (std::size_t i = 0; i < s.nodes.size(); ++i)
                       s.nodes[i] = {.position = shaft_line(blow.club, 0, kElements, kGrowth)[i].position};
                     return s;
                   }()});
  const Vec3 straight_before = straight.butt();
  straight.fly(time, 2.5e-5);
  EXPECT_LT(moved, 0.02 * (straight.butt() - straight_before).norm());
  // The head accelerates as was said.
  const Vec3 expected = blow.delivery.face_to_global() * found.head_acceleration * time;
  EXPECT_GT(expected.norm(), 0.1);
  EXPECT_LT((flight.head->velocity(flight.state) - v0 - expected).norm(), 0.03 * expected.norm());
}

TEST(LoadedShaft, SpringsOfTheHandsActAlongTheGripsAxes) {
  const Club club = test::driver_club();
  const Delivery d{.club_speed = 45, .dynamic_loft = radians(12), .face_angle = radians(5)};
  const Mat3 axes = d.face_to_global() * face_to_grip(club.geometry).transpose();
  ASSERT_GT((axes - d.face_to_global()).norm(), 0.3) << "another frame than the face's";
  const Vec3 moved(1e-4, 2e-4, -3e-4);
  for (int axis = 0; axis < 3; ++axis) {
    fem::JointStiffness k;
    k.translation[axis] = 1e5;
    const Flight flight(club, d, {.grip = Grip::hands, .hands = k, .elements = kElements, .growth = kGrowth});
    const fem::Node& butt = flight.shaft->nodes().front();
    fem::State s = flight.state;
    s.q.segment<3>(butt.translation.q) += moved;
    fem::Vector inertia = fem::Vector::Zero(flight.system.dof_map.size()), force = inertia;
    ASSERT_EQ(flight.system.terms.back()->body(), "hands");
    flight.system.terms.back()->residual(s, inertia, force);
    const Vec3 found = force.segment<3>(butt.translation.v), along = axes.col(axis);
    EXPECT_NEAR(std::abs(found.dot(along)), 1e5 * std::abs(moved.dot(along)), 1e-6) << axis;
    EXPECT_LT(found.cross(along).norm(), 1e-6) << axis;
  }
}

TEST(LoadedShaft, RefusesAnotherMesh) {
  Blow blow;
  blow.club = test::driver_club();
  blow.delivery.club_speed = 45;
  // Straight, as a shaft of this mesh stands on the head.
  LoadedShaft straight;
  for (const mesh::LineNode& node : shaft_line(blow.club, 0, kElements, kGrowth))
    straight.nodes.push_back({.position = node.position});
  for (const int more : {0, 1}) {
    const ShaftMount mount{.elements = kElements + more, .growth = kGrowth, .loaded = straight};
    const Impact impact(FeImpactOptions{}, mount);
    if (more == 0) {
      EXPECT_NO_THROW(impact.assemble(blow));
    } else {
      EXPECT_THROW(impact.assemble(blow), std::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace hosel::models
