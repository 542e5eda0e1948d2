// Exact elastostatics of the harmonic solid: the patch test and [@thick-sphere], the pressurised thick sphere.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>

#include "fem/harmonic_solid.hpp"
#include "fem/materials/equivalent_stress.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "fem/materials/linear_elastic.hpp"
#include "fem/materials/ogden.hpp"
#include "fem/materials/st_venant_kirchhoff.hpp"
#include "solvers/statics.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

/// A short cylinder of 3 x 3 straight-sided, distorted elements.
mesh::Meridian distorted_patch() {
  constexpr int n = 3;
  constexpr double size = 0.01;
  mesh::Meridian mesh;
  std::array<std::array<int, 2 * n + 1>, 2 * n + 1> id{};
  const auto corner = [](int i, int j) {
    Eigen::Vector2d p(size * i / n, size * j / n);
    if (i % n != 0) p.x() += size * 0.07 * ((i + 2 * j) % 3 - 0.8);
    if (j % n != 0) p.y() += size * 0.06 * ((2 * i + j) % 3 - 1.1);
    return p;
  };
  for (int j = 0; j <= 2 * n; ++j)
    for (int i = 0; i <= 2 * n; ++i) {
      if (i % 2 == 1 && j % 2 == 1) continue;
      id[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = static_cast<int>(mesh.nodes.size());
      mesh.nodes.push_back(0.5 * (corner(i / 2, j / 2) + corner((i + 1) / 2, (j + 1) / 2)));
    }
  const auto at = [&](int i, int j) { return id[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)]; };
  for (int b = 0; b < 2 * n; b += 2)
    for (int a = 0; a < 2 * n; a += 2) {
      mesh.elements.push_back({at(a, b), at(a + 2, b), at(a + 2, b + 2), at(a, b + 2), at(a + 1, b), at(a + 2, b + 1),
                               at(a + 1, b + 2), at(a, b + 1)});
      mesh.layer.push_back(0);
    }
  mesh.radius = size;
  return mesh;
}

/// Holds chosen equations at chosen values.
class Held final : public Prescribed {
 public:
  std::vector<Index> at;      // equations
  std::vector<Index> offset;  // the same in State::q
  std::vector<double> value;
  const std::vector<Index>& dofs() const override { return at; }
  void impose(State& s) const override {
    for (std::size_t i = 0; i < at.size(); ++i) s.q[offset[i]] = value[i];
  }
};

