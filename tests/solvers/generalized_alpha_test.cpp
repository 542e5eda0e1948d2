// The time integrator by itself: order, energy ledger, restart, failure.
#include "solvers/generalized_alpha.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/rigid_body.hpp"
#include "solvers/errors.hpp"
#include "solvers/statics.hpp"

namespace hosel::solvers {
namespace {

const std::vector<Index> kPlane{0, 1};

/// [@integrators]: x'' = -k (1 - 1/|x|) x + (0, -9.81), unit mass.
class ElasticPendulum final : public fem::Term {
 public:
  explicit ElasticPendulum(double stiffness = 1000) : k_(stiffness) {}
  std::string body() const override { return "pendulum"; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override { blocks.push_back(kPlane); }
  void residual(const fem::State& s, Vector& inertia, Vector& force) const override {
    const Eigen::Vector2d x = s.q;
    inertia += s.a;
    force += k_ * (1 - 1 / x.norm()) * x - Eigen::Vector2d(0, -9.81);
  }
  void tangent(const fem::State& s, const fem::Weights& w, fem::TangentSink& sink) const override {
    const Eigen::Vector2d x = s.q;
    const double l = x.norm();
    const Eigen::Matrix2d K = k_ * ((1 - 1 / l) * Eigen::Matrix2d::Identity() + x * x.transpose() / (l * l * l));
    sink.add(kPlane, kPlane, w.stiffness * K + w.mass * Eigen::Matrix2d::Identity());
  }
  fem::Energies energies(const fem::State& s) const override {
    const double stretch = Eigen::Vector2d(s.q).norm() - 1;
    return {.kinetic = 0.5 * s.v.squaredNorm(), .strain = 0.5 * k_ * stretch * stretch, .external = -9.81 * s.q[1]};
  }

 private:
  double k_;
};

fem::System pendulum() {
  fem::System s;
  s.dof_map.add_vector(2);
  s.terms.push_back(std::make_unique<ElasticPendulum>());
  return s;
}

fem::State start(const fem::System& system) {
  fem::State s = system.dof_map.rest();
  s.q << 1.05, 0;
  return s;
}

GeneralizedAlphaOptions fixed_step(double rho, double h) {
  return {.rho_inf = rho,
          .newton = {.residual_relative = 1e-11,
                     .residual_absolute = 1e-11,
                     .increment_vector = 1e-10,
                     .increment_rotation = 1e-10},
          .step_max = h,
          .step_min = h / 1024};
}

double pendulum_error(double rho, int steps) {
  fem::System system = pendulum();
  GeneralizedAlpha scheme(system, fixed_step(rho, 3.0 / steps), start(system));
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(scheme.step(3.0 / steps).converged);
  return (Eigen::Vector2d(scheme.state().q) - Eigen::Vector2d(0.02427151, -1.01497073)).norm();
}

class Order : public testing::TestWithParam<std::array<double, 3>> {};

TEST_P(Order, IsTwoWithTheErrorOfTheReference) {
  // [@integrators] prints the errors for 1500 and 12000 steps to three digits (state norm there is
  // the position's); 5 % covers the last digit's and the start-up's freedom.
  const auto [rho, coarse, fine] = GetParam();
  const double e1 = pendulum_error(rho, 1500), e2 = pendulum_error(rho, 3000), e3 = pendulum_error(rho, 12000);
  EXPECT_NEAR(std::log2(e1 / e2), 2.0, 0.05);
  EXPECT_NEAR(e1, coarse, 0.05 * coarse);
  EXPECT_NEAR(e3, fine, 0.05 * fine);
}
INSTANTIATE_TEST_SUITE_P(Rho, Order,
                         testing::Values(std::array{0.9, 1.53e-3, 2.38e-5}, std::array{0.5, 2.27e-3, 3.53e-5},
                                         std::array{0.0, 8.39e-3, 1.30e-4}));

TEST(GeneralizedAlpha, LedgerClosesWithTheStep) {
  double last = 0;
  for (int steps : {3000, 6000}) {
    fem::System system = pendulum();
    GeneralizedAlpha scheme(system, fixed_step(0.5, 3.0 / steps), start(system));
    double worst = 0;
    for (int i = 0; i < steps; ++i) {
      scheme.step(3.0 / steps);
      worst = std::max(worst, std::abs(scheme.ledger().closure));
    }
    // 11.2 J went to and fro (1.25 J of spring, 10 J of gravity): the event happened.
    EXPECT_GT(scheme.ledger().external, 9.0);
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / worst), 2.0, 0.2);  // trapezoidal force work: order 2
    }
    EXPECT_LT(worst, 2e-3);
    last = worst;
  }
}

