// Cost of one reduced impact on one core, and of 10,000 on all cores.
#include <benchmark/benchmark.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "bench/cpu_time.hpp"
#include "golf/face_library.hpp"
#include "golf/units.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "models/reduced/shaft_impedance.hpp"
#include "models/reduced/volumetric.hpp"
#include "models/rigid/hertz_maw.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "models/rigid/stick_slip.hpp"

namespace {
using namespace hosel;

Blow blow(double toe) {
  Blow b;
  b.club.head.mass = 0.204;
  b.club.head.cg = {-0.0423, 0.001, 0.0029};
  b.club.head.inertia = Vec3(2.843e-4, 4.085e-4, 5.679e-4).asDiagonal();
  b.club.head.face = {0.305, 0.305};
  b.delivery = {.club_speed = 48,
                .attack_angle = radians(2),
                .club_path = radians(-3),
                .dynamic_loft = radians(13),
                .face_angle = radians(2),
                .impact_toe = toe,
                .impact_high = -0.007};
  return b;
}

/// Times `run(tolerance)` and says what the tolerance, 10 to the minus argument, costs in accuracy.
template <class Run>
void measure(benchmark::State& state, const Run& run) {
  const double tolerance = std::pow(10.0, -double(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(run(tolerance).launch);
  const auto r = run(tolerance), exact = run(1e-9);
  state.counters["steps"] = double(r.steps);
  state.counters["rates"] = double(r.rate_calls);
  state.counters["speed_error"] = (r.launch.velocity - exact.launch.velocity).norm() / exact.launch.velocity.norm();
  state.counters["spin_error"] = (r.launch.spin - exact.launch.spin).norm() / exact.launch.spin.norm();
}

/// Argument: minus the power of ten of the tolerance (4 is the default).
void Volumetric(benchmark::State& state) {
  const Blow b = blow(0.014);
  measure(state, [&](double tolerance) {
    return models::volumetric_impact(b, {}, {models::Integrator::rosenbrock, tolerance});
  });
}
BENCHMARK(Volumetric)->DenseRange(2, 6)->Unit(benchmark::kMicrosecond);

/// With a face that yields, and what that costs.
void VolumetricOnAFace(benchmark::State& state) {
  Blow b = blow(0.014);
  b.club.head.compliance = find_face("modern-driver")->face;
  for (auto _ : state) benchmark::DoNotOptimize(models::volumetric_impact(b, {}).launch);
}
BENCHMARK(VolumetricOnAFace)->Unit(benchmark::kMicrosecond);

void VolumetricCvode(benchmark::State& state) {
  const Blow b = blow(0.014);
  const models::Volumetric model({}, {models::Integrator::cvode, 1e-6});
  for (auto _ : state) benchmark::DoNotOptimize(model.launch(b));
}
BENCHMARK(VolumetricCvode)->Unit(benchmark::kMicrosecond);

/// The loop's base, asked for every shot of a table many times.
void RigidEccentric(benchmark::State& state) {
  Blow b = blow(0.014);
  for (auto _ : state) {
    b.delivery.dynamic_loft += 1e-12;
    benchmark::DoNotOptimize(models::RigidEccentric().launch(b));
  }
}
BENCHMARK(RigidEccentric)->Unit(benchmark::kNanosecond);

void StickSlip(benchmark::State& state) {
  Blow b = blow(0.014);
  b.contact.friction = 0.4;
  const models::StickSlip model;
  for (auto _ : state) benchmark::DoNotOptimize(model.launch(b));
}
BENCHMARK(StickSlip)->Unit(benchmark::kMicrosecond);

void HertzMaw(benchmark::State& state) {
  const Blow b = blow(0.014);
  const models::HertzMaw model;
  for (auto _ : state) benchmark::DoNotOptimize(model.launch(b));
}
BENCHMARK(HertzMaw)->Unit(benchmark::kMicrosecond);

Shaft tapered() {
  Shaft shaft;
  for (int i = 0; i <= 20; ++i) {
    const double x = 0.05 * i, bending = 70 - 50 * x;
    shaft.stations.push_back({.arc_length = x,
                              .bending_stiffness_y = bending,
                              .bending_stiffness_z = bending,
                              .torsional_stiffness = 17.5,
                              .axial_stiffness = 3e6,
                              .shear_stiffness = 3e5,
                              .mass_per_length = 0.06,
                              .rotary_inertia_y = 8e-7,
                              .rotary_inertia_z = 8e-7,
                              .outer_radius = 0.005});
  }
  return shaft;
}

void ShaftCoupled(benchmark::State& state) {
  Blow b = blow(0.014);
  b.club.shaft = tapered();
  const models::ShaftImpedance impedance = models::shaft_impedance(b.club);
  measure(state, [&](double tolerance) {
    return models::volumetric_impact(b, {}, {models::Integrator::rosenbrock, tolerance}, &impedance);
  });
}
BENCHMARK(ShaftCoupled)->DenseRange(2, 6)->Unit(benchmark::kMicrosecond);

/// A thousand blows over the face, one after the other and side by side in turn: CPU microseconds a blow on one core.
void batch(benchmark::State& state, const models::ImpactModel& model, const Blow& of) {
  std::vector<Blow> blows(1000, of);
  for (std::size_t k = 0; k < blows.size(); ++k) {
    blows[k].delivery.impact_toe = -0.02 + 4e-5 * double(k);
    blows[k].delivery.club_speed = 40 + 1.3 * double(k % 10);
  }
  for (auto _ : state) {
    double alone = 0, together = 0;
    for (int round = 0; round < 5; ++round) {
      alone += bench::seconds(1, [&] {
        for (const Blow& b : blows) benchmark::DoNotOptimize(model.launch(b));
      });
      together += bench::seconds(1, [&] { benchmark::DoNotOptimize(model.launches(blows)); });
    }
    const double us = 1e6 / (5 * double(blows.size()));
    state.counters["us_alone"] = us * alone;
    state.counters["us_together"] = us * together;
    state.counters["ratio"] = alone / together;
  }
}
constexpr models::VolumetricOptions kCoarse{models::Integrator::rosenbrock, 1e-3};
void VolumetricBatch(benchmark::State& state) { batch(state, models::Volumetric({}, kCoarse), blow(0)); }
BENCHMARK(VolumetricBatch)->Iterations(1);
void VolumetricOnAFaceBatch(benchmark::State& state) {
  Blow b = blow(0);
  b.club.head.compliance = find_face("modern-driver")->face;
  batch(state, models::Volumetric({}, kCoarse), b);
}
BENCHMARK(VolumetricOnAFaceBatch)->Iterations(1);
void ShaftCoupledBatch(benchmark::State& state) {
  Blow b = blow(0);
  b.club.shaft = tapered();
  batch(state, models::ShaftCoupled({}, kCoarse), b);
}
BENCHMARK(ShaftCoupledBatch)->Iterations(1);

/// One thread and two, in turn. Efficiency = time of one / (2 x time of two); `by_cpu` the same from the CPU time of
/// all threads, for a machine with other work on it: but for the wait for the last batch, one in 200, that is all there
/// is to lose.
void TenThousand(benchmark::State& state) {
  const models::Volumetric model;
  const auto wall = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  for (auto _ : state) {
    double spent[2] = {}, cpu[2] = {};
    for (int i = 0; i < 6; ++i) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(1 + i % 2));
      const double start = wall();
      cpu[i % 2] += bench::seconds(1, [&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, 10000, 50), [&](const auto& range) {
          for (int k = range.begin(); k < range.end(); ++k)
            benchmark::DoNotOptimize(model.launch(blow(-0.02 + 4e-6 * k)));
        });
      });
      spent[i % 2] += wall() - start;
    }
    state.counters["efficiency"] = spent[0] / (2 * spent[1]);
    state.counters["by_cpu"] = cpu[0] / cpu[1];
    state.counters["cpu_s_of_one_thread"] = cpu[0] / 3;
  }
}
BENCHMARK(TenThousand)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
