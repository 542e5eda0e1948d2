// The head's effective mass differs from the declared one.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> head_mass(const Setting&) {
  // Usual: assumed, heads of one kind within some grams, and what of the shaft's tip goes with them.
  return {{.what = "added mass at the centre of gravity",
           .parameters = {Parameter{"added_mass", "g", 1e-3, -0.08, 0.1, 5e-3}.within(0.012)},
           .before = [](Sizes p, Shot& t) { t.blow.club.head.mass += p[0]; }}};
}

}  // namespace hosel::loop::forms
