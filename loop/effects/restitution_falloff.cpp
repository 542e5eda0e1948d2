// Restitution drops away from the face centre.
#include <cmath>

#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> restitution_falloff(const Setting& setting) {
  if (setting.deformable) return {};  // has no impact law
  // 100 / m^2 is a loss of 0.04 at 20 mm. Usual: assumed, twice that.
  const auto square = [](const char* axis) { return Parameter{axis, "1/m^2", 1, -60, 900, 50}.within(200); };
  Parametrisation round{.what = "with the square of the distance", .parameters = {square("falloff")}};
  round.before = [](Sizes p, Shot& t) { t.blow.contact.restitution_falloff += p[0]; };
  Parametrisation oval{.what = "with the squares of toe and high offset",
                       .parameters = {square("falloff_toe"), square("falloff_high")}};
  oval.before = [](Sizes p, Shot& t) {
    const Delivery& d = t.blow.delivery;
    t.blow.contact.restitution -= p[0] * d.impact_toe * d.impact_toe + p[1] * d.impact_high * d.impact_high;
  };
  Parametrisation cone{.what = "with the distance",
                       .parameters = {Parameter{"falloff_per_distance", "1/m", 1, -1, 12, 1}.within(4)}};
  cone.before = [](Sizes p, Shot& t) {
    t.blow.contact.restitution -= p[0] * std::hypot(t.blow.delivery.impact_toe, t.blow.delivery.impact_high);
  };
  return {round, oval, cone};
}

}  // namespace hosel::loop::forms
