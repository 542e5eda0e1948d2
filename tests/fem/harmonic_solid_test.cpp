#include "fem/harmonic_solid.hpp"
#include "fem/materials/hyperelastic.hpp"

#include <gtest/gtest.h>

#include "golf/units.hpp"
#include "solvers/modes.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

constexpr double kSolidRadius = 0.021335, kMass = 0.04593;
const double kDensity = kMass / (4.0 / 3 * kPi * std::pow(kSolidRadius, 3));

mesh::Meridian ball(int sector, int rings, double pole = 1, double skin = 1) {
  return mesh::sphere_meridian({kSolidRadius},
                               {.sector = sector, .rings = rings, .pole = pole, .skin = skin, .core = 0.4});
}

Solid neo_hooke(double nu) {
  return {.elastic = Hyperelastic::neo_hooke(Lame::of(100e6, nu)), .branches = {}, .density = kDensity};
}

SolidQuadrature rule_of(const FourierBasis& basis, bool symmetric) {
  int order = 0;
  for (const auto& f : basis) order = std::max(order, f.order);
  return {.angles = symmetric ? half_circle(2 * order + 2) : full_circle(4 * order + 2), .points = 2};
}

TEST(HarmonicSolid, TangentAndGradient) {
  const Solid viscous{.elastic = Hyperelastic{.c10 = 10e6, .c01 = 2e6, .c20 = 1e6, .bulk = 1e8},
                      .branches = {{20e6, 1e-4}},
                      .density = kDensity};
  const struct {
    FourierBasis basis;
    SolidQuadrature quadrature;
  } cases[] = {{axisymmetric_basis(), {single_angle(), 2}},
               {cartesian_basis(2), rule_of(cartesian_basis(2), true)},
               {cartesian_basis(2, 1), rule_of(cartesian_basis(2), false)},
               {cylindrical_basis(2), rule_of(cylindrical_basis(2), false)}};
  for (const auto& c : cases) {
    DofMap dof_map;
    const Placement placement{Vec3(0.1, 0.2, 0.3),
                              Eigen::Quaterniond(0.5, 0.1, 0.7, -0.3).normalized().toRotationMatrix()};
    HarmonicSolid solid(dof_map, ball(1, 1), c.basis, c.quadrature, {viscous}, placement);
    State s = dof_map.rest();
    s.q = test::random_vector(dof_map.size(), 1, 5e-4);
    s.v = test::random_vector(dof_map.size(), 2, 1);
    s.a = test::random_vector(dof_map.size(), 3, 1e3);
    test::check_gradient(solid, dof_map, s, 1e-7, 1e-6);
    s.time = 5e-5;
    test::check_tangent(solid, dof_map, s, 1e-7, 1e-6);
    solid.commit(s);
    test::check_gradient(solid, dof_map, s, 1e-7, 1e-6);
  }
}

/// What a mesh weighs is known before there is a solid of it, to the last bit: densities are scaled by it.
TEST(HarmonicSolid, AMeshWeighsWhatItsSolidWeighs) {
  DofMap dof_map;
  const HarmonicSolid solid(dof_map, ball(2, 2), cartesian_basis(2), rule_of(cartesian_basis(2), true),
                            {neo_hooke(0.4)}, {});
  ASSERT_NEAR(solid.mass(), 4 * kPi / 3 * kDensity * std::pow(solid.mesh().radius, 3), 0.01 * solid.mass());
  EXPECT_EQ(HarmonicSolid::mass(solid.mesh(), solid.materials()), solid.mass());
}

/// [@sphere-modes]: omega R / c_s of the free sphere; the spheroidal modes of degree l appear in the harmonics
/// m = 0...l alike.
struct ModeTable {
  double nu;
  std::vector<double> spheroidal;  // all of degree 1...4 below eta = 6, ascending
};

