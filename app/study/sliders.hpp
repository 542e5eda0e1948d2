/// What the page of a study needs to answer between its points.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/study/effects.hpp"

namespace hosel::app {

/// Parameters with their ranges, and the emulator of every answer that has one (post/viewer/sliders.js reads it); null
/// where no answer has one. Of a normal parameter the range is two standard deviations either way.
nlohmann::json sliders(const StudyTable& table, const StudyEffects& effects);

}  // namespace hosel::app
