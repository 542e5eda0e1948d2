#include "solvers/condensed.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "fem/harmonic_solid.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "solvers/contact_newton.hpp"
#include "tests/support/term_checks.hpp"

extern "C" void omp_set_max_active_levels(int) __attribute__((weak));
extern "C" int omp_get_max_active_levels(void) __attribute__((weak));

namespace hosel::solvers {
namespace {

/// The three parts of a solution, with some rows kept, solve the matrix: the whole one, or where rows are factorised
/// apart what is left when their coupling with the others is taken out. A deformed ball couples its odd functions with
/// its even ones, so the two differ, though not by much.
TEST(Condensed, SolvesWhatItFactorised) {
  const fem::Solid rubber{
      .elastic = fem::Hyperelastic::neo_hooke(fem::Lame::of(60e6, 0.45)), .branches = {}, .density = 1129};
  fem::System system;
  system.terms.push_back(std::make_unique<fem::HarmonicSolid>(
      system.dof_map, mesh::sphere_meridian({0.02}, {.sector = 1, .rings = 1, .pole = .5, .skin = .5, .core = .4}),
      fem::cartesian_basis(1, 1), fem::SolidQuadrature{fem::full_circle(8), 2}, std::vector{rubber}, fem::Placement{}));
  fem::State s = system.dof_map.rest();
  s.q = test::random_vector(system.dof_map.size(), 1, 2e-4);
  SparseTangent tangent(system);
  tangent.assemble(system, s, {1, 0, 1e9});
  const Eigen::MatrixXd whole = tangent.dense();
  const std::vector<char> apart = weakly_coupled(system, tangent), none;
  Eigen::MatrixXd blocks = whole;
  for (Index i = 0; i < blocks.rows(); ++i)
    for (Index j = 0; j < blocks.cols(); ++j)
      if (apart[static_cast<std::size_t>(i)] != apart[static_cast<std::size_t>(j)]) blocks(i, j) = 0;
  const double coupling = (whole - blocks).norm() / whole.norm();
  ASSERT_GT(coupling, 1e-3);
  ASSERT_LT(coupling, 0.1);

  const Vector right = test::random_vector(tangent.size(), 2);
  for (const std::vector<int>& kept : {std::vector<int>{}, {3, 4, 20, 21, 22, 40}})
    for (const bool split : {false, true}) {
      CondensedFactorisation factors;
      ASSERT_TRUE(factors.factorise(tangent, kept, split ? apart : none));
      const Eigen::VectorXf half = factors.eliminate(right);
      const Vector x =
          factors.recover(half, kept.empty() ? Vector() : Vector(factors.schur().llt().solve(factors.condensed(half))));
      // Solutions are in single precision, 6e-8; these are of matrices whose condition costs a factor of ten.
      EXPECT_LT(((split ? blocks : whole) * x - right).norm(), 2e-6 * right.norm());
      EXPECT_GT(((split ? whole : blocks) * x - right).norm(), 1e-2 * right.norm());
    }
}

/// CHOLMOD's threads are switched off while it factorises; those of whoever calls are as they were.
TEST(Condensed, LeavesTheThreadsOfItsHostAlone) {
  if (!omp_set_max_active_levels || !omp_get_max_active_levels) GTEST_SKIP() << "CHOLMOD without OpenMP";
  const fem::Solid rubber{
      .elastic = fem::Hyperelastic::neo_hooke(fem::Lame::of(60e6, 0.45)), .branches = {}, .density = 1129};
  fem::System system;
  system.terms.push_back(std::make_unique<fem::HarmonicSolid>(
      system.dof_map, mesh::sphere_meridian({0.02}, {.sector = 1, .rings = 1, .pole = .5, .skin = .5, .core = .4}),
      fem::cartesian_basis(1, 1), fem::SolidQuadrature{fem::full_circle(8), 2}, std::vector{rubber}, fem::Placement{}));
  SparseTangent tangent(system);
  tangent.assemble(system, system.dof_map.rest(), {1, 0, 1e9});
  const int before = omp_get_max_active_levels();
  omp_set_max_active_levels(3);
  CondensedFactorisation factors;
  EXPECT_TRUE(factors.factorise(tangent, {}, {}));
  EXPECT_EQ(omp_get_max_active_levels(), 3);
  omp_set_max_active_levels(before);
}

}  // namespace
}  // namespace hosel::solvers