/// A homogeneous deformation imposed on the boundary is found inside, to round-off, for any law.
TEST(SolidStatics, PatchTest) {
  const Lame stiff = Lame::of(100e6, 0.4999), soft = Lame::of(60e6, 0.3);
  const std::vector<Solid> laws{
      {.elastic = LinearElastic{soft}, .branches = {}, .density = 1},
      {.elastic = StVenantKirchhoff{soft}, .branches = {}, .density = 1},
      {.elastic = Hyperelastic::neo_hooke(stiff), .branches = {}, .density = 1},
      {.elastic = Hyperelastic{.c10 = 10e6, .c01 = 4e6, .c20 = 1e6, .bulk = 1e9}, .branches = {}, .density = 1},
      {.elastic = Ogden{.powers = {{15e6, 1.8}, {4e6, -2.5}}, .bulk = 1e9}, .branches = {}, .density = 1}};
  Mat3 A;  // displacement gradient, symmetric about the plane of axes 1 and 2
  A << 0.06, 0.10, 0, -0.04, -0.05, 0, 0, 0, 0;
  for (const bool planar : {true, false}) {
    if (!planar) A(0, 2) = 0.05, A(2, 1) = -0.08;
    // Nearly no change of volume, else the bulk modulus of nu = 0.4999 would tear the body apart.
    const double plane = (1 + A(0, 0)) * (1 + A(1, 1)) - A(0, 1) * A(1, 0);
    A(2, 2) += (1.001 - (Mat3::Identity() + A).determinant()) / plane;
    for (const Solid& law : laws) {
      System system;
      const FourierBasis basis = planar ? cartesian_basis(2) : cartesian_basis(1, 1);
      const AngularRule angles = planar ? half_circle(8) : full_circle(13);
      auto owned = std::make_unique<HarmonicSolid>(system.dof_map, distorted_patch(), basis, SolidQuadrature{angles, 2},
                                                   std::vector<Solid>{law}, Placement{});
      const HarmonicSolid& solid = *owned;
      system.terms.push_back(std::move(owned));
      const State rest = system.dof_map.rest();
      State exact = rest;
      auto held = std::make_unique<Held>();
      const AngularRule circle = full_circle(16);
      for (std::size_t i = 0; i < solid.mesh().nodes.size(); ++i)
        for (Index k = 0; k < solid.unknowns(); ++k) {
          const Index offset = solid.offset(static_cast<int>(i), k);
          if (offset < 0) continue;
          double sum = 0, norm = 0;
          for (const double theta : circle.theta) {
            const Vec3 f = basis[static_cast<std::size_t>(k)].at(theta);
            sum += f.dot(A * solid.reference(static_cast<int>(i), theta));
            norm += f.squaredNorm();
          }
          exact.q[offset] = sum / norm;
          const Eigen::Vector2d& x = solid.mesh().nodes[i];
          const double size = solid.mesh().radius;
          if (x.x() == 0 || x.x() == size || x.y() == size) {
            held->at.push_back(solid.dof(static_cast<int>(i), k));
            held->offset.push_back(offset);
            held->value.push_back(exact.q[offset]);
          }
        }
      const std::size_t imposed = held->at.size();
      ASSERT_LT(imposed, static_cast<std::size_t>(system.dof_map.size()) * 3 / 4);
      system.prescribed.push_back(std::move(held));
      // From a disturbed start: the whole displacement at once would turn elements at the boundary inside out.
      State start = exact;
      start.q += test::random_vector(system.dof_map.q_size(), 1, 1e-6);
      const auto found = solvers::solve_static(system, start,
                                               {.newton = {.residual_relative = 1e-12,
                                                           .increment_vector = 1e-14,
                                                           .increment_rotation = 1,
                                                           .max_iterations = 100},
                                                .load_steps = 4});
      const double size = exact.q.lpNorm<Eigen::Infinity>();
      ASSERT_GT(size, 5e-4);
      EXPECT_LT((found.q - exact.q).lpNorm<Eigen::Infinity>(), 1e-11 * size);
      // One stress everywhere.
      PointResponse point;
      const Mat3 F = Mat3::Identity() + A;
      if (law.elastic.corotated()) continue;  // its frame is the patch's own mean rotation
      evaluate(law, F, Mat3::Identity(), 0, {}, false, point);
      const Sym sigma = to_sym(point.stress * F.transpose() / F.determinant());
      for (const Sym& s : solid.cauchy_at_nodes(found, {angles.theta[0], angles.theta[3], 0.4, -2.0}))
        EXPECT_LT((s - sigma).norm(), 1e-8 * sigma.norm());
    }
  }
}

/// A dead pressure on the inside of a shell.
class InnerPressure final : public Term {
 public:
  InnerPressure(const HarmonicSolid& solid, double inner, double pressure) {
    const auto& mesh = solid.mesh();
    std::vector<std::pair<double, int>> ring;  // nodes of the inner surface from one pole to the other
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      if (mesh.nodes[i].norm() < inner * (1 + 1e-9))
        ring.emplace_back(std::atan2(mesh.nodes[i].y(), mesh.nodes[i].x()), static_cast<int>(i));
    std::ranges::sort(ring);
    for (std::size_t e = 0; e + 2 < ring.size(); e += 2)
      for (const auto& [x, w] : {std::pair{-std::sqrt(0.6), 5.0 / 9}, {0.0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}}) {
        const Eigen::Vector3d N(0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)), dN(x - 0.5, -2 * x, x + 0.5);
        Eigen::Vector2d at = Eigen::Vector2d::Zero(), along = at;
        for (std::size_t i = 0; i < 3; ++i) {
          at += N[static_cast<Index>(i)] * mesh.nodes[static_cast<std::size_t>(ring[e + i].second)];
          along += dN[static_cast<Index>(i)] * mesh.nodes[static_cast<std::size_t>(ring[e + i].second)];
        }
        // Pushed outwards from the cavity; unknowns are the axial and the radial displacement.
        const Eigen::Vector2d load = 2 * M_PI * at.y() * w * pressure * Eigen::Vector2d(along.y(), -along.x());
        for (std::size_t i = 0; i < 3; ++i)
          for (Index k = 0; k < 2; ++k)
            if (const Index q = solid.dof(ring[e + i].second, k); q >= 0)
              loads_.emplace_back(q, N[static_cast<Index>(i)] * load[k]);
      }
  }
  std::string body() const override { return "load"; }
  void pattern(std::vector<std::vector<Index>>&) const override {}
  void residual(const State&, Vector&, Vector& force) const override {
    for (const auto& [at, load] : loads_) force[at] -= load;
  }
  void tangent(const State&, const Weights&, TangentSink&) const override {}
  Energies energies(const State&) const override { return {}; }

 private:
  std::vector<std::pair<Index, double>> loads_;
};

