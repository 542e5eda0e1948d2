// The plate element: patch tests, clamped circular and square plates thin and thick, the rim on springs, and the order
// at which errors fall.
#include "fem/plate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "golf/units.hpp"
#include "solvers/linear.hpp"
#include "solvers/modes.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

using Eigen::Vector2d;
constexpr PlateMaterial kUnit{1e9, 0.3, 1000};

struct Model {
  System system;
  const Plate* plate = nullptr;
  Model(const mesh::PlateMesh& mesh, double thickness, const RimSupport& rim = {}, const Face& curvature = {},
        const PlateMaterial& material = kUnit) {
    auto term = std::make_unique<Plate>(system.dof_map, mesh, material,
                                        std::vector<double>(mesh.nodes.size(), thickness), rim, curvature);
    plate = term.get();
    system.terms.push_back(std::move(term));
  }
  Vector solve(const Vector& load) const {
    solvers::SparseTangent K(system);
    K.assemble(system, system.dof_map.rest(), {1, 0, 0});
    solvers::Factorisation factors;
    factors.factorise(K);
    Vector out = Vector::Zero(system.dof_map.size());
    K.scatter(factors.solve(K.gather(load)), out);
    return out;
  }
  double centre_under_pressure() const {
    return plate->deflection(solve(plate->load([](const Vector2d&) { return 1.0; })), Vector2d::Zero());
  }
  std::vector<double> omega(int count) const { return solvers::modes(system, system.dof_map.rest(), count).omega; }
};

double rigidity(double t, const PlateMaterial& m = kUnit) {
  return m.young * t * t * t / 12 / (1 - m.poisson * m.poisson);
}

mesh::PlateMesh disc(int core = 6) {
  return mesh::plate_mesh({.half_width = 1, .half_height = 1}, {.core = core, .rings = std::max(1, core / 2)});
}

/// Two by two elements whose inner nodes are moved, all edges straight.
mesh::PlateMesh distorted() {
  mesh::PlateMesh m = mesh::rectangle_mesh(1, 0.7, 2, 2);
  const auto corner = [&](int i, int j) -> Vector2d& { return m.nodes[static_cast<std::size_t>(10 * j + 2 * i)]; };
  corner(1, 1) += Vector2d(0.23, -0.16);
  corner(1, 0) += Vector2d(-0.2, 0);
  corner(2, 1) += Vector2d(0, 0.15);
  for (const auto& e : m.elements) {
    const auto at = [&](std::size_t k) -> Vector2d& { return m.nodes[static_cast<std::size_t>(e[k])]; };
    at(1) = 0.5 * (at(0) + at(2));
    at(7) = 0.5 * (at(6) + at(8));
    at(3) = 0.5 * (at(0) + at(6));
    at(5) = 0.5 * (at(2) + at(8));
    at(4) = 0.25 * (at(0) + at(2) + at(6) + at(8));
  }
  return m;
}

constexpr RimSupport kFree{0, 0, 0};

/// A field at the nodes: w, by, bz, uy, uz.
template <class Field>
State field(const Model& model, Field&& f) {
  State s = model.system.dof_map.rest();
  const auto& nodes = model.plate->mesh().nodes;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::array<double, 5> values = f(nodes[n]);
    for (int i = 0; i < 5; ++i)
      if (const Index d = model.plate->dof(int(n), Plate::Unknown(i)); d >= 0) s.q[d] = values[std::size_t(i)];
  }
  return s;
}

/// Largest force at unknowns [first, last] of nodes within, over the largest at the rim.
double inner_force(const Model& model, const State& s, int first, int last) {
  const Vector r = test::total_residual(*model.plate, s);
  double inside = 0, rim = 0;
  for (std::size_t n = 0; n < model.plate->mesh().nodes.size(); ++n)
    for (int i = first; i <= last; ++i)
      if (const Index d = model.plate->dof(int(n), Plate::Unknown(i)); d >= 0)
        (model.plate->mesh().on_rim[n] ? rim : inside) =
            std::max(model.plate->mesh().on_rim[n] ? rim : inside, std::abs(r[d]));
  EXPECT_GT(rim, 0);
  return inside / rim;
}

