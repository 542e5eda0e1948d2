#include "app/import/carry_ratio.hpp"

#include <cmath>

#include "app/import/cells.hpp"
#include "golf/units.hpp"
#include "loop/deviation.hpp"
#include "models/flight/flight.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

/// A blow's carry by the default law, in calm air at sea level [m].
double carry_of(double speed, double launch, double spin) {
  Launch l;
  l.velocity = speed * Vec3(std::cos(launch), 0, std::sin(launch));
  l.spin = Vec3(0, -spin, 0);
  return models::fly(l, {}, {}).carry;
}

}  // namespace

std::optional<double> carry_ratio(const Numbers& speed, const Numbers& launch, const Numbers& spin,
                                  const Numbers& carry) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < speed.value.size() && ratios.size() < 25; ++i) {
    const double v = speed.si * speed.value[i], a = launch.si * launch.value[i];
    if (!(v > 3 && v < 150 && a > 0.03 && a < 1.2 && carry.value[i] > 0)) continue;
    const double rate = spin.value[i] > 0 ? spin.si * spin.value[i] : 5000 * si_of("rpm");
    try {
      if (const double x = carry_of(v, a, rate); x > 0) ratios.push_back(carry.si * carry.value[i] / x);
    } catch (const solvers::NonConvergence&) {}  // no flight that ends: another shot tells
  }
  return ratios.empty() ? std::nullopt : std::optional(loop::median(ratios));
}

}  // namespace hosel::app
