// The head's centre of gravity is not where it is declared.
#include "hosel/loop/history/effects/all.hpp"

namespace hosel::loop::history_forms {

std::vector<HistoryForm> cg_shift(const HistorySetting& setting) {
  if (!setting.head) return {};
  const auto along = [](std::vector<int> axes, const char* what, double rarity) {
    static constexpr const char* names[] = {"shift_out", "shift_heel", "shift_up"};
    HistoryForm f{{.effect = "cg-shift", .what = what, .rarity = rarity}, {}};
    for (const int a : axes) f.form.parameters.push_back({names[a], "mm", 1e-3, -0.03, 0.03, 1e-3});
    f.apply = [axes](std::span<const double> p, Rig& r) {
      for (std::size_t k = 0; k < axes.size(); ++k) r.club.cg[axes[k]] += p[k];
    };
    return f;
  };
  return {along({1}, "towards the heel", 0), along({2}, "up", 0), along({0}, "out of the face", 0),
          along({1, 2}, "in the face plane", 2)};
}

}  // namespace hosel::loop::history_forms
