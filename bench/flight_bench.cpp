// Flights a second on one core, and what the looser tolerances cost in carry.
#include <benchmark/benchmark.h>

#include <cmath>

#include "models/flight/flight.hpp"

namespace {
using namespace hosel;

Launch drive() {
  const double up = radians(11);
  Launch l;
  l.velocity = 75 * Vec3(std::cos(up), 0.03, std::sin(up));
  l.spin = kRadPerSecPerRpm * Vec3(0, -2600, -300);
  return l;
}

models::FlightConditions conditions(bool windy) {
  models::FlightConditions c;
  if (windy) c.wind = {.speed = 6, .towards = radians(130)};
  return c;
}

/// Arguments: minus the power of ten of the tolerance (5 is the default), and whether there is wind.
void Flight(benchmark::State& state) {
  const Launch l = drive();
  const models::FlightConditions c = conditions(state.range(1));
  const models::FlightOptions options{.tolerance = std::pow(10.0, -double(state.range(0)))};
  for (auto _ : state) benchmark::DoNotOptimize(models::fly(l, {}, c, options).carry);
  const models::Flight f = models::fly(l, {}, c, options), exact = models::fly(l, {}, c, {.tolerance = 1e-12});
  state.counters["flights_per_s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["steps"] = double(f.steps);
  state.counters["carry_error_mm"] = 1e3 * (f.landing.position - exact.landing.position).norm();
}
BENCHMARK(Flight)->ArgsProduct({{4, 5, 6, 8, 10}, {0, 1}})->Unit(benchmark::kMicrosecond);

/// The law inferred from flights: two logarithms at every rate.
void FlightByRadar(benchmark::State& state) {
  const Launch l = drive();
  models::FlightConditions c = conditions(false);
  c.law = models::find_flight_law("radar-2022")->make();
  for (auto _ : state) benchmark::DoNotOptimize(models::fly(l, {}, c).carry);
  state.counters["flights_per_s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(FlightByRadar)->Unit(benchmark::kMicrosecond);

void Jacobian(benchmark::State& state) {
  const Launch l = drive();
  const models::FlightConditions c = conditions(false);
  for (auto _ : state) benchmark::DoNotOptimize(models::flight_jacobian(l, {}, c));
}
BENCHMARK(Jacobian)->Unit(benchmark::kMicrosecond);

}  // namespace