TEST(HarmonicSolid, SphereModes) {
  const ModeTable tables[] = {{.3, {2.6462170, 3.5299873, 3.9374013, 5.0069568, 5.0459153}},
                              {.49, {2.6648287, 3.8562991, 3.9993050, 5.1560628, 5.4538506}},
                              {.4999, {2.6656143, 3.8701006, 4.0019108, 5.1607720, 5.4728499}}};
  const double torsional[] = {2.50113262, 3.86469978, 5.09461563, 5.76345920};  // T02 T03 T04 T11
  for (const auto& table : tables) {
    const Solid solid = neo_hooke(table.nu);
    const double unit = std::sqrt(solid.shear() / kDensity) / kSolidRadius;
    for (int m = 0; m <= 3; ++m) {
      System system;
      const FourierBasis basis = cylindrical_basis(m);
      const auto mesh = ball(3, 3);
      ASSERT_LE(mesh.nodes.size(), 600u);
      system.terms.push_back(std::make_unique<HarmonicSolid>(
          system.dof_map, mesh, basis, SolidQuadrature{m == 0 ? single_angle() : full_circle(4 * m + 5), 2},
          std::vector<Solid>{solid}, Placement{}));
      const solvers::Modes modes = solvers::modes(system, system.dof_map.rest(), 16);
      std::vector<double> eta;
      for (double w : modes.omega) eta.push_back(w / unit);
      // Rigid motions: along the axis (m = 0); across it and about an axis across it (m = 1).
      const std::size_t rigid = m == 0 ? 1 : m == 1 ? 2 : 0;
      for (std::size_t i = 0; i < rigid; ++i) EXPECT_LT(eta[i], 1e-5 * eta[rigid]) << "m " << m;
      std::vector<double> expected;
      for (std::size_t i = 0; i < 5; ++i) {
        const int degree = table.nu == .3 ? std::array{2, 1, 3, 2, 4}[i] : std::array{2, 1, 3, 4, 2}[i];
        if (degree >= m) expected.push_back(table.spheroidal[i]);
      }
      if (m == 0 && table.nu == .3) expected.push_back(4.9955143);  // S00, radial
      if (m > 0)
        for (int i = 0; i < 4; ++i)
          if (std::array{2, 3, 4, 1}[static_cast<std::size_t>(i)] >= m) expected.push_back(torsional[i]);
      std::sort(expected.begin(), expected.end());
      for (std::size_t i = 0; i < expected.size() && i + rigid < eta.size() && expected[i] < 5.2; ++i)
        EXPECT_NEAR(eta[rigid + i], expected[i], 1e-3 * expected[i]) << "nu " << table.nu << " m " << m;
    }
    System system;
    system.terms.push_back(std::make_unique<HarmonicSolid>(system.dof_map, ball(3, 3), torsion_basis(),
                                                           SolidQuadrature{single_angle(), 2},
                                                           std::vector<Solid>{solid}, Placement{}));
    const solvers::Modes modes = solvers::modes(system, system.dof_map.rest(), 5);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(modes.omega[i + 1] / unit, torsional[i], 1e-3 * torsional[i]);
  }
}

/// The lowest modes converge with the fourth power of the element size: quadratic fields, 2 (p + 1) - 2 in frequency.
TEST(HarmonicSolid, SphereModesConverge) {
  struct Row {
    double nu, eta;
    int m;
    std::size_t at;
  };
  for (const Row& row :
       {Row{.3, 2.6462170, 2, 1}, Row{.49, 2.6648287, 2, 1}, Row{.4999, 2.6656143, 2, 1}, Row{.49, 2.50113262, 2, 0}}) {
    const Solid solid = neo_hooke(row.nu);
    const double unit = std::sqrt(solid.shear() / kDensity) / kSolidRadius;
    const auto error = [&](int n) {
      System system;
      system.terms.push_back(std::make_unique<HarmonicSolid>(system.dof_map, ball(n, n), cylindrical_basis(row.m),
                                                             SolidQuadrature{full_circle(4 * row.m + 5), 3},
                                                             std::vector<Solid>{solid}, Placement{}));
      return std::abs(solvers::modes(system, system.dof_map.rest(), 4).omega[row.at] / unit / row.eta - 1);
    };
    const double coarse = error(1), fine = error(2);
    ASSERT_GT(fine, 1e-8);
    EXPECT_GT(std::log2(coarse / fine), 3.5) << row.nu << " " << coarse << " " << fine;
  }
}

