// A channel's zero is not zero. Where the start is unknown so are the zeros, and the fit has them anyway.
#include <fmt/format.h>

#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> sensor_offset(const HistorySetting& setting) {
  if (!setting.driven) return {};
  std::vector<Parametrisation> forms;
  for (std::size_t c = 0; c < setting.channels.size(); ++c) {
    const HistoryChannel& channel = setting.channels[c];
    // Plausible: a hundred noise units; the scale is the noise, since channels have their own units.
    const double unit = channel.noise * channel.si;
    Parametrisation one{.what = fmt::format("of {}", channel.name),
                        .parameters = {{"offset", channel.name.substr(channel.name.rfind('_') + 1), channel.si,
                                        -100 * unit, 100 * unit, 0.1 * unit}}};
    one.setup = [c](Sizes p, TestSetup& r) { r.offset[c] += p[0]; };
    forms.push_back(one);
  }
  return forms;
}

}  // namespace hosel::loop::forms
