// Blind examination of the loop: makes data sets with undeclared effects, runs the command on them, scores.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "build_info.hpp"
#include "files.hpp"
#include "records.hpp"
#include "units.hpp"

namespace examination {
namespace {

namespace fs = std::filesystem;

void make(std::uint64_t seed, const std::string& stratum, int sets, const std::vector<int>& shots,
          const fs::path& dir) {
  int failed = 0;
  for (int i = 0; i < sets; ++i) {
    try {
      write_set(make_set(seed, stratum, shots[static_cast<std::size_t>(i) % shots.size()], i), dir);
    } catch (const std::runtime_error& e) {
      fmt::print(stderr, "{}\n", e.what());
      ++failed;
    }
  }
  fmt::print("{}: {} sets{}\n", stratum, sets - failed, failed ? fmt::format(", {} could not be drawn", failed) : "");
}

/// Rows of the project's reference tables (computed elsewhere): the generator's physics against them.
int verify() {
  struct Row {
    double v, attack, path, face, loft, toe, high, speed, launch, azimuth, back, side, rifle;
  };
  const Row rows_a[] = {
      {50, 0, 0, 0, 10, 0, 0, 68.7996625, 8.1568547, 0, 2476.09382, 0, 0},
      {50, 3, 0, 0, 13, 0, 0, 68.7996625, 11.1568547, 0, 2476.09382, 0, 0},
      {50, 0, 0, 0, 10, 20, 0, 67.0417009, 8.1044535, 4.0202226, 2444.23816, -188.28558, -198.66279},
      {50, 0, 0, 0, 12, 0, 10, 67.1318532, 12.0128637, 0, 2485.70699, 0, 0},
      {50, 0, 0, 0, 12, 0, -10, 68.2542186, 7.4994374, 0, 3453.13610, 0, 0},
      {50, -1, 4, -2, 11, 0, 0, 68.0572782, 8.7779367, -0.8427541, 2958.08862, -1492.09525, -186.91199},
      {42, -3, -3, 3, 14, 12, -6, 56.1572111, 9.4649126, 4.2558819, 3709.46885, 1152.83596, -83.31975}};
  const Row row_b{46, 2, 2, -1, 12, 8, 5, 63.1286855, 10.9169153, 1.3165128, 2502.76664, -884.02101, -228.06872};
  Head a, b;
  b.cg_m = Vector3d(-0.038, 0.003, 0.004);
  b.inertia_kg_m2 << 2.9e-4, -2e-5, 3e-5, -2e-5, 4.1e-4, 1e-5, 3e-5, 1e-5, 5.6e-4;
  double worst = 0;
  const auto compare = [&](const Row& r, const Head& head) {
    const Flight f = strike(
        {r.v, r.attack * deg, r.path * deg, r.face * deg, r.loft * deg, r.toe * 1e-3, r.high * 1e-3}, head, {}, {});
    const double error[] = {f.speed / r.speed - 1,
                            (f.launch / deg - r.launch) / 10,
                            (f.azimuth / deg - r.azimuth) / 10,
                            (f.backspin / rpm - r.back) / 3000,
                            (f.sidespin / rpm - r.side) / 3000,
                            (f.riflespin / rpm - r.rifle) / 3000};
    for (const double e : error) worst = std::max(worst, std::abs(e));
  };
  for (const Row& r : rows_a) compare(r, a);
  compare(row_b, b);
  // rigid-planar by its closed form.
  double planar = 0;
  Random random(1);
  for (int k = 0; k < 50; ++k) {
    const double v = random.uniform(30, 50), attack = random.uniform(-5, 4) * deg, loft = random.uniform(8, 40) * deg;
    Nature nature;
    nature.planar = true;
    const Ball ball;
    const Flight f = strike({v, attack, 0, 0, loft, 0.01, 0.004}, a, ball, nature);
    const double angle = loft - attack, ratio = ball.mass_kg / a.mass_kg;
    const double e = 0.86 - 0.0029 * v * std::cos(angle);
    const double vn = v * std::cos(angle) * (1 + e) / (1 + ratio),
                 vp = v * std::sin(angle) / (1 + ratio + 1 / ball.inertia_factor);
    planar =
        std::max({planar, std::abs(f.speed / std::hypot(vn, vp) - 1), std::abs(f.launch - (loft - std::atan(vp / vn))),
                  std::abs(f.backspin / (vp / (ball.inertia_factor * ball.radius_m)) - 1)});
  }
  fmt::print(
      "rigid-eccentric: largest relative difference to the reference rows {:.1e}\nrigid-planar: to the closed form "
      "{:.1e}\n",
      worst, planar);
  return worst < 1e-8 && planar < 1e-12 ? 0 : 1;  // the rows are printed to nine digits
}

}  // namespace
}  // namespace examination

int main(int argc, char** argv) {
  using namespace examination;
  CLI::App app{"Blind examination of the loop"};
  app.require_subcommand(1);
  std::uint64_t seed = 1;
  std::string stratum, dir, hosel = HOSEL_COMMAND;
  int sets = 10, jobs = 1, limit = 600;
  double scale = 0.1;
  std::vector<int> shots{30, 100, 300};

  auto* make_command = app.add_subcommand("make", "make sets of one stratum");
  make_command->add_option("--seed", seed, "below 1000: development; from 1000 on: examination")->required();
  make_command->add_option("--stratum", stratum)->required();
  make_command->add_option("--sets", sets)->capture_default_str();
  make_command->add_option("--shots", shots, "shots per set, taken in turn")->delimiter(',');
  make_command->add_option("--out", dir)->required();
  auto* run_command = app.add_subcommand("run", "run the command on every set");
  auto* score_command = app.add_subcommand("score", "score the reports against the keys");
  auto* all_command = app.add_subcommand("all", "make, run and score every stratum");
  all_command->add_option("--seed", seed)->required();
  all_command->add_option("--scale", scale, "share of the full numbers of sets")->capture_default_str();
  all_command->add_option("--out", dir)->required();
  auto* records_command = app.add_subcommand("records", "make, run and score time histories");
  records_command->add_option("--seed", seed)->required();
  records_command->add_option("--sets", sets, "per stratum")->capture_default_str();
  records_command->add_option("--out", dir)->required();
  for (auto* c : {run_command, score_command}) c->add_option("--dir", dir)->required();
  for (auto* c : {run_command, all_command, records_command}) {
    c->add_option("--hosel", hosel)->capture_default_str();
    c->add_option("--jobs", jobs)->capture_default_str();
    c->add_option("--limit", limit, "seconds per set")->capture_default_str();
  }
  auto* verify_command = app.add_subcommand("verify", "the generator's physics against reference values");
  CLI11_PARSE(app, argc, argv);
  try {
    if (*verify_command) return verify();
    if (*make_command) make(seed, stratum, sets, shots, dir);
    if (*run_command) run_sets(dir, hosel, jobs, limit);
    if (*score_command) score_sets(dir);
    if (*records_command) {
      make_records(seed, sets, dir);
      run_sets(dir, hosel, jobs, limit);
      score_records(dir);
    }
    if (*all_command) {
      for (const auto& [name, full] : strata())
        make(seed, name, std::max(1, static_cast<int>(std::lround(scale * full))), shots, dir);
      run_sets(dir, hosel, jobs, limit);
      score_sets(dir);
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "examination: {}\n", e.what());
    return 2;
  }
}
