#pragma once
// Units in SI.

#include <cmath>

namespace examination {

inline constexpr double deg = M_PI / 180, rpm = M_PI / 30, mph = 0.44704, kmh = 1 / 3.6;

}  // namespace examination
