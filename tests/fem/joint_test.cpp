// Springs between two nodes: derivatives, and the power of the hands.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/supports.hpp"
#include "golf/units.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

JointStiffness stiffness(double damping) {
  JointStiffness k;
  k.translation = {3, 5, 7};
  k.rotation = {2, 4, 6};
  k.translation_damping = damping * Vec3(1, 2, 3);
  k.rotation_damping = damping * Vec3(3, 2, 1);
  k.frame = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  return k;
}

TEST(SpringJoint, ForceIsTheGradientAndTheTangentItsDerivative) {
  DofMap dof_map;
  const Node a{dof_map.add_vector(3), dof_map.add_rotation()}, b{dof_map.add_vector(3), dof_map.add_rotation()};
  State s = dof_map.rest();
  s.q = dof_map.advanced(s.q, test::random_vector(dof_map.size(), 1, 0.7));
  s.v = test::random_vector(dof_map.size(), 2);
  const SpringJoint between("joint", a, b, stiffness(0));
  test::check_gradient(between, dof_map, s, 1e-5, 1e-8);
  test::check_tangent(between, dof_map, s, 1e-5, 1e-8);
  const SpringJoint hands("hands",
                          at_rest(Vec3(0.1, 0.2, 0.3), Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3::UnitY()))), b,
                          stiffness(0));
  test::check_gradient(hands, dof_map, s, 1e-5, 1e-8);
  test::check_tangent(hands, dof_map, s, 1e-5, 1e-8);
}

/// Two nodes some way apart that move, and the joint's strains by hand: d and r of the class's comment.
struct MovingPair {
  DofMap dof_map;
  Node a{dof_map.add_vector(3), dof_map.add_rotation()}, b{dof_map.add_vector(3), dof_map.add_rotation()};
  State s = dof_map.rest();
  MovingPair() {
    s.q = dof_map.advanced(s.q, test::random_vector(dof_map.size(), 1, 0.7));
    s.v = test::random_vector(dof_map.size(), 2);
  }
  Vec6 strains(const Vector& q) const {
    State at = s;
    at.q = q;
    const Eigen::Quaterniond R1 = rotation(at, a.rotation), R2 = rotation(at, b.rotation);
    Vec6 out;
    out << R1.conjugate() * Vec3(q.segment<3>(b.translation.q) - q.segment<3>(a.translation.q)),
        rotation_log(R1.conjugate() * R2);
    return out;
  }
  /// Along a direction of the velocities, by central differences: to some 1e-10.
  Vec6 rates(const Vector& along) const {
    const double h = 1e-5;
    return (strains(dof_map.advanced(s.q, h * along)) - strains(dof_map.advanced(s.q, -h * along))) / (2 * h);
  }
};

/// The damping force is C times the rates, along what the strains change by; its tangent is that of a force linear in
/// the velocities; what it takes is its power.
TEST(SpringJoint, DampersResistTheRatesOfTheirStrainsAndTakeTheirPower) {
  MovingPair p;
  const JointStiffness k = stiffness(0.4);
  Mat6 C = Mat6::Zero();
  C.topLeftCorner<3, 3>() = k.frame * k.translation_damping.asDiagonal() * k.frame.transpose();
  C.bottomRightCorner<3, 3>() = k.frame * k.rotation_damping.asDiagonal() * k.frame.transpose();
  SpringJoint damped("joint", p.a, p.b, k);
  const SpringJoint undamped("joint", p.a, p.b, stiffness(0));
  const Vector force = test::total_residual(damped, p.s) - test::total_residual(undamped, p.s);
  const Vec6 stress = C * p.rates(p.s.v);
  ASSERT_GT(stress.head<3>().norm(), 0.1);
  ASSERT_GT(stress.tail<3>().norm(), 0.1);
  for (Index i = 0; i < p.dof_map.size(); ++i)
    EXPECT_NEAR(force[i], stress.dot(p.rates(Vector::Unit(p.dof_map.size(), i))), 1e-8 * stress.norm()) << i;

  test::DenseSink sink(p.dof_map.size());
  damped.tangent(p.s, {0, 1, 0}, sink);
  const Vector d = test::random_vector(p.dof_map.size(), 5);
  State more = p.s;
  more.v += d;
  const Vector change = test::total_residual(damped, more) - test::total_residual(damped, p.s);
  EXPECT_LT((sink.matrix * d - change).norm(), 1e-12 * change.norm());

  // The same place and velocities over 2 ms, then half of the velocities after 3 ms more: trapezoids.
  const double power = p.rates(p.s.v).dot(stress);
  damped.commit(p.s);
  p.s.time += 2e-3;
  damped.commit(p.s);
  EXPECT_NEAR(damped.energies(p.s).viscous, 2e-3 * power, 1e-8 * 2e-3 * power);
  p.s.time += 3e-3;
  p.s.v *= 0.5;
  damped.commit(p.s);
  EXPECT_NEAR(damped.energies(p.s).viscous, (2e-3 + 3e-3 * 0.625) * power, 1e-8 * 2e-3 * power);
  EXPECT_EQ(damped.energies(p.s).external, 0) << "neither side is driven";
}

