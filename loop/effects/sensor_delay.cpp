// A channel shows what was a moment ago.
#include "loop/effects/all.hpp"
#include "loop/effects/per_channel.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> sensor_delay(const HistorySetting& setting) {
  const Parametrisation one{.parameters = {{"delay", "ms", 1e-3, -0.05, 0.05, 2e-4}}, .starts = {{-0.005}, {0.005}}};
  return per_channel(setting, one, &TestSetup::delay);
}

}  // namespace hosel::loop::forms
