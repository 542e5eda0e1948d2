// The recorded loft is not the loft that the ball met.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> loft_bias(const Setting&) {
  const Parameter offset{"offset", "deg", kRadPerDeg, radians(-8), radians(8), radians(0.5)};
  const Parameter gain{"gain", "1", 1, -0.3, 0.3, 0.03};
  Parametrisation constant{.effect = "loft-bias", .what = "constant", .parameters = {offset}};
  constant.before = [](std::span<const double> p, Shot& t) { t.blow.delivery.dynamic_loft += p[0]; };
  Parametrisation scale{.effect = "loft-bias", .what = "in proportion to the loft", .parameters = {gain}};
  scale.before = [](std::span<const double> p, Shot& t) { t.blow.delivery.dynamic_loft *= 1 + p[0]; };
  Parametrisation line{
      .effect = "loft-bias", .what = "constant and in proportion to the loft", .parameters = {offset, gain}};
  line.before = [](std::span<const double> p, Shot& t) {
    t.blow.delivery.dynamic_loft += p[0] + p[1] * t.blow.delivery.dynamic_loft;
  };
  return {constant, scale, line};
}

}  // namespace hosel::loop::forms
