// The shaft meets the head elsewhere than declared.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> hosel_place(const Setting& setting) {
  if (!setting.full_club) return {};
  const auto along = [](int axis, const char* name, const char* what) {
    Parametrisation f{.what = what, .parameters = {{name, "mm", 1e-3, -0.04, 0.04, 4e-3}}};
    f.before = [axis](Sizes p, Shot& s) { s.blow.club.geometry.hosel[axis] += p[0]; };
    return f;
  };
  Parametrisation out = along(0, "shift_out", "out of the face");
  out.complexity = 3;
  return {along(1, "shift_heel", "towards the heel"), along(2, "shift_up", "up"), out};
}

}  // namespace hosel::loop::forms
