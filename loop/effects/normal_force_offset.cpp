// The resultant normal force does not pass through the ball's centre (the patch wanders while it slides).
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Form> normal_force_offset(const Setting&) {
  Form f{.effect = "normal-force-offset", .what = "offset over the ball's radius", .parameters = {{"offset", "1", 1, -0.15, 0.15, 0.01}}};
  f.before = [](std::span<const double> p, Trial& t) { t.blow.contact.normal_force_offset += p[0]; };
  return {f};
}

}  // namespace hosel::loop::forms
