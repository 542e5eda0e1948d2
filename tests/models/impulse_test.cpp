// Models that see the blow as an impulse in one configuration: stick-slip and hertz-maw.
#include <gtest/gtest.h>

#include <cmath>

#include "golf/units.hpp"
#include "models/rigid/hertz_maw.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "models/rigid/rigid_planar.hpp"
#include "models/rigid/stick_slip.hpp"

namespace hosel::models {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Blow planar(double loft, double attack) {
  Blow b;
  b.club.head.mass = 0.26;
  b.club.head.cg = {-0.02, 0.01, 0.005};
  b.club.head.inertia = 1e30 * Mat3::Identity();
  b.delivery = {.club_speed = 40, .attack_angle = radians(attack), .dynamic_loft = radians(loft)};
  return b;
}

Blow eccentric(double loft) {
  Blow b;
  b.club.head.mass = 0.204;
  b.club.head.cg = {-0.0423, 0.001, 0.0029};
  b.club.head.inertia << 2.843e-4, 0.530e-4, -0.733e-4, 0.530e-4, 4.085e-4, 0.0005e-4, -0.733e-4, 0.0005e-4, 5.679e-4;
  b.club.head.face = {0.305, 0.305};
  b.delivery = {.club_speed = 48,
                .attack_angle = radians(2),
                .club_path = radians(-3),
                .dynamic_loft = radians(loft),
                .face_angle = radians(2),
                .impact_toe = 0.014,
                .impact_high = -0.007};
  return b;
}

/// Kinetic energy given up, and the two momenta about the contact point.
double lost_energy(const Blow& b, const Launch& l) {
  const Mat3 I = first_contact(b).head_inertia;
  const auto head = [&](const Vec3& v, const Vec3& w) {
    return (b.club.head.mass * v.squaredNorm() + w.dot(I * w)) / 2;
  };
  return head(b.delivery.velocity(), b.delivery.head_angular_velocity) - head(l.head_velocity, l.head_spin) -
         (b.ball.mass * l.velocity.squaredNorm() + b.ball.inertia() * l.spin.squaredNorm()) / 2;
}

void expect_momenta(const Blow& b, const Launch& l) {
  const FirstContact g = first_contact(b);
  const double M = b.club.head.mass;
  const Vec3 change = M * (l.head_velocity - b.delivery.velocity()) + b.ball.mass * l.velocity;
  EXPECT_LT(change.norm(), 1e-9 * M * b.delivery.club_speed);
  const Vec3 turning = (-g.head_arm).cross(M * (l.head_velocity - b.delivery.velocity())) +
                       g.head_inertia * (l.head_spin - b.delivery.head_angular_velocity) +
                       (b.ball.radius * g.normal).cross(b.ball.mass * l.velocity) + b.ball.inertia() * l.spin;
  EXPECT_LT(turning.norm(), 1e-9 * M * b.delivery.club_speed * g.head_arm.norm());
}

TEST(StickSlip, IsRigidPlanarWhereTheBallRolls) {
  for (const double mu : {kInf, 1e3, 0.8})
    for (const double loft : {8.0, 25.0, 50.0})
      for (const double et : {0.0, 0.2}) {
        Blow b = planar(loft, -3);
        b.contact.friction = mu;
        b.contact.tangential_restitution = et;
        const Launch p = RigidPlanar().launch(b), s = StickSlip().launch(b);
        ASSERT_GT(p.spin_rate(), 0);
        EXPECT_LT((p.velocity - s.velocity).norm(), 1e-12 * p.ball_speed()) << mu << " " << loft << " " << et;
        EXPECT_LT((p.spin - s.spin).norm(), 1e-12 * p.spin_rate());
      }
}

TEST(StickSlip, IsRigidPlanarWhereTheBallSlides) {
  Blow b = planar(55, 0);
  b.contact.friction = 0.1;
  const ImpulseProblem problem = impulse_problem(b);
  EXPECT_EQ(stick_slip_path(b, problem).rolling_from, 1);
  const Launch p = RigidPlanar().launch(b), s = StickSlip().launch(b);
  EXPECT_LT((p.velocity - s.velocity).norm(), 1e-12 * p.ball_speed());
  EXPECT_LT((p.spin - s.spin).norm(), 1e-12 * p.spin_rate());
}

/// Without friction nothing acts along the face, whether the ball slips from the start or not at all.
TEST(StickSlip, WithoutFrictionThePushIsAlongTheNormal) {
  for (const double loft : {0.0, 30.0}) {
    Blow b = eccentric(loft);
    b.delivery.attack_angle = b.delivery.club_path = b.delivery.face_angle = 0;
    b.delivery.head_angular_velocity.setZero();
    b.club.head.cg = Vec3(-0.035, 0, 0);
    b.delivery.impact_toe = 0.01;
    b.delivery.impact_high = 0;
    b.contact.friction = b.contact.tangential_restitution = 0;
    if (loft == 0) b.club.head.face = {};  // flat: no slip
    const Launch e = RigidEccentric().launch(b), s = StickSlip().launch(b);
    ASSERT_GT(e.ball_speed(), 1);
    EXPECT_LT(s.spin.norm(), 1e-9);
    EXPECT_LT((e.velocity - s.velocity).norm(), 1e-12 * e.ball_speed()) << loft;
  }
}

TEST(StickSlip, SlipEndsAtZeroAndReturnsByTheRestitution) {
  Blow b = eccentric(30);
  b.contact.friction = 0.4;
  for (const double et : {0.0, 0.1}) {
    b.contact.tangential_restitution = et;
    const ImpulseProblem p = impulse_problem(b);
    const StickSlipPath path = stick_slip_path(b, p);
    ASSERT_GT(path.rolling_from, 0.05);
    ASSERT_LT(path.rolling_from, 0.95);
    EXPECT_EQ(path.tangential_restitution, et);
    const Vec3 after = p.contact.approach - p.mobility * path.impulse;
    const Vec3 slip = after - after.dot(p.contact.normal) * p.contact.normal;
    EXPECT_LT((slip + et * p.contact.slip()).norm(), 1e-12 * p.contact.slip().norm());
  }
}

TEST(StickSlip, MomentaAndEnergyBalance) {
  for (const double mu : {0.05, 0.2, 0.5, kInf})
    for (const double et : {0.0, 0.4}) {
      Blow b = eccentric(30);
      b.contact.friction = mu;
      b.contact.tangential_restitution = et;
      const ImpulseProblem p = impulse_problem(b);
      const StickSlipPath path = stick_slip_path(b, p);
      const Launch l = launch_after(b, p, path.impulse);
      ASSERT_GT(l.ball_speed(), 50);
      expect_momenta(b, l);
      const double lost = path.lost_normal + path.lost_friction + path.lost_tangential;
      const double before = b.club.head.mass * 48 * 48 / 2;
      EXPECT_NEAR(lost_energy(b, l), lost, 1e-9 * before);
      EXPECT_GT(path.lost_friction, 0);
      // Coulomb's limit holds for the whole impulse.
      const Vec3 Jt = path.impulse - path.normal_impulse * p.contact.normal;
      EXPECT_LE(Jt.norm(), mu * path.normal_impulse * (1 + 1e-12));
    }
}

// ---- hertz-maw

/// A solid sphere on a fixed plane: psi1 = kappa v_t / (mu v_n), psi2 the same after the blow.
double psi2(double nu, double psi1, int springs, int steps) {
  Blow b;
  b.club.head.mass = kInf;
  b.club.head.inertia = kInf * Mat3::Identity();
  const double kappa = 2 * (1 - nu) / (2 - nu), mu = 0.3, vn = 1, vt = psi1 * mu * vn / kappa;
  b.delivery.club_speed = std::hypot(vn, vt);
  b.delivery.club_path = std::atan2(vt, vn);
  const HertzMawResult r = hertz_maw_impact(b, {1e8, nu, mu, 0}, {springs, steps});
  const Vec3 arm(-b.ball.radius, 0, 0);
  const Vec3 w = b.delivery.velocity() - r.launch.velocity - r.launch.spin.cross(arm);
  EXPECT_NEAR(w.x(), -vn, 1e-9);  // elastic
  return kappa * -w.y() / (mu * vn);
}

struct MawRow {
  double psi1, nu30, nu49, nu50;
};

TEST(HertzMaw, TableOfMawBarberFawcett) {
  // [@maw].
  const MawRow rows[] = {
      {.25, .0417, -.0432, -.0491},     {.5, .0479, -.1296, -.1411},      {.75, .0142, -.2521, -.2685},
      {1, -.0597, -.4032, -.4234},      {1.25, -.2188, -.6132, -.6354},   {1.5, -.4280, -.8296, -.8511},
      {2, -.8372, -1.1750, -1.1901},    {2.5, -1.1623, -1.3672, -1.3707}, {3, -1.3797, -1.3853, -1.3708},
      {3.5, -1.4773, -1.1881, -1.1443}, {4, -1.4365, -.7285, -.6667},     {4.5, -1.2176, -.2285, -.1667},
      {5, -.7647, .2715, .3333},        {6, .2353, 1.2715, 1.3333}};
  for (const auto& [springs, steps, tolerance] :
       {std::tuple{HertzMawOptions{}.springs, HertzMawOptions{}.steps, 0.02}, std::tuple{200, 600, 0.002}}) {
    double worst = 0;
    for (const MawRow& r : rows) {
      worst = std::max(worst, std::abs(psi2(0.3, r.psi1, springs, steps) - r.nu30));
      worst = std::max(worst, std::abs(psi2(0.49, r.psi1, springs, steps) - r.nu49));
      worst = std::max(worst, std::abs(psi2(0.5, r.psi1, springs, steps) - r.nu50));
    }
    EXPECT_LT(worst, tolerance);
  }
}

TEST(HertzMaw, HertzImpact) {
  // [@finite-hertz]: nu = 0.3, 1 m/s.
  Blow b;
  b.club.head.mass = kInf;
  b.club.head.inertia = kInf * Mat3::Identity();
  b.delivery.club_speed = 1;
  const Launch l = hertz_maw_impact(b, {1e8, 0.3, 0.3, 0}).launch;
  EXPECT_NEAR(*l.contact_time, 1.09712468e-3, 1e-3 * 1.0971e-3);
  EXPECT_NEAR(*l.peak_force, 154.0215, 1e-3 * 154);
  EXPECT_NEAR(*l.peak_compression, 3.72756e-4, 1e-3 * 3.72756e-4);
  EXPECT_NEAR(l.ball_speed(), 2, 1e-9);  // the wall moves on at 1 m/s
}

TEST(HertzMaw, MomentaAndEnergyBalance) {
  for (const double loft : {8.0, 30.0, 55.0})
    for (const double damping : {0.0, 6.4e-3}) {
      const Blow b = eccentric(loft);
      HertzMawLaw law;
      law.damping = damping;
      law.friction = 0.3;
      const HertzMawResult r = hertz_maw_impact(b, law);
      ASSERT_GT(*r.launch.peak_force, 5e3);
      expect_momenta(b, r.launch);
      const double before = b.club.head.mass * 48 * 48 / 2;
      EXPECT_NEAR(lost_energy(b, r.launch), r.stored + r.lost_normal + r.lost_friction, 1e-9 * before) << loft;
      EXPECT_GT(r.lost_friction, 0);
      EXPECT_GE(r.lost_normal, 0);
      EXPECT_LT(r.stored, 1e-9 * before);
    }
}

TEST(HertzMaw, TangentialForceReverses) {
  double most = 0, least = 0;
  const Blow b = eccentric(20);
  const Vec3 slip = impulse_problem(b).contact.slip().normalized();
  hertz_maw_impact(b, {}, {}, [&](const HertzMawSample& s) {
    most = std::max(most, s.tangential_force.dot(slip));
    least = std::min(least, s.tangential_force.dot(slip));
  });
  EXPECT_GT(most, 500);
  EXPECT_LT(least, -100);
}

/// A contact that gives far more one way across than the other: sliding never ends, and presses the surfaces apart less
/// than it presses them together.
TEST(StickSlip, SlidingThatNeverClosesJams) {
  Blow blow = planar(0, 0);
  blow.contact.friction = 0.45;
  ImpulseProblem p = impulse_problem(blow);
  p.contact.normal = Vec3::UnitX();
  p.contact.approach = Vec3(10, 5, 0);
  p.mobility << 1.2, -9, -0.5, -9, 100, 0, -0.5, 0, 1;
  ASSERT_GT(p.mobility.determinant(), 0);
  EXPECT_THROW(stick_slip_path(blow, p), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::models
