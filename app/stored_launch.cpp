#include "app/stored_launch.hpp"

#include <nlohmann/json.hpp>

namespace hosel::app {
namespace {

using nlohmann::json;

json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

Vec3 vector_from(const json& j) { return Vec3(j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()); }

json stored(const Launch& l) {
  json out = {{"velocity", list(l.velocity)},
              {"spin", list(l.spin)},
              {"head_velocity", list(l.head_velocity)},
              {"head_spin", list(l.head_spin)}};
  if (l.contact_time) out["contact_time"] = *l.contact_time;
  if (l.peak_force) out["peak_force"] = *l.peak_force;
  if (l.peak_compression) out["peak_compression"] = *l.peak_compression;
  return out;
}

json stored(const models::HoselHistory& h) {
  const fem::Wrench impulse = h.impulse();
  json out = {{"impulse", {list(impulse.force), list(impulse.moment)}}};
  for (std::size_t i = 0; i < h.times.size(); ++i)
    out["history"].push_back({h.times[i], list(h.loads[i].force), list(h.loads[i].moment)});
  return out;
}

std::optional<Launch> launch_from(const json& j) {
  if (j.contains("error")) return {};
  Launch l;
  l.velocity = vector_from(j.at("velocity"));
  l.spin = vector_from(j.at("spin"));
  l.head_velocity = vector_from(j.at("head_velocity"));
  l.head_spin = vector_from(j.at("head_spin"));
  if (j.contains("contact_time")) l.contact_time = j["contact_time"].get<double>();
  if (j.contains("peak_force")) l.peak_force = j["peak_force"].get<double>();
  if (j.contains("peak_compression")) l.peak_compression = j["peak_compression"].get<double>();
  return l;
}

}  // namespace hosel::app