/// The rim of a disc on a shell, moved outwards by u and turned by b, has the energy of a long cylinder's edge with
/// that displacement and the slope -b: 1/2 D (4 B^3 u^2 - 4 B^2 u b + 2 B b^2).
TEST(Plate, AShellAtTheRimBendsAsTheEdgeOfALongCylinder) {
  constexpr double thickness = 0.02, radius = 0.7, u = 1e-3, poisson = kUnit.poisson;
  const double B = std::pow(3 * (1 - poisson * poisson), 0.25) / std::sqrt(radius * thickness), D = rigidity(thickness);
  const RimSupport shell = RimSupport::of_shell(kUnit, thickness, radius, 1);
  const Face curvature{5, 5};
  const Model held(disc(), 0.05, shell, curvature), free(disc(), 0.05, kFree, curvature);
  for (const double b : {0.0, B * u, -0.5 * B * u}) {
    const auto moved = [&](const Vector2d& x) {
      const Vector2d n = x.normalized();
      return x.norm() > 0 ? std::array<double, 5>{0, b * n.x(), b * n.y(), u * n.x(), u * n.y()}
                          : std::array<double, 5>{};
    };
    const double stored = held.plate->energies(field(held, moved)).strain -
                          free.plate->energies(field(free, moved)).strain,
                 wanted = 0.5 * D * (4 * B * B * B * u * u - 4 * B * B * u * b + 2 * B * b * b);
    EXPECT_NEAR(stored / (2 * kPi * wanted), 1, 1e-4) << b;
  }
}

TEST(Plate, PatchTestsAreExact) {
  for (const double t : {0.3, 1e-3}) {
    const Model flat(distorted(), t, kFree);
    const auto quadratic = [](double a, double b, double c) {
      return [=](const Vector2d& x) {
        return std::array<double, 5>{0.5 * a * x.x() * x.x() + 0.5 * b * x.y() * x.y() + c * x.x() * x.y(),
                                     a * x.x() + c * x.y(), b * x.y() + c * x.x(), 0, 0};
      };
    };
    for (const auto& k : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      const State s = field(flat, quadratic(k[0], k[1], k[2]));
      // Round-off of the shear stiffness, (1/t)^2 of that in bending.
      EXPECT_LT(inner_force(flat, s, 0, 2), 1e-13 / (t * t)) << t;
      const double D = rigidity(t), area = 4 * 0.7;
      const double energy = 0.5 * D * area * (k[0] * k[0] + k[1] * k[1] + 2 * 0.7 * k[2] * k[2]);
      EXPECT_NEAR(flat.plate->energies(s).strain, energy, 1e-8 * energy);
    }
    const Model curved(distorted(), t, kFree, {0.9, 0.7});
    const State stretched = field(curved, [](const Vector2d& x) {
      return std::array<double, 5>{0, 0, 0, 0.4 * x.x() - 0.1 * x.y(), 0.7 * x.y() + 0.3 * x.x()};
    });
    EXPECT_LT(inner_force(curved, stretched, 3, 4), 1e-12);
  }
}

/// A shell turned as a rigid body about z stores nothing: w = y, u = -h e_y.
TEST(Plate, RigidMotionsOfAShellStoreNothing) {
  const Face face{0.9, 0.7};
  const Model model(distorted(), 0.05, kFree, face);
  const State turned = field(model, [&](const Vector2d& x) {
    return std::array<double, 5>{x.x(), 1, 0, face.height(x.x(), x.y()), 0};
  });
  const State wrong = field(model, [&](const Vector2d& x) { return std::array<double, 5>{x.x(), 1, 0, 0, 0}; });
  ASSERT_GT(model.plate->energies(wrong).strain, 1e3);
  EXPECT_LT(model.plate->energies(turned).strain, 1e-12 * model.plate->energies(wrong).strain);
}

