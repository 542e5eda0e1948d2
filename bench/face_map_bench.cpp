// The driver study on a small grid: the full club's impact against the free body's, the map in units of
// one impact, and what two cores make of it. Ratios within one run.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "hosel/app/cases.hpp"
#include "hosel/app/sweep.hpp"
#include "hosel/solvers/blas.hpp"

namespace {

using namespace hosel;

constexpr std::size_t kPlaces = 15;  // of the small grid; its first map is the free body, its second the club

struct Study {
  app::CaseFile file{app::find_case("face-map-driver"), {"grid.columns=5", "grid.rows=3", "refinement.set=[]"}};
  std::unique_ptr<app::Job> job = app::read_job(file);
  const app::PointJob& points = dynamic_cast<const app::PointJob&>(*job);
};

const Study& study() {
  static const Study s;
  solvers::keep_blas_in_one_thread();
  return s;
}

double seconds(int threads, std::size_t from, std::size_t to) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  const auto start = std::chrono::steady_clock::now();
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(from, to, 1),
      [](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t p = range.begin(); p < range.end(); ++p)
          benchmark::DoNotOptimize(study().points.compute(p, {}));
      },
      tbb::simple_partitioner());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void FaceMap(benchmark::State& state) {
  study().points.compute(kPlaces, {});  // what is kept between impacts is there before the clock starts
  for (auto _ : state) {
    const double free = seconds(1, 0, kPlaces), club = seconds(1, kPlaces, 2 * kPlaces);
    const double centre = seconds(1, kPlaces + kPlaces / 2, kPlaces + kPlaces / 2 + 1);
    const double two = seconds(2, 0, 2 * kPlaces);
    state.counters["free_body_ms"] = 1e3 * free / kPlaces;
    state.counters["club_ms"] = 1e3 * club / kPlaces;
    state.counters["club_over_free_body"] = club / free;
    state.counters["map_of_270_over_one_impact"] = 270.0 * (free + club) / (2 * kPlaces) / centre;
    state.counters["efficiency_on_two"] = (free + club) / (2 * two);
  }
}
BENCHMARK(FaceMap)->Unit(benchmark::kMillisecond)->Iterations(1)->Repetitions(3)->ReportAggregatesOnly(false);

}  // namespace
