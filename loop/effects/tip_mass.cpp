// More (or less) mass at the tip than declared.
#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> tip_mass(const HistorySetting& setting) {
  return {{.what = "a point mass at the hosel",
           .parameters = {{"mass", "g", 1e-3, setting.head ? -0.06 : 0.0, 0.12, 2e-3}},
           .starts = {{0.01}, {0.03}},
           .setup = [](Sizes p, TestSetup& r) { r.club.tip_mass += p[0]; }}};
}

}  // namespace hosel::loop::forms