TEST(Plate, TangentAndEnergy) {
  const Model model(mesh::plate_mesh({.half_width = 0.045, .half_height = 0.025}, {.core = 2, .rings = 1}), 3e-3,
                    {2e8, 3e3, 1e8}, {0.3, 0.25}, {1.14e11, 0.34, 4430});
  State s = model.system.dof_map.rest();
  s.q = test::random_vector(s.q.size(), 3, 1e-4);
  s.v = test::random_vector(s.v.size(), 4, 1);
  s.a = test::random_vector(s.a.size(), 5, 1e4);
  test::check_tangent(*model.plate, model.system.dof_map, s, 1e-5, 1e-9, 1e4);
  test::check_gradient(*model.plate, model.system.dof_map, s, 1e-5, 1e-8);
  ASSERT_GT(model.plate->energies(s).kinetic, 0);
  State moved = s;
  moved.a = s.v;  // the mass times the velocities
  Vector inertia = Vector::Zero(s.v.size()), force = inertia;
  model.plate->residual(moved, inertia, force);
  EXPECT_NEAR(model.plate->energies(s).kinetic, 0.5 * inertia.dot(s.v), 1e-9 * inertia.dot(s.v));
}

/// Uniform pressure on a clamped disc of radius 1: q a^4 / 64 D + q a^2 / (4 kappa G t) at its centre, exactly.
double disc_centre(double t) {
  const double G = kUnit.young / (2 * (1 + kUnit.poisson));
  return 1 / (64 * rigidity(t)) + 1 / (4 * 5.0 / 6 * G * t);
}

TEST(Plate, ClampedDiscUnderPressure) {
  for (const double t : {0.002, 0.02, 0.1, 0.3}) {
    const double found = Model(disc(), t).centre_under_pressure();
    EXPECT_NEAR(found, disc_centre(t), 0.005 * disc_centre(t)) << t;
  }
}

/// Side 1. Legendre-Ritz on Mindlin's plate with 14 functions each way, itself converged to six digits.
struct Square {
  double thickness, centre;      // times q a^4 / D
  std::array<double, 4> lambda;  // omega a^2 sqrt(rho t / D)
};
const Square kSquares[] = {{0.01, 1.267853e-3, {35.94245, 73.23915, 73.23915, 107.89239}},
                           {0.1, 1.504626e-3, {32.52428, 62.03857, 62.03857, 86.94896}},
                           {0.2, 2.172160e-3, {26.52410, 46.29563, 46.29563, 62.16361}}};

TEST(Plate, ClampedSquareUnderPressureAndItsModes) {
  for (const Square& s : kSquares) {
    SCOPED_TRACE(s.thickness);
    const Model model(mesh::rectangle_mesh(0.5, 0.5, 6, 6), s.thickness);
    const double D = rigidity(s.thickness);
    EXPECT_NEAR(model.centre_under_pressure() * D, s.centre, 0.005 * s.centre);
    const std::vector<double> omega = model.omega(4);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(omega[i] * std::sqrt(kUnit.density * s.thickness / D), s.lambda[i], 0.005 * s.lambda[i]) << i;
  }
}

/// Axisymmetric roots of Mindlin's frequency equation of the clamped disc of radius 1, by bisection: w is
/// J0 and I0 of two wave numbers, the rotation (sigma - 1) w'.
double mindlin_disc(double t, int which) {
  const double D = rigidity(t), G = kUnit.young / (2 * (1 + kUnit.poisson)), rho = kUnit.density, R = t * t / 12,
               S = D / (5.0 / 6 * G * t);
  const auto determinant = [&](double omega) {
    const double l4 = rho * t * omega * omega / D, mean = 0.5 * l4 * (R + S),
                 spread = std::sqrt(0.25 * l4 * l4 * (R - S) * (R - S) + l4);
    const double first = mean + spread, second = mean - spread, factor = 1 / (R * l4 - 1 / S);
    const double a = std::sqrt(first), b = std::sqrt(-second), s1 = second * factor - 1, s2 = first * factor - 1;
    return std::cyl_bessel_j(0, a) * s2 * b * std::cyl_bessel_i(1, b) +
           std::cyl_bessel_i(0, b) * s1 * a * std::cyl_bessel_j(1, a);
  };
  const double unit = std::sqrt(D / (rho * t));
  double low = 1 * unit, last = determinant(low);
  for (double omega = low; omega < 200 * unit; omega += 0.05 * unit) {
    const double now = determinant(omega);
    if (last * now < 0 && which-- == 0) {
      low = omega - 0.05 * unit;
      double high = omega;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (determinant(middle) * last > 0 ? low : high) = middle;
      }
      return low;
    }
    last = now;
  }
  return NAN;
}

