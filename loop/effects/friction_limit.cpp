// Coulomb friction cannot give the tangential impulse that rolling asks for: the ball slides throughout.
#include <algorithm>
#include <cmath>

#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> friction_limit(const Setting& setting) {
  if (setting.deformable) {  // declares a coefficient, under which its patch creeps and slips
    return {{.what = "a factor on the declared coefficient",
             .parameters = {{"log_factor_of_friction", "1", 1, -1.6, 1.0, 0.1}},
             .starts = {{-0.8}},
             .before = [](Sizes p, Shot& s) { s.blow.contact.friction *= std::exp(p[0]); }}};
  }
  // 1 / mu, so that zero is the base model; 12 is mu = 0.083, a wet face.
  const Parameter slipperiness{"inverse_friction", "1", 1, 0, 12, 0.5};
  // The limit may reach one shot alone: then only starts a few per cent apart come near it.
  std::vector<std::vector<double>> starts;
  for (double x = 1.4; x < 11.5; x *= 1.025) starts.push_back({x});
  return {{.what = "Coulomb limit of the impulse",
           .parameters = {slipperiness},
           .starts = starts,
           .threshold = true,
           .before = [](Sizes p, Shot& t) {
             if (p[0] > 0) t.blow.contact.friction = std::min(t.blow.contact.friction, 1 / p[0]);
           }}};
}

}  // namespace hosel::loop::forms
