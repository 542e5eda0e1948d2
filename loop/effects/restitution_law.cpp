// Level or speed dependence of the normal coefficient of restitution.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> restitution_law(const Setting& setting) {
  if (setting.deformable) {  // has no such law: its ball loses more or less
    return {{.what = "one factor on the branch moduli of every layer",
             .parameters = {{"log_factor_of_losses", "1", 1, -1.2, 0.8, 0.05}},
             .before = [](Sizes p, Shot& s) { s.change.losses += p[0]; }}};
  }
  // Usual: from a head that does not yield to one at the rules' limit, 0.06 [@frankly-golf]; half of it either way.
  const Parameter level = Parameter{"level", "1", 1, -0.2, 0.2, 0.02}.within(0.03);
  const Parameter slope = Parameter{"slope", "s/m", 1, -0.015, 0.015, 0.001}.within(0.003);
  Parametrisation constant{.what = "level", .parameters = {level}};
  constant.before = [](Sizes p, Shot& t) { t.blow.contact.restitution += p[0]; };
  Parametrisation tilt{.what = "slope", .parameters = {slope}};
  tilt.before = [](Sizes p, Shot& t) { t.blow.contact.restitution_slope += p[0]; };
  // The level is that at 40 m/s, so that the two parameters are nearly independent.
  Parametrisation line{.what = "level at 40 m/s and slope", .parameters = {level, slope}};
  line.before = [](Sizes p, Shot& t) {
    t.blow.contact.restitution += p[0] - 40.0 * p[1];
    t.blow.contact.restitution_slope += p[1];
  };
  return {constant, tilt, line};
}

}  // namespace hosel::loop::forms