/// What the ledger calls numerical against the energy that the pendulum lost, worked out here from where it is and how
/// fast. They differ by the trapezoidal work of the spring, of second order as they are: by 0.5 % at either step.
TEST(GeneralizedAlpha, NumericalDissipationIsTheLossOfEnergy) {
  const auto energy = [](const fem::State& s) {
    const Eigen::Vector2d x = s.q;
    return 0.5 * s.v.squaredNorm() + 500 * std::pow(x.norm() - 1, 2) + 9.81 * x.y();
  };
  for (const double h : {1e-3, 5e-4}) {
    fem::System system = pendulum();
    GeneralizedAlpha scheme(system, fixed_step(0.0, h), start(system));
    const double before = energy(scheme.state());
    for (int i = 0; i < int(std::lround(3 / h)); ++i) scheme.step(h);
    const double lost = before - energy(scheme.state());
    ASSERT_GT(lost, 5e-4);
    EXPECT_NEAR(scheme.ledger().numerical / lost, 0.995, 3e-3) << h;
  }
}

TEST(GeneralizedAlpha, RestartGoesOnExactly) {
  fem::System one = pendulum(), two = pendulum();
  const GeneralizedAlphaOptions options = fixed_step(0.8, 2e-3);
  GeneralizedAlpha a(one, options, start(one));
  while (a.time() < 0.5) a.advance(1);
  const Checkpoint saved = a.checkpoint();
  GeneralizedAlpha b(two, options, start(two));
  b.restore(saved);
  // A step of another size first: the auxiliary acceleration moves by how it compares with the last one.
  for (GeneralizedAlpha* scheme : {&a, &b}) ASSERT_TRUE(scheme->step(0.7e-3).converged);
  // Not bitwise: the factor kept by Newton is made afresh after a restart.
  EXPECT_LT((a.state().q - b.state().q).norm(), 1e-12);
  EXPECT_LT((a.state().v - b.state().v).norm(), 1e-9);
  while (a.time() < 1) a.advance(1);
  while (b.time() < 1) b.advance(1);
  EXPECT_LT((a.state().q - b.state().q).norm(), 1e-9);
  EXPECT_NEAR(a.ledger().closure, b.ledger().closure, 1e-9);
  // A state of another size would be read and written beyond its end.
  const auto resized = [&](auto&& vector_of, Eigen::Index size) {
    Checkpoint other = saved;
    vector_of(other).conservativeResize(size);
    return other;
  };
  for (const Eigen::Index size : {1, 3}) {
    EXPECT_THROW(b.restore(resized(
                     [](Checkpoint & c) -> auto& { return c.state.q; }, size)),
                 std::invalid_argument);
    EXPECT_THROW(b.restore(resized(
                     [](Checkpoint & c) -> auto& { return c.state.v; }, size)),
                 std::invalid_argument);
    EXPECT_THROW(b.restore(resized(
                     [](Checkpoint & c) -> auto& { return c.state.a; }, size)),
                 std::invalid_argument);
    EXPECT_THROW(b.restore(resized(
                     [](Checkpoint & c) -> auto& { return c.auxiliary; }, size)),
                 std::invalid_argument);
  }
}

