/// Keys and quantities as people read them: `club_speed_mph` is "club speed [mph]".
#pragma once

#include <string>
#include <string_view>

namespace hosel::post {

/// "club_speed" -> "club speed".
std::string spoken(std::string_view name);
/// "1 shot", "2 shots".
std::string counted(std::size_t n, std::string_view what);
/// A unit's suffix as it is printed: "mps" -> "m/s", "kg_m2" -> "kg m²".
std::string symbol(std::string_view unit);
/// A key's words and its unit as it is printed: "falloff_per_m2" -> "falloff", "1/m²". No unit: empty.
struct SpokenKey {
  std::string words, unit;
};
SpokenKey spoken_key(std::string_view key);
/// Name and unit of a key, dotted or not; the tables before a dotted one are left out.
std::string label(std::string_view key);

}  // namespace hosel::post
