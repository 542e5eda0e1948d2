// A finite-element blow, watched step by step: how the contact force rises and falls, and where the energy is.
// The mesh is far too coarse for figures and quick enough for a look.
#include <cmath>
#include <cstdio>

#include "golf/units.hpp"
#include "models/fe/impact.hpp"

int main() {
  using namespace hosel;
  Blow blow;
  blow.club.head = {.mass = 0.2, .cg = {-0.03, 0.0, 0.0}, .inertia = Vec3(2.8e-4, 4.1e-4, 5.7e-4).asDiagonal()};
  blow.delivery = {.club_speed = 45, .dynamic_loft = radians(11)};

  models::FeImpactOptions options;
  options.harmonics = 2;
  options.mesh = {.sector = 2, .rings = 2, .pole = 0.5, .skin = 0.6, .core = 0.4};
  options.penalty = 200;
  options.steps_per_contact = 30;

  double largest = 0, end = 0;
  const models::FeOutcome out = models::Impact(options).run(blow, [&](const models::ImpactView& now) {
    largest = std::max(largest, now.report.normal_force);
    end = now.state.time;
    std::printf("%.3f ms  %8.0f N  patch %5.1f mm2\n", 1e3 * now.state.time, now.report.normal_force,
                1e6 * now.report.area);
  });
  std::printf("ball speed %.1f m/s, backspin %.0f rpm, contact %.2f ms, energy ledger closes to %.1e\n",
              out.launch.ball_speed(), rpm(out.launch.backspin()), 1e3 * out.result.contact_time,
              std::abs(out.result.ledger.closure) / out.result.ledger.initial);
  return largest > 5e3 && out.result.contact_time < end && out.launch.backspin() > 0 ? 0 : 1;
}
