// Cost of the loop against the number of rows: 2,000 and 6,000 shots with a hidden tangential restitution. The time
// of the second over the first is to be at most three.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <random>

#include "loop/shots/run.hpp"
#include "models/rigid/rigid_eccentric.hpp"

namespace {
using namespace hosel;

Head driver() {
  return {
      .mass = 0.2, .cg = Vec3(-0.035, 0, 0), .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(), .face = {0.3, 0.3}};
}

post::Sheet shots(int rows) {
  post::Sheet sheet{.file = "bench",
                    .names = {"club_speed_mps", "attack_angle_deg", "club_path_deg", "face_angle_deg",
                              "dynamic_loft_deg", "impact_toe_mm", "impact_high_mm", "ball_speed_mps",
                              "launch_angle_deg", "azimuth_deg", "backspin_rpm", "sidespin_rpm"}};
  sheet.columns.resize(sheet.names.size());
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  const models::RigidEccentric model;
  for (int i = 0; i < rows; ++i) {
    Blow b;
    b.club.head = driver();
    b.delivery = {.club_speed = 45 + 3 * gauss(random),
                  .attack_angle = radians(2 * gauss(random)),
                  .club_path = radians(2 * gauss(random)),
                  .dynamic_loft = radians(14 + 3 * gauss(random)),
                  .face_angle = radians(2 * gauss(random)),
                  .impact_toe = 0.009 * gauss(random),
                  .impact_high = 0.006 * gauss(random)};
    b.contact.tangential_restitution = 0.1;
    const Delivery& d = b.delivery;
    const Launch l = model.launch(b);
    const double values[] = {d.club_speed,
                             degrees(d.attack_angle),
                             degrees(d.club_path),
                             degrees(d.face_angle),
                             degrees(d.dynamic_loft),
                             1e3 * d.impact_toe,
                             1e3 * d.impact_high,
                             l.ball_speed() + 0.25 * gauss(random),
                             degrees(l.launch_angle()) + 0.2 * gauss(random),
                             degrees(l.azimuth()) + 0.25 * gauss(random),
                             rpm(l.backspin()) + 60 * gauss(random),
                             rpm(l.sidespin()) + 60 * gauss(random)};
    for (std::size_t k = 0; k < sheet.columns.size(); ++k) sheet.columns[k].push_back(fmt::format("{:.2f}", values[k]));
    sheet.lines.push_back(std::size_t(i) + 2);
  }
  return sheet;
}

void Loop(benchmark::State& state) {
  const models::RigidEccentric model;
  loop::ShotCase c;
  c.base = "rigid-eccentric";
  c.model = &model;
  c.head_mass_declared = c.inertia_declared = true;
  c.blow.club.head = driver();
  c.shots = loop::read_shots(shots(int(state.range(0))));
  c.noise = {{"ball_speed_mps", 0.25},
             {"launch_angle_deg", 0.2},
             {"azimuth_deg", 0.25},
             {"backspin_rpm", 60},
             {"sidespin_rpm", 60}};
  for (auto _ : state) {
    const loop::LoopResult r = loop::run(c);
    if (r.adopted != std::vector<std::string>{"ball-tangential-compliance"})
      state.SkipWithError("the hidden effect was not named");
    benchmark::DoNotOptimize(r.used);
  }
}
BENCHMARK(Loop)->Arg(2000)->Arg(6000)->Unit(benchmark::kSecond)->Iterations(1)->MeasureProcessCPUTime();

}  // namespace