/// A rotation of any size is a member of the Cartesian family from order 1 on: no strain, no force.
TEST(HarmonicSolid, RigidRotationIsExact) {
  const double angle = 1;
  const struct {
    FourierBasis basis;
    Vec3 axis;
    bool symmetric;
  } cases[] = {{cartesian_basis(1), Vec3::UnitZ(), true},
               {cartesian_basis(4), Vec3::UnitZ(), true},
               {cartesian_basis(2, 1), Vec3(1, 2, -3).normalized(), false}};
  for (const auto& c : cases) {
    DofMap dof_map;
    HarmonicSolid solid(dof_map, ball(2, 2, 0.5, 0.5), c.basis, rule_of(c.basis, c.symmetric), {neo_hooke(.4999)}, {});
    // u = (R - 1) X has the fields of a "velocity" (R - 1) X: linear in the columns of R - 1.
    State s = dof_map.rest(), w = s;
    const Mat3 A = Eigen::AngleAxisd(angle, c.axis).toRotationMatrix() - Mat3::Identity();
    const AngularRule circle = full_circle(16);
    for (std::size_t n = 0; n < solid.mesh().nodes.size(); ++n)
      for (Index k = 0; k < solid.unknowns(); ++k) {
        const Index o = solid.offset(static_cast<int>(n), k);
        if (o < 0) continue;
        double sum = 0, norm = 0;
        for (double theta : circle.theta) {
          const Vec3 f = c.basis[static_cast<std::size_t>(k)].at(theta);
          sum += f.dot(A * solid.reference(static_cast<int>(n), theta));
          norm += f.squaredNorm();
        }
        s.q[o] = sum / norm;
      }
    EXPECT_LT(std::abs(solid.energies(s).strain), 1e-9);  // J, against bulk modulus x volume of 4e3 J
    Vector inertia = Vector::Zero(dof_map.size()), force = inertia;
    solid.residual(s, inertia, force);
    EXPECT_LT(force.lpNorm<Eigen::Infinity>(), 1e-6);  // N, against bulk modulus x area of 1e8 N
  }
}

/// Momentum, angular momentum and energy of a rigid motion are those of the sphere.
TEST(HarmonicSolid, RigidMotion) {
  DofMap dof_map;
  const Placement placement{Vec3(0.1, 0.2, 0.3),
                            Eigen::Quaterniond(0.5, 0.1, 0.7, -0.3).normalized().toRotationMatrix()};
  HarmonicSolid solid(dof_map, ball(4, 4), cartesian_basis(2, 2), rule_of(cartesian_basis(2), false), {neo_hooke(.3)},
                      placement);
  State s = dof_map.rest();
  const Vec3 v(3, -4, 5), w(100, -200, 50);
  solid.set_velocity(s, v, w);
  const MeanMotion m = solid.motion(s);
  const double inertia = 0.4 * kMass * kSolidRadius * kSolidRadius;
  EXPECT_NEAR(m.mass, kMass, 1e-5 * kMass);
  EXPECT_LT((m.velocity - v).norm(), 1e-12);
  EXPECT_LT((m.centre - placement.origin).norm(), 1e-9);
  EXPECT_LT((m.angular_momentum - inertia * w).norm(), 2e-5 * inertia * w.norm());
  EXPECT_LT((m.inertia * w - m.angular_momentum).norm(), 1e-12 * inertia * w.norm());
  EXPECT_NEAR(solid.energies(s).kinetic, 0.5 * kMass * v.squaredNorm() + 0.5 * inertia * w.squaredNorm(), 1e-4);
  s.q = test::random_vector(dof_map.q_size(), 1, 1e-3);
  EXPECT_GT((solid.centre(s) - placement.origin).norm(), 1e-6);
  EXPECT_LT((solid.centre(s) - solid.motion(s).centre).norm(), 1e-15);  // round-off of places within a metre
}

}  // namespace
}  // namespace hosel::fem
