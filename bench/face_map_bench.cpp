// The driver study on a small grid: the full club's impact against the free body's, what two cores make of the map, and
// whether its bytes are those of one. Ratios within one run.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cases.hpp"
#include "app/sweep.hpp"
#include "solvers/blas.hpp"

namespace {

using namespace hosel;

constexpr std::size_t kPlaces = 15;  // of the small grid: the free body at each, then the club

struct Study {
  app::CaseFile file{app::find_case("grip-matters-not"), {"grid.columns=5", "grid.rows=3", "variant=[]"}};
  std::unique_ptr<app::Job> job = app::read_job(file);
  const app::PointJob& points = dynamic_cast<const app::PointJob&>(*job);
};

const Study& study() {
  static const Study s;
  solvers::keep_blas_in_one_thread();
  return s;
}

struct Cost {
  double wall = 0, cpu = 0;  // cpu: of all threads [s]
};

/// Points of the map on so many threads; their answers, as they would be written.
Cost compute(int threads, std::size_t from, std::size_t to, std::vector<std::string>& answers) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(from, to, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t p = range.begin(); p < range.end(); ++p)
          answers[p] = study().points.compute(2 * (p % kPlaces) + p / kPlaces, {}).dump();
      },
      tbb::simple_partitioner());
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          double(std::clock() - cpu) / CLOCKS_PER_SEC};
}

/// `by_cpu`: CPU time of one thread over that of two, for a machine with other work on it: but for the wait for the
/// last blow that is all there is to lose.
void FaceMap(benchmark::State& state) {
  std::vector<std::string> one(2 * kPlaces), two(one);
  compute(1, kPlaces, kPlaces + 1, one);  // what is kept between impacts is there before the clock starts
  for (auto _ : state) {
    const Cost free = compute(1, 0, kPlaces, one), club = compute(1, kPlaces, 2 * kPlaces, one);
    const Cost both = compute(2, 0, 2 * kPlaces, two);
    if (one != two) state.SkipWithError("the map depends on the number of threads");
    state.counters["free_body_cpu_ms"] = 1e3 * free.cpu / kPlaces;
    state.counters["club_cpu_ms"] = 1e3 * club.cpu / kPlaces;
    state.counters["club_over_free_body"] = club.cpu / free.cpu;
    state.counters["efficiency_on_two"] = (free.wall + club.wall) / (2 * both.wall);
    state.counters["efficiency_by_cpu"] = (free.cpu + club.cpu) / both.cpu;
    state.counters["bytes_equal"] = one == two;
  }
}
BENCHMARK(FaceMap)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
