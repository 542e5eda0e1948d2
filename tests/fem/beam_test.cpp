// The beam term: derivatives, rigid motion.
#include "fem/beam.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

Section thick() {
  return {.axial = 3e3,
          .shear_y = 1.1e3,
          .shear_z = 0.9e3,
          .torsion = 40,
          .bending_y = 50,
          .bending_z = 70,
          .mass = 400,
          .rotary = Vec3(30, 10, 20),
          .centres = {.elastic = {0.03, -0.05}, .shear = {-0.04, 0.02}, .mass = {0.06, 0.01}}};
}

/// A two-element beam far from its reference, with rotations of up to about a radian between nodes.
struct Scrambled {
  /// `shear` multiplies the section's stiffness against it; inf holds the sections.
  explicit Scrambled(double damping_time, double shear = 1) {
    const Mat3 frame = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    beam.emplace(
        dof_map, mesh::arc({0, 0.5, 0.8}, 1.3, Vec3(0.2, -0.1, 0.4), frame),
        [shear](double s) {
          Section q = thick();
          q.bending_y *= 1 + s;
          q.shear_y *= shear;
          q.shear_z *= shear;
          return q;
        },
        BeamOptions{.gravity = Vec3(1, 2, -9), .damping_time = damping_time});
    state = dof_map.rest();
    beam->place(state);
    state.q = dof_map.advanced(state.q, test::random_vector(dof_map.size(), 11, 0.4));
    state.v = test::random_vector(dof_map.size(), 12, 3);
    state.a = test::random_vector(dof_map.size(), 13, 30);
  }
  DofMap dof_map;
  std::optional<Beam> beam;
  State state;
};

TEST(Beam, ResidualIsTheGradientOfTheEnergyAndTheTangentItsDerivative) {
  Scrambled s(0);
  test::check_tangent(*s.beam, s.dof_map, s.state, 1e-5, 1e-8);
  // Gravity is in the force but not in the stored energy.
  DofMap dof_map;
  const Beam weightless(dof_map, s.beam->line(),
                        [](double a) {
                          Section q = thick();
                          q.bending_y *= 1 + a;
                          return q;
                        },
                        {});
  test::check_gradient(weightless, dof_map, s.state, 1e-5, 1e-8);
}

/// The change of strain rates with the configuration is left out of the tangent: it vanishes where nothing moves. By
/// the velocities, and at rest by the configuration, the tangent is the residual's.
TEST(Beam, DampedTangentIsThatOfTheResidual) {
  Scrambled s(1e-3);
  const Vector f = test::total_residual(*s.beam, s.state);
  Scrambled undamped(0);
  const Vector elastic = test::total_residual(*undamped.beam, s.state);
  ASSERT_GT((f - elastic).norm(), 1e-3 * f.norm());
  const Eigen::Index n = s.dof_map.size();
  test::DenseSink sink(n), without(n);
  s.beam->tangent(s.state, {0, 1, 0}, sink);
  undamped.beam->tangent(s.state, {0, 1, 0}, without);
  ASSERT_GT((sink.matrix - without.matrix).norm(), 1e-2 * sink.matrix.norm()) << "the damping is seen";
  for (unsigned seed = 1; seed <= 3; ++seed) {
    // Quadratic in v: central differences are exact.
    const Vector d = test::random_vector(n, seed);
    State plus = s.state, minus = s.state;
    plus.v += d;
    minus.v -= d;
    const Vector difference = 0.5 * (test::total_residual(*s.beam, plus) - test::total_residual(*s.beam, minus));
    EXPECT_LT((difference - sink.matrix * d).norm(), 1e-10 * difference.norm());
  }
  s.state.v.setZero();
  test::check_tangent(*s.beam, s.dof_map, s.state, 1e-5, 1e-8);
}

TEST(Beam, HeldSectionsToo) {
  Scrambled s(0, std::numeric_limits<double>::infinity());
  ASSERT_GT(s.beam->strains(s.state).front().gamma.tail<2>().norm(), 0.01) << "far from what holding would leave";
  test::check_tangent(*s.beam, s.dof_map, s.state, 1e-5, 1e-8);
  for (const Beam::Resultant& at : s.beam->resultants(s.state))
    EXPECT_GT(at.force.tail<2>().norm(), 1e3 * thick().shear_y * 0.01) << "held by more than the section's own";
}

TEST(Beam, DampingForceIsPowerOfTheStrainRates) {
  // Stress = C (strain + tau rate): d(force)/dtau . v is the dissipated power, so never negative.
  Scrambled undamped(0), damped(1e-3);
  const Vector f = test::total_residual(*damped.beam, damped.state) -
                   test::total_residual(*undamped.beam, undamped.state);
  const double power = f.dot(damped.state.v);
  EXPECT_GT(power, 0);
  State later = damped.state;
  damped.beam->commit(damped.state);
  later.time += 2e-3;  // the same rates over 2 ms
  damped.beam->commit(later);
  EXPECT_NEAR(damped.beam->energies(later).viscous, 2e-3 * power, 1e-12 * power);
}

TEST(Beam, RigidMotionStrainsNothing) {
  DofMap dof_map;
  const Beam beam(dof_map, mesh::arc({0, 0.5, 0.8}, 1.3, Vec3(0.2, -0.1, 0.4), Mat3::Identity()),
                  [](double) { return thick(); }, {});
  State s = dof_map.rest();
  beam.place(s);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.9, Vec3(1, -2, 0.5).normalized()));
  for (const Node& n : beam.nodes()) {
    s.q.segment<3>(n.translation.q) = turn * Vec3(s.q.segment<3>(n.translation.q)) + Vec3(10, 20, 30);
    set_rotation(s, n.rotation, turn);
  }
  for (const auto& strain : beam.strains(s)) EXPECT_LT(strain.gamma.norm() + strain.kappa.norm(), 1e-12);
}

TEST(Beam, RefusesNegativeStiffness) {
  DofMap dof_map;
  Section bad = thick();
  bad.bending_z = -1;
  EXPECT_THROW(Beam(dof_map, mesh::straight({0, 1}, Vec3::Zero(), Mat3::Identity()), [&](double) { return bad; }, {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace hosel::fem
