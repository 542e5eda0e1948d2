// A channel shows a multiple of what is.
#include "loop/effects/all.hpp"
#include "loop/effects/per_channel.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> sensor_gain(const HistorySetting& setting) {
  const Parametrisation one{.parameters = {{"gain_error", "1", 1, -0.6, 1.5, 0.01}}};
  return per_channel(setting, one, &TestSetup::gain);
}

}  // namespace hosel::loop::forms
