// More (or less) mass at the tip than declared.
#include "hosel/loop/history/effects/all.hpp"

namespace hosel::loop::history_forms {

std::vector<HistoryForm> tip_mass(const HistorySetting& setting) {
  HistoryForm f{{.effect = "tip-mass",
                 .what = "a point mass at the hosel",
                 .parameters = {{"mass", "g", 1e-3, setting.head ? -0.06 : 0.0, 0.12, 2e-3}},
                 .starts = {{0.01}, {0.03}}},
                {}};
  f.apply = [](std::span<const double> p, Rig& r) { r.club.tip_mass += p[0]; };
  return {f};
}

}  // namespace hosel::loop::history_forms