TEST(Plate, ClampedDiscModes) {
  // Kirchhoff's, by nodal diameters: 0, 1, 1, 2, 2, 0.
  const double thin[] = {10.2158, 21.260, 21.260, 34.877, 34.877, 39.771};
  const double t = 0.004;
  const std::vector<double> omega = Model(disc(), t).omega(6);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(omega[i] * std::sqrt(kUnit.density * t / rigidity(t)), thin[i], 0.005 * thin[i]) << i;
  for (const double thick : {0.05, 0.2}) {
    const std::vector<double> found = Model(disc(), thick).omega(6);
    EXPECT_NEAR(found[0], mindlin_disc(thick, 0), 0.005 * found[0]) << thick;
    EXPECT_NEAR(found[5], mindlin_disc(thick, 1), 0.005 * found[5]) << thick;
  }
}

/// Density only scales the frequencies: the sparse solver finds the same modes where they are at hundreds of kilohertz.
TEST(Plate, LightPlatesHaveTheSameModes) {
  constexpr int kCount = 30;
  const std::vector<double> usual = Model(disc(), 0.02).omega(kCount);
  PlateMaterial light = kUnit;
  for (const double share : {1e-6, 1e-12}) {
    light.density = share * kUnit.density;
    const std::vector<double> found = Model(disc(), 0.02, {}, {}, light).omega(kCount);
    for (std::size_t i = 0; i < kCount; ++i) EXPECT_NEAR(found[i] * std::sqrt(share), usual[i], 1e-7 * usual[i]) << i;
  }
}

/// Errors of deflection and first frequency on meshes of h and h/2. Strains are linear in an element: their energy's
/// error, and so both errors, fall like h^4 where the plate is smooth.
TEST(Plate, OrderOfConvergence) {
  for (const double t : {0.02, 0.2}) {
    SCOPED_TRACE(t);
    const double centre = disc_centre(t), omega = mindlin_disc(t, 0);
    std::vector<double> deflections, frequencies;
    for (const int core : {2, 4, 8}) {
      const Model model(disc(core), t);
      deflections.push_back(std::abs(model.centre_under_pressure() / centre - 1));
      frequencies.push_back(std::abs(model.omega(1)[0] / omega - 1));
    }
    for (const auto& errors : {deflections, frequencies}) {
      ASSERT_GT(errors.back(), 1e-9);
      EXPECT_GT(std::log2(errors[0] / errors[1]), 3.2) << errors[0] << " " << errors[1];
      EXPECT_GT(std::log2(errors[1] / errors[2]), 3.2) << errors[1] << " " << errors[2];
    }
  }
}

/// The rim turns on springs: q a^4 / 64 D (k a / D + 5 + nu) / (k a / D + 1 + nu); it sinks on springs: q a / 2 k more.
TEST(Plate, RimOnSprings) {
  const double t = 0.005, D = rigidity(t), nu = kUnit.poisson;
  for (const double k : {0.0, 0.5 * D, 5 * D, 1e6 * D}) {
    const double exact = (k / D + 5 + nu) / (k / D + 1 + nu) / (64 * D);
    const double found = Model(disc(), t, {.rotation = k}).centre_under_pressure();
    EXPECT_NEAR(found, exact, 0.005 * exact) << k / D;
  }
  const double under = 64 * D;
  const double found = Model(disc(), t, {.deflection = under}).centre_under_pressure();
  EXPECT_NEAR(found, disc_centre(t) + 0.5 / under, 0.005 * found);
}

/// Clamped disc: at the rim the moment is q a^2 / 8, at the centre (1 + nu) q a^2 / 16.
TEST(Plate, StressOfTheClampedDisc) {
  const double t = 0.02;
  const Model model(disc(8), t);
  const Vector w = model.solve(model.plate->load([](const Vector2d&) { return 1.0; }));
  const auto at = [&](const Vector2d& x) {
    const auto p = mesh::locate(model.plate->mesh(), x);
    return model.plate->stress(w, p.element, p.xi, p.eta);
  };
  const double unit = 6 / (t * t);
  EXPECT_NEAR(at({0, 0}).outer[0], -unit * 1.3 / 16, 0.02 * unit / 16);
  EXPECT_NEAR(at({0.99999, 0}).outer[0], unit / 8, 0.04 * unit / 8);
  EXPECT_NEAR(at({0.99999, 0}).inner[0], -unit / 8, 0.04 * unit / 8);
}

