// Flights a second on one core by every law, what the looser tolerances cost in carry, and how good its gradient is.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>

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

const models::FlightLawEntry& law_of(benchmark::State& state) {
  return models::flight_laws()[std::size_t(state.range(0))];
}

/// By every shipped law, at the default tolerance.
void FlightBy(benchmark::State& state) {
  const Launch l = drive();
  models::FlightConditions c = conditions(false);
  c.law = law_of(state).make();
  for (auto _ : state) benchmark::DoNotOptimize(models::fly(l, {}, c).carry);
  state.SetLabel(std::string(law_of(state).name));
  state.counters["flights_per_s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(FlightBy)->DenseRange(0, int(models::flight_laws().size()) - 1)->Unit(benchmark::kMicrosecond);

/// By equal steps of a hundredth of a second times the argument, with wind.
void FlightInSteps(benchmark::State& state) {
  const Launch l = drive();
  const models::FlightConditions c = conditions(true);
  const double step = 0.01 * double(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(models::fly_in_steps(l, {}, c, step).carry);
  const models::Flight f = models::fly_in_steps(l, {}, c, step), exact = models::fly(l, {}, c, {.tolerance = 1e-12});
  state.counters["flights_per_s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["carry_error_mm"] = 1e3 * (f.landing.position - exact.landing.position).norm();
}
BENCHMARK(FlightInSteps)->Arg(2)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMicrosecond);

/// A launch moved along one of its six quantities.
Launch moved(const Launch& l, int quantity, double by) {
  double speed = l.ball_speed(), up = l.launch_angle(), right = l.azimuth();
  Launch out = l;
  if (quantity == models::kBallSpeed) speed += by;
  if (quantity == models::kLaunchAngle) up += by;
  if (quantity == models::kAzimuth) right += by;
  out.velocity = speed * Vec3(std::cos(up) * std::cos(right), -std::cos(up) * std::sin(right), std::sin(up));
  if (quantity == models::kBackspin) out.spin.y() -= by;
  if (quantity == models::kSidespin) out.spin.z() -= by;
  if (quantity == models::kRiflespin) out.spin.x() += by;
  return out;
}

/// The variational equations by every law, and how far carry's gradient lies from central differences of flights at a
/// tolerance of 1e-12: the largest component's error over the largest; speed and spins as shares of theirs, angles in
/// radians.
void Jacobian(benchmark::State& state) {
  const Launch l = drive();
  models::FlightConditions c = conditions(false);
  c.law = law_of(state).make();
  for (auto _ : state) benchmark::DoNotOptimize(models::flight_jacobian(l, {}, c));
  state.SetLabel(std::string(law_of(state).name));
  for (const double tolerance : {1e-5, 1e-6, 1e-10}) {
    const models::FlightJacobian exact = models::flight_jacobian(l, {}, c, {.tolerance = tolerance});
    double error = 0, size = 0;
    for (int k = 0; k < models::kLaunchQuantities; ++k) {
      const double scale = k == models::kBallSpeed ? l.ball_speed() : k >= models::kBackspin ? l.spin_rate() : 1;
      const double h = 1e-4 * scale;
      const auto carry = [&](double by) { return models::fly(moved(l, k, by), {}, c, {.tolerance = 1e-12}).carry; };
      // Fourth order: what is left of the difference itself is below 1e-8.
      const double slope = (8 * (carry(h) - carry(-h)) - (carry(2 * h) - carry(-2 * h))) / (12 * h);
      error = std::max(error, scale * std::abs(exact(models::kCarry, k) - slope));
      size = std::max(size, scale * std::abs(slope));
    }
    state.counters["gradient_error_at_1e" + std::to_string(std::lround(std::log10(tolerance)))] = error / size;
  }
}
BENCHMARK(Jacobian)->DenseRange(0, int(models::flight_laws().size()) - 1)->Unit(benchmark::kMicrosecond);

}  // namespace