/// [@thick-sphere]: radial displacement inside and outside, hoop stress inside; up to nu = 0.4999, no locking.
TEST(SolidStatics, PressurisedThickSphere) {
  constexpr double a = 0.010, b = 0.021335, p = 1e6;
  struct Row {
    double nu, inside, outside;
  };
  for (const Row& row : {Row{.3, 7.7053292399e-5, 2.5715699333e-5}, Row{.49, 8.3281684462e-5, 1.8735723800e-5},
                         Row{.4999, 8.3606216470e-5, 1.8372030338e-5}}) {
    System system;
    auto owned = std::make_unique<HarmonicSolid>(
        system.dof_map, mesh::shell_meridian(a, b, 8, 4), axisymmetric_basis(), SolidQuadrature{single_angle(), 2},
        std::vector<Solid>{{.elastic = LinearElastic{Lame::of(100e6, row.nu)}, .branches = {}, .density = 1}},
        Placement{});
    const HarmonicSolid& solid = *owned;
    system.terms.push_back(std::move(owned));
    system.terms.push_back(std::make_unique<InnerPressure>(solid, a, p));
    // The equator's plane stays in place: one node of it holds the translation.
    const auto node = static_cast<int>(std::ranges::find_if(solid.mesh().nodes,
                                                            [&](const Eigen::Vector2d& x) {
                                                              return std::abs(x.x()) < 1e-9 &&
                                                                     x.norm() > b * (1 - 1e-9);
                                                            }) -
                                       solid.mesh().nodes.begin());
    ASSERT_LT(node, static_cast<int>(solid.mesh().nodes.size()));
    auto held = std::make_unique<Held>();
    held->at = {solid.dof(node, 0)};
    held->offset = {solid.offset(node, 0)};
    held->value = {0};
    system.prescribed.push_back(std::move(held));
    const auto found = solvers::solve_static(
        system, system.dof_map.rest(),
        {.newton = {.residual_relative = 1e-10, .increment_vector = 1e-10, .increment_rotation = 1}});
    const auto u = solid.displacement_fields(found);
    for (std::size_t i = 0; i < solid.mesh().nodes.size(); ++i) {
      const Eigen::Vector2d& x = solid.mesh().nodes[i];
      const double radial = u.row(static_cast<Index>(i)).dot(x.normalized());
      if (x.norm() < a * (1 + 1e-9)) {
        EXPECT_NEAR(radial, row.inside, 5e-3 * row.inside) << row.nu;
      } else if (x.norm() > b * (1 - 1e-9)) {
        EXPECT_NEAR(radial, row.outside, 5e-3 * row.outside) << row.nu;
      }
    }
    const auto around = solid.cauchy_at_nodes(found, {0.0, 2.0});
    const Sym &s = around[2 * static_cast<std::size_t>(node)], &aside = around[2 * static_cast<std::size_t>(node) + 1];
    EXPECT_NEAR(von_mises(aside), von_mises(s), 1e-9 * von_mises(s)) << "the same all around";
    EXPECT_NEAR(s[2], 172189.891414, 0.01 * 172190) << row.nu;  // hoop stress outside
  }
}

}  // namespace
}  // namespace hosel::fem
