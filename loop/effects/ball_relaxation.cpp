// The ball's shear losses are not the declared ones, at equal normal restitution: its branches are slower or quicker,
// at the same storage and loss modulus where the contact's own frequency is.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> ball_relaxation(const Setting& setting) {
  if (!setting.deformable) return {};
  return {{.what = "one factor on the branch times",
           .parameters = {{"log_factor_of_branch_times", "1", 1, -1.5, 2.5, 0.3}},
           .complexity = 3,
           .starts = {{1.5}},
           .before = [](Sizes p, Shot& s) { s.change.relaxation += p[0]; }}};
}

}  // namespace hosel::loop::forms
