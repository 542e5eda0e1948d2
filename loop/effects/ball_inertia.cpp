// The ball's moment of inertia is not the declared one.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> ball_inertia(const Setting& setting) {
  if (setting.deformable) return {};  // follows from its layers
  // Usual: assumed, layers that differ in density by a tenth.
  return {{.what = "inertia factor I / (m r^2)",
           .parameters = {Parameter{"change_of_inertia_factor", "1", 1, -0.15, 0.2, 0.02}.within(0.03)},
           .before = [](Sizes p, Shot& t) { t.blow.ball.inertia_factor += p[0]; }}};
}

}  // namespace hosel::loop::forms
