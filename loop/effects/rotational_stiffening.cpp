// A shaft that is swung round is stiffened by its own pull. The bench's base is linear and has none; the swing is
// geometrically exact and has all of it, so that nothing is left to add there.
#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> rotational_stiffening(const HistorySetting& setting) {
  if (!setting.turning) return {};
  return {{.what = "share of the centrifugal stiffness",
           .parameters = {{"share", "1", 1, 0, 2, 0.02}},
           .starts = {{0.5}, {1}},
           .setup = [](Sizes p, TestSetup& r) { r.club.stiffening += p[0]; }}};
}

}  // namespace hosel::loop::forms
