// A shaft that is swung round is stiffened by its own pull. The bench's base is linear and has none; the swing is
// geometrically exact and has all of it, so that nothing is left to add there.
#include "hosel/loop/history/effects/all.hpp"

namespace hosel::loop::history_forms {

std::vector<HistoryForm> rotational_stiffening(const HistorySetting& setting) {
  if (!setting.turning) return {};
  HistoryForm f{{.effect = "rotational-stiffening",
                 .what = "share of the centrifugal stiffness",
                 .parameters = {{"share", "1", 1, 0, 2, 0.02}},
                 .starts = {{0.5}, {1}}},
                {}};
  f.apply = [](std::span<const double> p, Rig& r) { r.club.stiffening += p[0]; };
  return {f};
}

}  // namespace hosel::loop::history_forms