TEST(GeneralizedAlpha, StepsMeetTheEndWithoutASliver) {
  fem::System system = pendulum();
  GeneralizedAlpha scheme(system, fixed_step(0.9, 7e-3), start(system));
  double least = 1;
  while (scheme.time() < 3) least = std::min(least, scheme.advance(3));
  EXPECT_DOUBLE_EQ(scheme.time(), 3);
  EXPECT_EQ(scheme.counts().steps, 429);  // 3 s over 7 ms: the last two share what is left
  EXPECT_GT(least, 3.5e-3);
  EXPECT_LT(least, 7e-3);
}

/// The order with steps of two sizes in turn is that with equal ones: the auxiliary acceleration, of another time than
/// the step's end, moves where the size changes. Left where it was, it leaves an error of the first order.
TEST(GeneralizedAlpha, StepsOfUnlikeSizeKeepTheOrder) {
  const auto error = [](int pairs) {
    fem::System system = pendulum();
    const double h = 3.0 / pairs;
    GeneralizedAlpha scheme(system, fixed_step(0.0, h), start(system));
    for (int i = 0; i < pairs; ++i)
      for (const double share : {0.3, 0.7}) EXPECT_TRUE(scheme.step(share * h).converged);
    return (Eigen::Vector2d(scheme.state().q) - Eigen::Vector2d(0.02427151, -1.01497073)).norm();
  };
  EXPECT_NEAR(std::log2(error(1500) / error(3000)), 2, 0.1);
}

TEST(GeneralizedAlpha, RefusesWhatIsNotStated) {
  fem::System system = pendulum();
  GeneralizedAlphaOptions options = fixed_step(0.9, 1e-3);
  for (double rho : {-0.1, 1.1, std::nan("")}) {
    options.rho_inf = rho;
    EXPECT_THROW(GeneralizedAlpha(system, options, start(system)), std::invalid_argument);
  }
  options = fixed_step(0.9, 1e-3);
  options.newton.residual_relative = options.newton.residual_absolute = 0;
  EXPECT_THROW(GeneralizedAlpha(system, options, start(system)), std::invalid_argument);
}

