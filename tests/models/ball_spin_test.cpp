// A free ball at 10,000 rpm: what the integrator and the kinematics of large rotation do to it.
#include <gtest/gtest.h>

#include "fem/harmonic_solid.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "golf/units.hpp"
#include "solvers/generalized_alpha.hpp"

namespace hosel::models {
namespace {

constexpr double kSphereRadius = 0.021335, kDensity = 1129.0935;

struct Spinning {
  fem::System system;
  fem::HarmonicSolid* ball = nullptr;
  fem::State state;
  double omega = 10000 * 2 * kPi / 60;

  Spinning() {
    const fem::Solid rubber{
        .elastic = fem::Hyperelastic::neo_hooke(fem::Lame::of(100e6, .49)), .branches = {}, .density = kDensity};
    auto owned = std::make_unique<fem::HarmonicSolid>(
        system.dof_map,
        mesh::sphere_meridian({kSphereRadius}, {.sector = 2, .rings = 2, .pole = 1, .skin = 1, .core = 0.4}),
        fem::cartesian_basis(3), fem::SolidQuadrature{fem::half_circle(10), 2}, std::vector<fem::Solid>{rubber},
        fem::Placement{});
    ball = owned.get();
    system.terms.push_back(std::move(owned));
    state = system.dof_map.rest();
    settle();
  }

  /// v = omega x (X + u) about axis 3, of fields U; the family holds it exactly.
  Eigen::VectorXd turned(const Eigen::VectorXd& q, bool with_reference) const {
    const auto& basis = ball->basis();
    Eigen::VectorXd out = Eigen::VectorXd::Zero(system.dof_map.size());
    const fem::AngularRule circle =
        fem::full_circle(16);  // the flattened sphere needs harmonic 3 of Cartesian components
    fem::State s = system.dof_map.rest();
    s.q = q;
    const Eigen::MatrixXd U = ball->displacement_fields(s);
    for (std::size_t i = 0; i < ball->mesh().nodes.size(); ++i)
      for (Eigen::Index k = 0; k < ball->unknowns(); ++k) {
        const auto e = ball->dof(static_cast<int>(i), k);
        if (e < 0) continue;
        double sum = 0, norm = 0;
        for (const double theta : circle.theta) {
          const Vec3 f = basis[static_cast<std::size_t>(k)].at(theta);
          Vec3 x = ball->functions_at(theta) * U.row(static_cast<Eigen::Index>(i)).transpose();
          if (with_reference) x += ball->reference(static_cast<int>(i), theta);
          sum += f.dot(Vec3(0, 0, omega).cross(x));
          norm += f.squaredNorm();
        }
        out[e] = sum / norm;
      }
    return out;
  }

  /// Relative equilibrium: a = omega x v, force(q) + inertia(a) = 0; rigid motions held by a little mass,
  /// more than the rotation's own softening of omega squared.
  void settle() {
    solvers::SparseTangent tangent(system);
    solvers::Factorisation factors;
    for (int i = 0; i < 30; ++i) {
      state.v = turned(state.q, true);
      state.a = turned(state.v, false);
      Eigen::VectorXd inertia = Eigen::VectorXd::Zero(system.dof_map.size()), force = inertia;
      ball->residual(state, inertia, force);
      if (i % 10 == 0) {
        tangent.assemble(system, state, {1, 0, 1e7});
        factors.factorise(tangent);
      }
      state.q -= factors.solve(inertia + force);
    }
    state.v = turned(state.q, true);
  }
};

TEST(FreeSpin, CentrifugalEnergyAndAngularMomentum) {
  std::vector<double> drift;
  for (const double step : {4e-6, 2e-6}) {
    Spinning spin;
    const fem::Energies start = spin.ball->energies(spin.state);
    // The linear centrifugal solution: 7.6e-4 of the kinetic energy at E = 100 MPa, nu = 0.49.
    EXPECT_NEAR(start.strain / start.kinetic, 7.6e-4, 0.1e-4);
    const Vec3 before = spin.ball->motion(spin.state).angular_momentum;
    const double moment = 8.0 / 15 * kPi * kDensity * std::pow(kSphereRadius, 5) * spin.omega;
    EXPECT_NEAR(before.z(), moment, 5e-3 * moment);  // swollen at the equator, and 2 elements a sector
    solvers::GeneralizedAlpha solver(
        spin.system,
        {.rho_inf = 0.8,
         .newton = {.residual_relative = 1e-10, .increment_vector = 1e-12, .increment_rotation = 1},
         .step_max = step,
         .step_min = step / 8},
        spin.state);
    double largest = 0, least = INFINITY;
    while (solver.time() < 1e-3 * (1 - 1e-9)) {
      solver.advance(1e-3);
      const double ratio = spin.ball->energies(solver.state()).strain / start.kinetic;
      largest = std::max(largest, ratio);
      least = std::min(least, ratio);
    }
    EXPECT_NEAR(largest * start.kinetic / start.strain, 1, 0.01);
    EXPECT_NEAR(least * start.kinetic / start.strain, 1, 0.01);
    const fem::MeanMotion motion = spin.ball->motion(solver.state());
    drift.push_back((motion.angular_momentum - before).norm() / before.norm());
    EXPECT_LT(motion.momentum.norm(), 1e-10 * motion.mass * spin.omega * kSphereRadius);
    EXPECT_LT(drift.back(), 1e-4);
  }
  EXPECT_NEAR(std::log2(drift[0] / drift[1]), 2, 0.3) << drift[0] << " " << drift[1];
}

}  // namespace
}  // namespace hosel::models
