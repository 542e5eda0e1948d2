// 500 random balls and blows with a fixed seed: every one ends with finite numbers or says why not.
// --benchmark_filter=Blows/500; the shorter ones are its beginning.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "fem/materials/hyperelastic.hpp"
#include "golf/units.hpp"
#include "models/fe/impact.hpp"
#include "solvers/errors.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;

/// One admissible case: 1-80 m/s, loft 0-70 degrees, friction 0-1, up to 20 mm off the centre both ways.
std::pair<Blow, FeImpactOptions> draw(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1.0p-53; };
  const auto log_uniform = [&](double low, double high) { return low * std::pow(high / low, uniform(0, 1)); };
  FeImpactOptions o;
  o.ball = {"random", {}};
  const bool layered = uniform(0, 1) < 0.5;
  for (const double radius : layered ? std::vector<double>{uniform(0.5, 0.9), 1.0} : std::vector<double>{1.0}) {
    const double shear = log_uniform(8e6, 60e6);
    o.ball.layers.push_back({radius,
                             {.elastic = fem::Hyperelastic{.c10 = shear / 2, .bulk = shear * log_uniform(5, 2000)},
                              .branches = {{shear * uniform(0, 2), log_uniform(3e-6, 1e-3)}},
                              .density = uniform(900, 1300)}});
  }
  const double friction = uniform(0, 1);
  o.harmonics = 2;
  o.mesh = {.sector = 2, .rings = 2, .pole = 0.5, .skin = 0.6, .core = 0.4};
  o.penalty = 200;
  o.steps_per_contact = 50;
  Blow b;
  b.contact.patch.coefficient = friction;
  b.club.head.mass = uniform(0.18, 0.32);
  const Vec3 moments(uniform(0.5e-4, 2.5e-4), uniform(0.5e-4, 2.5e-4), uniform(0.5e-4, 2.5e-4));  // second, of mass
  b.club.head.inertia = (Vec3::Constant(moments.sum()) - moments).asDiagonal();
  b.club.head.cg = Vec3(uniform(-0.04, 0), uniform(-0.01, 0.01), uniform(-0.01, 0.01));
  if (uniform(0, 1) < 0.3) b.club.head.face = {.bulge = uniform(0.2, 0.4), .roll = uniform(0.2, 0.4)};
  b.delivery.club_speed = uniform(1, 80);
  b.delivery.dynamic_loft = radians(uniform(0, 70));
  b.delivery.impact_toe = uniform(-0.02, 0.02);
  b.delivery.impact_high = uniform(-0.02, 0.02);
  return {b, o};
}

void Blows(benchmark::State& state) {
  for (auto _ : state) {
    std::mt19937_64 random(20261121);
    double solved = 0, refused = 0, bad = 0;
    for (long i = 0; i < state.range(0); ++i) {
      const auto [blow, options] = draw(random);
      try {
        const FeOutcome out = Impact(options).run(blow);
        const bool finite = out.launch.velocity.allFinite() && out.launch.spin.allFinite() &&
                            std::isfinite(out.result.peak_force);
        const bool plausible = out.result.peak_force > 0 &&
                               std::abs(out.result.ledger.closure) <= 0.05 * out.result.ledger.initial;
        finite&& plausible ? ++solved : ++bad;
      } catch (const solvers::NonConvergence&) { ++refused; }
    }
    state.counters["solved"] = solved;
    state.counters["refused_with_a_reason"] = refused;
    state.counters["bad"] = bad;
    if (bad > 0) state.SkipWithError("an answer is not finite, or its energy does not add up");
  }
}
BENCHMARK(Blows)->Arg(10)->Arg(100)->Arg(500)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
