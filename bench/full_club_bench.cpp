// What the shaft costs: fe-full-club against fe-free-body, the same ball and blow; a swing against the number of its
// elements and against its own duration. CPU time, in turn.
#include <benchmark/benchmark.h>

#include "bench/cpu_time.hpp"
#include "models/fe/impact.hpp"
#include "tests/support/swing_motion.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;
using bench::seconds;

void FullClub(benchmark::State& state) {
  Blow blow;
  blow.club = test::driver_club();
  blow.club.shaft->damping_time = 2 * 0.01 / (2 * kPi * 1000);
  blow.delivery = {.club_speed = 45, .dynamic_loft = radians(11), .impact_toe = 0.02};
  FeImpactOptions options;
  options.harmonics = 2;
  options.mesh = {.sector = 2, .rings = 2, .pole = 0.5, .skin = 0.6, .core = 0.4};
  options.steps_per_contact = 60;
  for (auto _ : state) {
    double cpu[2] = {};
    for (int i = 0; i < 6; ++i)
      cpu[i % 2] += seconds(1, [&] {
        benchmark::DoNotOptimize(i % 2 ? Impact(options, ShaftMount{}).run(blow).launch
                                       : Impact(options).run(blow).launch);
      });
    state.counters["free_body_s"] = cpu[0] / 3;
    state.counters["full_club_over_free_body"] = cpu[1] / cpu[0];
  }
}
BENCHMARK(FullClub)->Iterations(1)->Unit(benchmark::kSecond);

void SwingElements(benchmark::State& state) {
  const GripMotion grip(test::swing_track(), 0);
  const fem::Motion motion = [&](double t) { return grip.at(t); };
  constexpr double kDuration = 1.1;
  for (auto _ : state) {
    double cpu[2] = {};
    for (int i = 0; i < 4; ++i)
      cpu[i % 2] += seconds(1, [&] {
        Swing s(test::driver_club(), {.elements = i % 2 ? 160 : 40}, {.motion = motion});
        benchmark::DoNotOptimize(s.run(s.start(-kDuration, s.equilibrium(-kDuration)), 0, {}));
      });
    state.counters["duration_over_cpu_of_40"] = 2 * kDuration / cpu[0];
    state.counters["160_over_40"] = cpu[1] / cpu[0];
  }
}
BENCHMARK(SwingElements)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
