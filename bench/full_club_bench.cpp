// What the shaft costs: fe-full-club against fe-free-body, the same ball and blow (ratio at most 1.3), and
// the swing against the number of its elements (160 to 40: at most 5).
#include <benchmark/benchmark.h>

#include "hosel/models/fe_full_club.hpp"
#include "tests/support/swing_motion.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;

void impact(benchmark::State& state) {
  Blow blow;
  blow.club = test::driver_club();
  blow.club.shaft->damping_time = 2 * 0.01 / (2 * kPi * 1000);
  blow.delivery = {.club_speed = 45, .dynamic_loft = radians(11), .impact_toe = 0.02};
  FeFullClubOptions options;
  options.impact.harmonics = 2;
  options.impact.mesh = {.sector = 2, .rings = 2, .pole = 0.5, .skin = 0.6, .core = 0.4};
  options.impact.steps_per_contact = 60;
  for (auto _ : state)
    benchmark::DoNotOptimize(state.range(0) ? solve_full_club(blow, options).launch
                                            : solve_free_body(blow, options.impact).launch);
}
BENCHMARK(impact)->Arg(0)->Arg(1)->ArgName("full")->Unit(benchmark::kMillisecond);

void swing(benchmark::State& state) {
  const GripMotion grip(test::swing_track(), 0);
  const fem::Motion motion = [&](double t) { return grip.at(t); };
  for (auto _ : state) {
    Swing s(test::driver_club(), {.elements = static_cast<int>(state.range(0))}, {.motion = motion});
    benchmark::DoNotOptimize(s.run(s.start(-1.1, s.equilibrium(-1.1)), 0, {}));
  }
}
BENCHMARK(swing)->Arg(40)->Arg(80)->Arg(160)->ArgName("elements")->Unit(benchmark::kMillisecond);

}  // namespace
