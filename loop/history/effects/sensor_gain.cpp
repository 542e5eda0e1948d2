// A channel shows a multiple of what is.
#include <fmt/format.h>

#include "hosel/loop/history/effects/all.hpp"

namespace hosel::loop::history_forms {

std::vector<HistoryForm> sensor_gain(const HistorySetting& setting) {
  const Parameter gain{"gain_error", "1", 1, -0.6, 1.5, 0.01};
  std::vector<HistoryForm> forms;
  const std::size_t n = setting.channels.size();
  if (setting.driven && n > 1) {
    HistoryForm all{{.effect = "sensor-gain", .what = "of all channels alike", .parameters = {gain}}, {}};
    all.apply = [](std::span<const double> p, Rig& r) {
      for (double& g : r.gain) g += p[0];
    };
    forms.push_back(all);
  }
  if (setting.driven || n > 1)
    for (std::size_t c = 0; c < n; ++c) {
      HistoryForm one{
          {.effect = "sensor-gain", .what = fmt::format("of {}", setting.channels[c].name), .parameters = {gain}}, {}};
      one.apply = [c](std::span<const double> p, Rig& r) { r.gain[c] += p[0]; };
      forms.push_back(one);
    }
  return forms;
}

}  // namespace hosel::loop::history_forms
