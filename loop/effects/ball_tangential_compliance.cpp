// The ball winds up tangentially and gives part of it back: the surfaces part with -e_t times their slip.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> ball_tangential_compliance(const Setting& setting) {
  if (setting.deformable) return {};  // what its ball does by itself
  // Usual: balls on a hard surface give back 0.2 to 0.3 [@cross-bounce].
  const Parameter level = Parameter{"tangential_restitution", "1", 1, -0.3, 0.8, 0.1}.within(0.25);
  const Parameter slope = Parameter{"tangential_restitution_slope", "s/m", 1, -0.02, 0.02, 0.002}.within(0.005);
  Parametrisation constant{.what = "constant tangential restitution", .parameters = {level}};
  constant.before = [](Sizes p, Shot& t) { t.blow.contact.tangential_restitution += p[0]; };
  // The slope is about 40 m/s, so that level and slope are nearly independent over usual club speeds.
  Parametrisation speed{.what = "tangential restitution, linear in the club speed about 40 m/s",
                        .parameters = {level, slope}};
  speed.before = [](Sizes p, Shot& t) {
    t.blow.contact.tangential_restitution += p[0] + p[1] * (t.blow.delivery.club_speed - 40.0);
  };
  return {constant, speed};
}

}  // namespace hosel::loop::forms
