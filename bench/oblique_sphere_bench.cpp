// Oblique blows of elastic spheres on a rigid wall against what others found, on meshes that resolve the patch:
// too long for ./test, which holds four rows of them (ObliqueSphere). Every row gives its own figures, the
// references and the deviations; --benchmark_filter picks rows.
#include <benchmark/benchmark.h>

#include <cmath>

#include "fem/materials/linear_elastic.hpp"
#include "fem/materials/st_venant_kirchhoff.hpp"
#include "tests/support/elastic_sphere.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;

FeImpactOptions sphere(const fem::Solid& material, int harmonics, const mesh::MeridianOptions& mesh) {
  FeImpactOptions o;
  o.ball = elastic_ball("sphere", material);
  o.harmonics = harmonics;
  o.mesh = mesh;
  o.tangential_penalty = 1;
  o.newton_relative = 1e-5;
  return o;
}

/// Velocities in m/s, after contact.
struct Reference {
  double v_t, v_n, rim, peak;  ///< along the wall, off it, radius times spin; normal force [N]
};

void against(benchmark::State& state, const test::Bounce& b, const Reference& r) {
  const auto compare = [&](const std::string& name, double here, double there) {
    state.counters[name] = here;
    state.counters[name + "_off_%"] = 100 * (here / there - 1);
  };
  compare("v_t", b.v_t, r.v_t);
  compare("v_n", b.v_n, r.v_n);
  compare("R_omega", b.rim, r.rim);
  compare("peak_N", b.peak_force, r.peak);
  state.counters["pull_N"] = b.pull;
  state.counters["push_N"] = b.push;
}

/// An explicit half sphere of 16,740 hexahedra: St Venant-Kirchhoff, E = 60 MPa, nu = 0.3; it is good to 1 %.
/// The patch has some six elements along its radius at every speed.
void HalfSphere(benchmark::State& state) {
  struct Row {
    double speed, angle, friction;
    Reference found;
  };
  constexpr Row rows[] = {{10, 25, .3, {2.065, 9.065, 5.014, 1830}}, {10, 25, .6, {2.229, 9.071, 4.629, 1834}},
                          {10, 45, .3, {3.537, 7.092, 8.323, 1347}}, {10, 45, .6, {3.649, 7.209, 8.000, 1377}},
                          {3, 25, .3, {.683, 2.717, 1.402, 434}},    {3, 45, .3, {1.119, 2.119, 2.429, 317}},
                          {1, 25, .3, {.244, .906, .435, 114}},      {1, 45, .3, {.386, .706, .788, 84}}};
  const Row& row = rows[state.range(0)];
  state.SetLabel(std::to_string(int(row.speed)) + " m/s, " + std::to_string(int(row.angle)) + " degrees, friction 0." +
                 std::to_string(int(10 * row.friction)));
  mesh::MeridianOptions mesh{.sector = 5, .rings = 4, .pole = .3, .far = 2, .skin = .35};
  if (row.speed == 3) mesh.pole = .2, mesh.far = 3, mesh.skin = .25;
  if (row.speed == 1) mesh.pole = .13, mesh.far = 4, mesh.skin = .15;
  FeImpactOptions o =
      sphere({.elastic = fem::StVenantKirchhoff{fem::Lame::of(60e6, .3)}, .branches = {}, .density = 1129},
             row.speed == 10 ? 3 : 2, mesh);
  o.penalty = 4000;
  o.steps_per_contact = 120;
  const double angle = radians(row.angle);
  for (auto _ : state)
    against(state, test::bounce(o, row.speed * std::cos(angle), row.speed * std::sin(angle), row.friction), row.found);
}
BENCHMARK(HalfSphere)->DenseRange(0, 7)->ArgName("row")->Iterations(1)->Unit(benchmark::kSecond);

/// A small-strain prototype (N = 4, its axis tilted back as here): linear, E = 100 MPa, nu = 0.49, 35 m/s along the
/// normal, friction 0.4. Which mean rotation it takes is not known: the last digits are a matter of that choice.
void GolfLike(benchmark::State& state) {
  const bool steep = state.range(0) == 20;
  FeImpactOptions o =
      sphere({.elastic = fem::LinearElastic{fem::Lame::of(100e6, .49)}, .branches = {}, .density = 1129}, 4,
             {.sector = 4, .rings = 4, .pole = .5, .skin = .5});
  o.tilt = steep ? .06 : .2;
  o.penalty = 1000;
  o.steps_per_contact = 320;
  for (auto _ : state) {
    const test::Bounce b = test::bounce(o, 35, 35 * std::tan(radians(double(state.range(0)))));
    state.counters["v_t"] = b.v_t;
    state.counters["R_omega"] = b.rim;
    state.counters["v_t_off_%"] = 100 * (b.v_t / (steep ? 7.038 : 13.435) - 1);
    state.counters["R_omega_off_%"] = 100 * (b.rim / (steep ? 14.815 : 28.559) - 1);
  }
}
BENCHMARK(GolfLike)->Arg(20)->Arg(35)->ArgName("degrees")->Iterations(1)->Unit(benchmark::kSecond);

/// Tangential rebound psi2(psi1) (kappa / mu times tangential over normal speed, after and before), and at psi1 = 1
/// its way to the half space of Maw, Barber and Fawcett (-0.403) as the patch shrinks against the sphere: linear,
/// E = 100 MPa, nu = 0.49, friction 0.1; references of the prototype at N = 4.
void SmallPatch(benchmark::State& state) {
  struct Row {
    double radius, psi1, expected;  ///< of the patch over the sphere's
    mesh::MeridianOptions mesh;
    double penalty;
  };
  // Some eight elements along the patch's radius and five below it to that depth.
  const mesh::MeridianOptions wide{.sector = 10, .rings = 12, .pole = .11, .far = 6, .skin = .05};
  const Row rows[] = {{.079, 1, -.584, wide, 1600},
                      {.079, 2, -1.360, wide, 1600},
                      {.079, 3, -1.483, wide, 1600},
                      {.079, 5, .290, wide, 1600},
                      {.031, 1, -.497, {.sector = 10, .rings = 14, .pole = .045, .far = 14, .skin = .02}, 4000},
                      {.0125, 1, -.454, {.sector = 10, .rings = 17, .pole = .018, .far = 30, .skin = .008}, 10000}};
  const Row& row = rows[state.range(0)];
  FeImpactOptions o =
      sphere({.elastic = fem::LinearElastic{fem::Lame::of(100e6, .49)}, .branches = {}, .density = 1129}, 2, row.mesh);
  o.penalty = row.penalty;
  o.steps_per_contact = 60;
  constexpr double kappa = 2 * .51 / 1.51;
  const double v = .3 * std::pow(row.radius / .079, 2.5);  // Hertz: a^2 = R d, d ~ v^0.8
  for (auto _ : state) {
    const test::Bounce b = test::bounce(o, v, row.psi1 * .1 / kappa * v, .1);
    state.counters["a_over_R"] = row.radius;
    state.counters["psi1"] = row.psi1;
    state.counters["psi2"] = kappa / .1 * (b.v_t - b.rim) / v;
    state.counters["psi2_expected"] = row.expected;
    state.counters["peak_N"] = b.peak_force;
  }
}
BENCHMARK(SmallPatch)->DenseRange(0, 5)->ArgName("row")->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
