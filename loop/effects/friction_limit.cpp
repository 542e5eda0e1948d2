// Coulomb friction cannot give the tangential impulse that rolling asks for: the ball slides throughout.
#include <algorithm>
#include <cmath>

#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Form> friction_limit(const Setting&) {
  // 1 / mu, so that zero is the base model; 12 is mu = 0.083, a wet face.
  const Parameter slipperiness{"inverse_friction", "1", 1, 0, 12, 0.5};
  const std::vector<std::vector<double>> starts = {{1.5}, {2}, {2.5}, {3}, {3.5}, {4}, {4.5}, {5}, {6}, {7}, {8.5}, {10}};
  Form coulomb{.effect = "friction-limit", .what = "Coulomb limit of the impulse", .parameters = {slipperiness}, .starts = starts};
  coulomb.before = [](std::span<const double> p, Trial& t) {
    if (p[0] > 0) t.blow.contact.friction = std::min(t.blow.contact.friction, 1 / p[0]);
  };
  return {coulomb};
}

}  // namespace hosel::loop::forms