/// A clamped shallow spherical cap of base radius 1 under uniform pressure. Axisymmetric Ritz on the same energy with
/// nine polynomials for each of w, b and u, itself converged to nine digits.
TEST(Plate, ClampedShallowCapUnderPressure) {
  struct Cap {
    double thickness, radius, centre;
  };
  for (const Cap& c : {Cap{0.05, 10, 7.302004e-7}, Cap{0.02, 10, 3.032417e-6}, Cap{0.05, 3, 1.0825814e-7}}) {
    ASSERT_LT(c.centre, 0.6 * disc_centre(c.thickness));
    EXPECT_NEAR(Model(disc(), c.thickness, {}, {c.radius, c.radius}).centre_under_pressure(), c.centre,
                5e-4 * c.centre);
  }
}

TEST(PlateMesh, OutlinesAreMeshedToTheirRim) {
  const mesh::PlateOutline ellipse{.half_width = 0.045, .half_height = 0.025};
  const double exact = kPi * 0.045 * 0.025;
  EXPECT_NEAR(mesh::plate_mesh(ellipse, {}).area(), exact, 1e-5 * exact);
  mesh::PlateOutline shield{.form = mesh::PlateOutline::Form::polygon};
  shield.corners = {{-0.04, -0.02}, {0.03, -0.025}, {0.05, 0.01}, {0.01, 0.03}, {-0.045, 0.015}};
  double area = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const Vector2d &a = shield.corners[i], &b = shield.corners[(i + 1) % 5];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_NEAR(mesh::plate_mesh(shield, {}).area(), area, 1e-9 * area);
  const Vector2d inside(0.02, -0.01);
  EXPECT_GE(mesh::locate(mesh::plate_mesh(shield, {}), inside).element, 0);
  EXPECT_LT(mesh::locate(mesh::plate_mesh(shield, {}), {0.06, 0}).element, 0);
  shield.corners[2] = {-0.05, 0.01};
  EXPECT_FALSE(shield.faults().empty());
}

TEST(PlateMesh, ThicknessMaps) {
  mesh::PlateThickness t{mesh::PlateThickness::Rings{{0.3, 0.8}, {3e-3, 2e-3}}};
  EXPECT_DOUBLE_EQ(t.at({0, 0}, 0.1), 3e-3);
  EXPECT_DOUBLE_EQ(t.at({0, 0}, 0.55), 2.5e-3);
  EXPECT_DOUBLE_EQ(t.at({0, 0}, 1), 2e-3);
  t.map = mesh::PlateThickness::Grid{{-1, 1}, {0, 2}, {1, 2, 3, 4}};
  EXPECT_DOUBLE_EQ(t.at({0, 1}, 0), 2.5);
  EXPECT_THROW(t.at({1.1, 1}, 0), std::invalid_argument);
  // Row by row: of each z the values along y.
  const std::vector<double> y{-1, 0.5, 3}, z{0, 2}, value{1, 2, 3, 5, 8, 13};
  t.map = mesh::PlateThickness::Grid{y, z, value};
  ASSERT_TRUE(t.faults().empty());
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(t.at({y[i], z[j]}, 0), value[3 * j + i]) << i << ' ' << j;
  EXPECT_DOUBLE_EQ(t.at({1.75, 0.5}, 0), 0.75 * 2.5 + 0.25 * 10.5);
  t.map = mesh::PlateThickness::Bulge{.centre = 4e-3, .rim = 2e-3, .half_width = 0.03, .half_height = 0.02};
  EXPECT_DOUBLE_EQ(t.at({0, 0}, 0), 4e-3);
  EXPECT_NEAR(t.at({0.015, 0}, 0), 2e-3 + 2e-3 * 0.75 * 0.75, 1e-12);   // half-way along y
  EXPECT_NEAR(t.at({0, -0.016}, 0), 2e-3 + 2e-3 * 0.36 * 0.36, 1e-12);  // four fifths along z
  EXPECT_DOUBLE_EQ(t.at({0, 0.025}, 0), 2e-3);
  t.map = mesh::PlateThickness::Grid{{-1, 1}, {2, 0}, {1, 2, 3, 4}};
  EXPECT_FALSE(t.faults().empty());
}

}  // namespace
}  // namespace hosel::fem
