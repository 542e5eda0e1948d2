#pragma once

#include <fmt/format.h>

#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

/// Effects of a sensor on its channel: one form per channel, and one form with the same change in all channels. With an
/// unknown initial state, this state absorbs a change of all channels, or of the only one.
inline std::vector<Parametrisation> per_channel(const HistorySetting& setting, const Parametrisation& one,
                                                std::vector<double> TestSetup::*changed) {
  std::vector<Parametrisation> forms;
  const auto add = [&](const std::string& what, std::size_t first, std::size_t last) {
    Parametrisation f = one;
    f.what = what;
    f.setup = [=](Sizes p, TestSetup& r) {
      for (std::size_t c = first; c < last; ++c) (r.*changed)[c] += p[0];
    };
    forms.push_back(std::move(f));
  };
  const std::size_t n = setting.channels.size();
  if (setting.driven && n > 1) add("of all channels alike", 0, n);
  for (std::size_t c = 0; c < n && (setting.driven || n > 1); ++c)
    add(fmt::format("of {}", setting.channels[c].name), c, c + 1);
  return forms;
}

}  // namespace hosel::loop::forms