/// Hands and the node they hold both move as they are told. What the hands give, and what the node is given beside,
/// is stored or damped: to second order in the step, as the powers are added up by trapezoids.
TEST(SpringJoint, HandsGiveWhatIsStoredDampedAndPassedOn) {
  DofMap dof_map;
  const Node b{dof_map.add_vector(3), dof_map.add_rotation()};
  // A steady turn about an axis beside a swaying place.
  const auto swaying = [](const Vec3& place, const Vec3& sway, const Vec3& axis, double rate, double start) {
    return [=](double t) {
      Pose p;
      p.position = place + std::sin(3 * t) * sway;
      p.velocity = 3 * std::cos(3 * t) * sway;
      p.rotation = Eigen::AngleAxisd(start + rate * t, axis.normalized());
      p.angular_velocity = rate * axis.normalized();  // along the axis it is the same in both frames
      return p;
    };
  };
  const Motion hands = swaying({0.1, 0.2, 0.3}, {0.3, -0.2, 0.1}, {1, 2, 0.5}, 2, 0.3),
               held = swaying({0.2, 0.1, 0.35}, {-0.1, 0.2, 0.25}, {0.4, -1, 2}, -1.5, -0.2);
  struct Books {
    double gap, hands, viscous;
  };
  const auto books = [&](int steps) {
    SpringJoint joint("hands", hands, b, stiffness(0.4));
    ImposedMotion follow(b, held);
    State s = dof_map.rest();
    double start = 0, given = 0, before = 0;
    for (int i = 0; i <= steps; ++i) {
      s.time = 0.8 * i / steps;
      follow.impose(s);
      joint.commit(s);
      const double power = test::total_residual(joint, s).dot(s.v);
      if (i == 0) start = joint.energies(s).strain;
      else given += 0.5 * (before + power) * 0.8 / steps;
      before = power;
    }
    const Energies e = joint.energies(s);
    return Books{e.external + given - (e.strain - start) - e.viscous, e.external, e.viscous};
  };
  const Books coarse = books(100), fine = books(200);
  ASSERT_GT(std::abs(fine.hands), 0.5);
  ASSERT_GT(fine.viscous, 0.5);
  EXPECT_LT(std::abs(fine.gap), 1e-4 * fine.viscous);
  EXPECT_NEAR(std::log2(coarse.gap / fine.gap), 2, 0.1);
}

/// A joint driven at A sin(w t) along one axis of its frame takes pi C w A^2 a cycle.
TEST(SpringJoint, ACycleTakesWhatItsDamperSays) {
  DofMap dof_map;
  const Node b{dof_map.add_vector(3), dof_map.add_rotation()};
  const JointStiffness k = stiffness(0.4);
  constexpr double kAmplitude = 0.02, kOmega = 50;
  constexpr int kSteps = 40;  // trapezoids of a whole period of a sine are exact
  for (int axis = 0; axis < 6; ++axis) {
    const Vec3 along = k.frame.col(axis % 3);
    const bool turns = axis >= 3;
    const auto to_and_fro = [&](double t) {
      const double x = kAmplitude * std::sin(kOmega * t), v = kAmplitude * kOmega * std::cos(kOmega * t);
      Pose p;
      (turns ? p.angular_velocity : p.velocity) = v * along;
      if (turns) p.rotation = Eigen::AngleAxisd(x, along);
      else p.position = x * along;
      return p;
    };
    SpringJoint joint("held", at_rest(Vec3::Zero()), b, k);
    ImposedMotion drive(b, to_and_fro);
    State s = dof_map.rest();
    for (int i = 0; i <= kSteps; ++i) {
      s.time = 2 * kPi / kOmega * i / kSteps;
      drive.impose(s);
      joint.commit(s);
    }
    const double exact = kPi * (turns ? k.rotation_damping : k.translation_damping)[axis % 3] * kOmega * kAmplitude *
                         kAmplitude;
    EXPECT_NEAR(joint.energies(s).viscous, exact, 1e-12 * exact) << axis;
  }
}

}  // namespace
}  // namespace hosel::fem
