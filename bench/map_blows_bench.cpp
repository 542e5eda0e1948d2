// Blows of the driver's face map through the models alone: this file also compiles in checkouts from before contact was
// condensed (dce9ee6), for the ratio to what they cost there.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "golf/shaft_library.hpp"
#include "golf/units.hpp"
#include "models/fe/impact.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;

/// cases/face-map-driver at six places: CPU time a blow, of the head alone and of the club. After one blow of the club,
/// which sees to it that the BLAS opens no threads of its own.
void MapBlows(benchmark::State& state) {
  Blow blow;
  Mat3 inertia;
  inertia << 2.843e-4, 0.530e-4, -0.733e-4, 0.530e-4, 4.085e-4, 0.0005e-4, -0.733e-4, 0.0005e-4, 5.679e-4;
  blow.club.head = {
      .mass = 0.204, .cg = Vec3(-0.0423, 1e-3, 2.9e-3), .inertia = inertia, .face = {.bulge = 0.305, .roll = 0.305}};
  for (const auto& shaft : shaft_library())
    if (shaft.name == "composite-driver") blow.club.shaft = shaft.make();
  blow.club.geometry.hosel = Vec3(-0.015, 0.055, 0.010);
  const double lie = radians(58.0), lean = radians(9.8);
  blow.club.geometry.shaft_axis = Vec3(-std::sin(lean) * std::sin(lie), std::cos(lie), std::cos(lean) * std::sin(lie));
  blow.delivery = {.club_speed = 45, .attack_angle = radians(3.0), .dynamic_loft = radians(13.0)};
  blow.ball.mass = 0.04593;
  blow.ball.radius = 0.0213;
  FeImpactOptions options;
  options.harmonics = options.mesh.sector = options.mesh.rings = 2;
  options.antisymmetric = 1;
  options.steps_per_contact = 30;
  Impact(options, ShaftMount{}).run(blow);
  for (auto _ : state) {
    double cpu[2] = {};
    for (const double toe : {-0.0375, 0.0, 0.01875})
      for (const double high : {-0.009375, 0.01})
        for (int club = 0; club < 2; ++club) {
          blow.delivery.impact_toe = toe;
          blow.delivery.impact_high = high;
          const std::clock_t start = std::clock();
          benchmark::DoNotOptimize(club ? Impact(options, ShaftMount{}).run(blow).launch
                                        : Impact(options).run(blow).launch);
          cpu[club] += double(std::clock() - start) / CLOCKS_PER_SEC / 6;
        }
    state.counters["free_body_cpu_ms"] = 1e3 * cpu[0];
    state.counters["club_cpu_ms"] = 1e3 * cpu[1];
  }
}
BENCHMARK(MapBlows)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