TEST(GeneralizedAlpha, GivesUpWithOneSentence) {
  fem::System system = pendulum();
  GeneralizedAlphaOptions options = fixed_step(0.9, 1e-3);
  options.newton.max_iterations = 1;  // one iteration can never confirm its own increment
  options.newton.increment_vector = 1e-300;
  GeneralizedAlpha scheme(system, options, start(system));
  const fem::State before = scheme.state();
  std::string said;
  try {
    scheme.advance(1);
  } catch (const NonConvergence& e) { said = e.what(); }
  // When, and what to do about it.
  EXPECT_NE(said.find("t = 0 "), std::string::npos) << said;
  EXPECT_NE(said.find("allow smaller steps"), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  EXPECT_EQ(before.q, scheme.state().q);
  EXPECT_EQ(scheme.counts().steps, 0);
}

/// An asymmetric body that nothing turns, spun nearly about its middle axis: it turns over and comes back. Energy and
/// angular momentum, in size and direction, stay; the spin is its own again after Euler's period,
/// 4 K(k) / p with p^2 = (C - B)(L^2 - 2 E A) / A B C, k^2 = (B - A)(2 E C - L^2) / ((C - B)(L^2 - 2 E A)),
/// where L^2 > 2 E B (L. D. Landau, E. M. Lifshitz, Mechanics, sec. 37). All to second order in the step.
TEST(TorqueFreeBody, KeepsItsMomentaAndHasEulersPeriod) {
  constexpr double A = 1e-4, B = 2e-4, C = 3.5e-4;
  const Vec3 spin(0.5, 30, 2), centre(0.02, -0.01, 0.03);
  const double E = 0.5 * (A * spin.x() * spin.x() + B * spin.y() * spin.y() + C * spin.z() * spin.z()),
               L2 = Vec3(A * spin.x(), B * spin.y(), C * spin.z()).squaredNorm();
  ASSERT_GT(L2, 2 * E * B);
  const double p = std::sqrt((C - B) * (L2 - 2 * E * A) / (A * B * C)),
               k = std::sqrt((B - A) * (2 * E * C - L2) / ((C - B) * (L2 - 2 * E * A))),
               period = 4 * std::comp_ellint_1(k) / p;
  struct Errors {
    double spin, energy, momentum, drift;
  };
  const auto errors = [&](int steps) {
    fem::System system;
    const auto x = system.dof_map.add_vector(3), r = system.dof_map.add_rotation();
    auto owned = std::make_unique<fem::RigidBody>("body", x, r,
                                                  fem::RigidBodyProperties{0.2, Vec3(A, B, C).asDiagonal(), centre});
    const fem::RigidBody& body = *owned;
    system.terms.push_back(std::move(owned));
    fem::State s = system.dof_map.rest();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.8, Vec3(1, -2, 3).normalized()));
    fem::set_rotation(s, r, turn);
    s.v.segment<3>(r.v) = spin;
    s.v.segment<3>(x.v) = -(turn * spin.cross(centre));  // the centre of gravity is at rest
    GeneralizedAlpha scheme(system, fixed_step(1, period / steps), s);
    const Vec3 momentum = body.angular_momentum(scheme.state());
    EXPECT_NEAR(momentum.norm(), std::sqrt(L2), 1e-12 * std::sqrt(L2));
    Errors worst{};
    double over = spin.y();
    for (int i = 0; i < steps; ++i) {
      EXPECT_TRUE(scheme.step(period / steps).converged);
      const fem::State& now = scheme.state();
      over = std::min(over, now.v[r.v + 1]);
      worst.energy = std::max(worst.energy, std::abs(body.energies(now).kinetic / E - 1));
      worst.momentum = std::max(worst.momentum, (body.angular_momentum(now) - momentum).norm() / momentum.norm());
      worst.drift = std::max(worst.drift, body.linear_momentum(now).norm());
    }
    EXPECT_LT(over, -0.9 * spin.y()) << "it turns over";
    worst.spin = (Vec3(scheme.state().v.segment<3>(r.v)) - spin).norm() / spin.norm();
    return worst;
  };
  const Errors coarse = errors(1000), fine = errors(2000);
  EXPECT_LT(fine.spin, 1e-3);
  EXPECT_LT(fine.energy, 1e-3);
  EXPECT_LT(fine.momentum, 1e-3);
  EXPECT_NEAR(std::log2(coarse.spin / fine.spin), 2, 0.2);
  for (const auto value : {&Errors::energy, &Errors::momentum})
    if (coarse.*value > 1e-9) { EXPECT_NEAR(std::log2(coarse.*value / fine.*value), 2, 0.2); }
  EXPECT_LT(fine.drift, 1e-3 * 0.2 * spin.norm() * centre.norm());
}

TEST(Statics, WithoutLoadStepsThereIsNone) {
  fem::System system = pendulum();
  const NewtonOptions newton{.residual_relative = 1e-9, .increment_vector = 1e-9, .increment_rotation = 1e-9};
  for (const int steps : {0, -1})
    EXPECT_THROW(solve_static(system, start(system), {.newton = newton, .load_steps = steps}), std::invalid_argument);
}

TEST(Statics, NewtonAndKinsolHangThePendulum) {
  fem::System system = pendulum();
  fem::State from = system.dof_map.rest();
  from.q << 0.3, -1.0;
  const NewtonOptions newton{
      .residual_relative = 1e-12, .residual_absolute = 1e-10, .increment_vector = 1e-9, .increment_rotation = 1e-9};
  const fem::State a = solve_static(system, from, {.newton = newton, .load_steps = 2});
  const fem::State b = solve_static_kinsol(system, from, 1e-10);
  const Eigen::Vector2d exact(0, -1 - 9.81 / 1000);
  EXPECT_LT((Eigen::Vector2d(a.q) - exact).norm(), 1e-10);
  EXPECT_LT((Eigen::Vector2d(b.q) - exact).norm(), 1e-10);
}

}  // namespace
}  // namespace hosel::solvers
