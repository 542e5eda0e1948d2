// The recorded loft is not the loft that the ball met.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> loft_bias(const Setting&) {
  // Usual: assumed, a club's loft within 1 deg of its stamp and a shaft's lean as much off again.
  const Parameter offset =
      Parameter{"offset", "deg", kRadPerDeg, radians(-8), radians(8), radians(0.5)}.within(radians(2));
  const Parameter gain = Parameter{"gain", "1", 1, -0.3, 0.3, 0.03}.within(0.1);
  Parametrisation constant{.what = "constant", .parameters = {offset}};
  constant.before = [](Sizes p, Shot& t) { t.blow.delivery.dynamic_loft += p[0]; };
  Parametrisation scale{.what = "in proportion to the loft", .parameters = {gain}};
  scale.before = [](Sizes p, Shot& t) { t.blow.delivery.dynamic_loft *= 1 + p[0]; };
  Parametrisation line{.what = "constant and in proportion to the loft", .parameters = {offset, gain}};
  line.before = [](Sizes p, Shot& t) { t.blow.delivery.dynamic_loft += p[0] + p[1] * t.blow.delivery.dynamic_loft; };
  return {constant, scale, line};
}

}  // namespace hosel::loop::forms
