// Pressure and friction over the patch against theory: the stations of the contact and the field that stands for them.
// Every row prints relative L2 errors over the patch; --benchmark_filter picks rows.
#include <benchmark/benchmark.h>

#include "tests/support/pressed_sphere.hpp"

namespace {
using namespace hosel;

/// Meshes of the accuracies, and finer ones with their grading.
mesh::MeridianOptions mesh_of(int sector) {
  mesh::MeridianOptions mesh;
  mesh.sector = mesh.rings = sector;
  return mesh;
}

void report(benchmark::State& state, const test::Pressed& p) {
  state.counters["a_over_R"] = p.radius;
  state.counters["edges"] = p.edges;
  state.counters["p_stations_%"] = 100 * p.stations.pressure;
  state.counters["p_field_%"] = 100 * p.field.pressure;
  state.counters["force_off_%"] = 100 * p.force_off;
  state.counters["moment_off_%"] = 100 * p.moment_off;
  if (p.friction_ratio > 0) {
    state.counters["Q_over_muP"] = p.friction_ratio;
    state.counters["q_stations_%"] = 100 * p.stations.friction;
    state.counters["q_field_%"] = 100 * p.field.friction;
  }
}

/// Sectors (look 2, default 3, reference 4), approach in thousandths of the radius, Poisson's ratio in hundredths.
void Normal(benchmark::State& state) {
  for (auto _ : state)
    report(state, test::press({.nu = 0.01 * double(state.range(2)),
                               .approach = 1e-3 * double(state.range(1)),
                               .mesh = mesh_of(int(state.range(0)))}));
}
BENCHMARK(Normal)
    ->ArgsProduct({{2, 3, 4, 6, 8, 12}, {40, 94, 160, 200}, {30, 49}})
    ->ArgNames({"sector", "approach", "nu"})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

/// The same, nu = 0.49, pulled along the plates at friction 0.3; harmonics as the accuracies have them.
void Oblique(benchmark::State& state) {
  const int sector = int(state.range(0));
  for (auto _ : state)
    report(state, test::press({.nu = 0.49,
                               .approach = 1e-3 * double(state.range(1)),
                               .mesh = mesh_of(sector),
                               .harmonics = sector == 2 ? 2 : 4,
                               .friction = 0.3,
                               .pull = 1e-4 * double(state.range(2))}));
}
BENCHMARK(Oblique)
    ->ArgsProduct({{2, 3, 4, 6}, {50, 94, 160}, {200, 400, 800, 1200}})
    ->ArgNames({"sector", "approach", "pull"})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
