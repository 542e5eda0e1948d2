// The cover is stiffer or softer against the core than declared: how much of the blow's shear the skin gives back.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> ball_cover_stiffness(const Setting& setting) {
  if (!setting.deformable) return {};
  const Parameter ratio{"log_factor_of_cover_moduli", "1", 1, -1.6, 1.6, 0.1};
  const Parameter thickness{"added_thickness", "mm", 1e-3, -1.2e-3, 2.5e-3, 0.2e-3};
  Parametrisation stiffness{.what = "one factor on its moduli", .parameters = {ratio}};
  stiffness.before = [](Sizes p, Shot& s) { s.change.cover_stiffness += p[0]; };
  Parametrisation both{.what = "a factor on its moduli, and its thickness",
                       .parameters = {ratio, thickness},
                       .complexity = 3,
                       .starts = {{0.5, 0}, {-0.5, 0}}};  // the thickness of a skin like the core shows nowhere
  both.before = [](Sizes p, Shot& s) {
    s.change.cover_stiffness += p[0];
    s.change.cover_thickness += p[1];
  };
  return {stiffness, both};
}

}  // namespace hosel::loop::forms
