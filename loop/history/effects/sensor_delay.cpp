// A channel shows what was a moment ago.
#include <fmt/format.h>

#include "hosel/loop/history/effects/all.hpp"

namespace hosel::loop::history_forms {

std::vector<HistoryForm> sensor_delay(const HistorySetting& setting) {
  const double limit = 0.05;
  const Parameter delay{"delay", "ms", 1e-3, -limit, limit, 2e-4};
  std::vector<HistoryForm> forms;
  const std::size_t n = setting.channels.size();
  // Where the start is unknown a common delay only moves the start.
  if (setting.driven && n > 1) {
    HistoryForm all{{.effect = "sensor-delay",
                     .what = "of all channels alike",
                     .parameters = {delay},
                     .starts = {{-0.005}, {0.005}}},
                    {}};
    all.apply = [](std::span<const double> p, Rig& r) {
      for (double& d : r.delay) d += p[0];
    };
    forms.push_back(all);
  }
  if (setting.driven || n > 1)
    for (std::size_t c = 0; c < n; ++c) {
      HistoryForm one{{.effect = "sensor-delay",
                       .what = fmt::format("of {}", setting.channels[c].name),
                       .parameters = {delay},
                       .starts = {{-0.005}, {0.005}}},
                      {}};
      one.apply = [c](std::span<const double> p, Rig& r) { r.delay[c] += p[0]; };
      forms.push_back(one);
    }
  return forms;
}

}  // namespace hosel::loop::history_forms
