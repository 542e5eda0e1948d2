/// A launch as the JSON of a finished point, and back to the last bit.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "golf/launch.hpp"
#include "models/club/hosel_load.hpp"

namespace hosel::app {

nlohmann::json stored(const Launch& launch);
/// {"impulse": [force, moment], "history": rows of time [s], force [N], moment [N m]}.
nlohmann::json stored(const models::HoselHistory& hosel);
/// Nothing where the point has no answer.
std::optional<Launch> launch_from(const nlohmann::json& point);
Vec3 vector_from(const nlohmann::json& three);

}  // namespace hosel::app
