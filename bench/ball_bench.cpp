// Where an impact's time goes, and how it grows with the mesh. Ratios within one run.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>

#include "hosel/golf/units.hpp"
#include "hosel/models/fe_impact.hpp"
#include "hosel/solvers/linear.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;

Blow oblique() {
  Blow b;
  b.club.head.mass = INFINITY;
  b.delivery = {.club_speed = 40, .club_path = radians(25)};
  return b;
}

FeImpactOptions options(int sector, int harmonics) {
  FeImpactOptions o;
  o.harmonics = harmonics;
  o.mesh = {.sector = sector, .rings = sector, .pole = 0.5, .skin = 0.5, .core = 0.4};
  o.steps_per_contact = 60;
  return o;
}

template <class Work>
double seconds(int repeats, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < repeats; ++i) work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / repeats;
}

/// Unit costs at largest force times how often each was needed, over the time of the whole run.
void Shares(benchmark::State& state) {
  for (auto _ : state) {
    const FeImpactOptions o = options(3, 3);
    const FreeBodyImpact impact = assemble_free_body(oblique(), o);
    FreeBodyImpact run = assemble_free_body(oblique(), o);
    FeImpactResult result;
    fem::State peak;
    double force = 0;
    const double whole = seconds(1, [&] {
      result =
          run_impact(run.system, run.parts, run.initial, o, run.encounter.normal_speed, [&](const ImpactView& view) {
            if (view.report.normal_force > force) force = view.report.normal_force, peak = view.state;
          });
    });
    impact.parts.contact->start(impact.initial);
    fem::Vector inertia = fem::Vector::Zero(impact.system.layout.size()), internal = inertia;
    solvers::SparseTangent tangent(impact.system);
    solvers::Factorisation factors;
    const fem::Weights weights{1, 0, 1e10};
    tangent.assemble(impact.system, peak, weights);
    factors.factorise(tangent);
    const double ball = seconds(20, [&] { impact.parts.ball->residual(peak, inertia, internal); });
    const double contact = seconds(20, [&] { impact.parts.contact->residual(peak, inertia, internal); });
    const double assembly = seconds(5, [&] { tangent.assemble(impact.system, peak, weights); });
    const double factorisation = seconds(5, [&] { factors.factorise(tangent); });
    const double solve = seconds(20, [&] { benchmark::DoNotOptimize(factors.solve(tangent.gather(internal))); });
    const auto n = double(result.counts.iterations), f = double(result.counts.factorisations);
    state.counters["share_ball_residual"] = n * ball / whole;
    state.counters["share_contact"] = n * contact / whole;
    state.counters["share_tangent_assembly"] = f * assembly / whole;
    state.counters["share_factorisation"] = f * factorisation / whole;
    state.counters["share_solves"] = n * solve / whole;
    state.counters["seconds"] = whole;
  }
}
BENCHMARK(Shares)->Iterations(1)->Unit(benchmark::kSecond);

/// Exponent of the cost over the nodes, from 3 to 6 sectors (54 to 216 elements).
void Growth(benchmark::State& state) {
  for (auto _ : state) {
    double nodes[2], cost[2];
    for (int i = 0; i < 2; ++i) {
      const FeImpactOptions o = options(3 + 3 * i, int(state.range(0)));
      Blow b = oblique();
      if (state.range(0) == 0) b.delivery.club_path = 0;
      cost[i] = seconds(1, [&] {
        solve_free_body(b, o, [&](const ImpactView& view) { nodes[i] = double(view.ball.mesh().nodes.size()); });
      });
    }
    state.counters["exponent"] = std::log(cost[1] / cost[0]) / std::log(nodes[1] / nodes[0]);
    state.counters["nodes"] = nodes[1];
    state.counters["seconds"] = cost[1];
  }
}
BENCHMARK(Growth)->Arg(0)->Arg(2)->ArgName("harmonics")->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
