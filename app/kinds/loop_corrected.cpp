#include "app/kinds/loop_corrected.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <cmath>
#include <sstream>

namespace hosel::app {
namespace {

double rounded(double x) { return std::stod(fmt::format("{:.9g}", x)); }

toml::array numbers(const Vec3& v) {
  toml::array out;
  for (const double x : v) out.push_back(rounded(x));
  return out;
}

toml::table& table(toml::table& in, std::string_view key) {
  if (!in[key].is_table()) in.insert_or_assign(key, toml::table{});
  return *in[key].as_table();
}

/// A quantity under its unit, whatever unit the case had it in.
void put(toml::table& in, std::string_view stem, std::string_view unit, auto value) {
  std::vector<std::string> old;
  for (const auto& [key, node] : in)
    if (const std::string_view k = key.str(); k.starts_with(stem) && (k.size() == stem.size() || k[stem.size()] == '_'))
      old.emplace_back(k);
  for (const std::string& key : old) in.erase(key);
  in.insert_or_assign(fmt::format("{}_{}", stem, unit), std::move(value));
}

/// What the shots share: head, ball, contact, shaft.
void put_common(toml::table& root, const loop::Shot& s, const models::ChangeableFe& base) {
  const Head& head = s.blow.club.head;
  toml::table& h = table(root, "head");
  put(h, "cg", "mm", numbers(1e3 * head.cg));
  toml::array inertia;
  for (int k = 0; k < 3; ++k) inertia.push_back(numbers(head.inertia.row(k)));
  put(h, "inertia", "kg_m2", std::move(inertia));
  table(root, "contact").insert_or_assign("face_friction", rounded(s.blow.contact.friction));
  const models::FeChange& c = s.change;
  toml::table changes;
  const auto change = [&](const char* key, double value, double none) {
    if (value != none) changes.insert_or_assign(key, rounded(value));
  };
  change("cover_moduli_factor", std::exp(c.cover_stiffness), 1);
  change("added_cover_mm", 1e3 * c.cover_thickness, 0);
  change("branch_moduli_factor", std::exp(c.losses), 1);
  change("branch_times_factor", std::exp(c.relaxation), 1);
  table(root, "ball").insert_or_assign("changes", std::move(changes));  // also where none: the base's mesh has a skin
  if (const auto face = models::changed(head.compliance, c.face_compliance, head); face && c.face_compliance != 0)
    root.insert_or_assign("face", toml::table{{"effective_mass_g", rounded(1e3 * face->mass)},
                                              {"stiffness_N_per_m", rounded(face->stiffness)},
                                              {"damping_N_s_per_m", rounded(face->damping)},
                                              {"half_width_mm", rounded(1e3 * face->half_width)},
                                              {"half_height_mm", rounded(1e3 * face->half_height)}});
  const double share = base.share(c);
  if (share == 0) {
    for (const char* key : {"shaft", "hosel", "grip"}) root.erase(key);
    return;
  }
  toml::table& shaft = table(root, "shaft");
  const auto scale = [&](const char* key, double factor) {
    if (factor != 1) shaft.insert_or_assign(key, rounded(factor * shaft[key].value_or(1.0)));
  };
  scale("bending_scale", share * std::exp(c.shaft_stiffness));
  scale("torsion_scale", share * std::exp(c.shaft_stiffness));
  scale("mass_scale", share);
  put(table(root, "hosel"), "position", "mm", numbers(1e3 * s.blow.club.geometry.hosel));
}

toml::table variant(const loop::Corrected::Asked& asked) {
  const Delivery& d = asked.shot.blow.delivery;
  const Vec3& w = d.head_angular_velocity;
  toml::array set;
  for (const auto& [key, value] : {std::pair{"head.mass_kg", asked.shot.blow.club.head.mass},
                                   {"delivery.club_speed_mps", d.club_speed},
                                   {"delivery.attack_angle_deg", degrees(d.attack_angle)},
                                   {"delivery.club_path_deg", degrees(d.club_path)},
                                   {"delivery.dynamic_loft_deg", degrees(d.dynamic_loft)},
                                   {"delivery.face_angle_deg", degrees(d.face_angle)},
                                   {"delivery.impact_toe_mm", 1e3 * d.impact_toe},
                                   {"delivery.impact_high_mm", 1e3 * d.impact_high}})
    set.push_back(fmt::format("{}={:.9g}", key, value));
  if (!w.isZero(0))
    set.push_back(fmt::format("delivery.head_angular_velocity_rad_per_s=[{:.9g}, {:.9g}, {:.9g}]", w[0], w[1], w[2]));
  toml::table measured;
  const auto seen = [&](hosel::Output o) {
    const auto at = asked.measured.find(o);
    return at == asked.measured.end() ? NAN : at->second;
  };
  double spin = seen(hosel::Output::spin_rate);
  if (!std::isfinite(spin)) spin = std::hypot(seen(hosel::Output::backspin), seen(hosel::Output::sidespin));
  for (const auto& [key, value] : {std::pair{"launch_angle_deg", degrees(seen(hosel::Output::launch_angle))},
                                   {"spin_rate_rpm", rpm(spin)},
                                   {"ball_speed_mps", seen(hosel::Output::ball_speed)}})
    if (std::isfinite(value)) measured.insert_or_assign(key, rounded(value));
  toml::table out{{"name", "shot " + asked.id}, {"set", std::move(set)}};
  if (!measured.empty()) out.insert_or_assign("measured", std::move(measured));
  return out;
}

}  // namespace

void write_corrected(Output& out, const loop::LoopResult& result, const models::ChangeableFe& base, bool loft_unknown) {
  const loop::Corrected& corrected = *result.corrected;
  if (corrected.shots.empty()) return;
  const loop::Shot& first = corrected.shots.front().shot;
  toml::table root = toml::parse(out.resolved_case());
  for (const char* key : {"model", "data", "split"}) root.erase(key);
  root.insert_or_assign("kind", "study");
  root.insert_or_assign("title", result.title + ", corrected");
  root.insert_or_assign("models", toml::array{base.share(first.change) == 0 ? "fe-free-body" : "fe-full-club"});
  toml::array outputs{"ball_speed_mps", "launch_angle_deg", "spin_rate_rpm"};
  if (loft_unknown) outputs.push_back("dynamic_loft_deg");
  root.insert_or_assign("outputs", std::move(outputs));
  if (loft_unknown) root.insert_or_assign("matched_launch", true);
  put_common(root, first, base);
  put(table(root, "head"), "mass", "kg", rounded(first.blow.club.head.mass));
  put(table(root, "delivery"), "club_speed", "mps", rounded(first.blow.delivery.club_speed));
  toml::array variants;
  for (const loop::Corrected::Asked& asked : corrected.shots) variants.push_back(variant(asked));
  root.insert_or_assign("variant", std::move(variants));
  std::ostringstream text;
  text << fmt::format("# {} with {} in it, as the loop found it; each variant is a measured shot.\n", result.base,
                      result.adopted.empty() && result.ties.empty() ? "nothing" : "the effects of the report");
  if (!corrected.instrument.empty())
    text << fmt::format("# Not in it, since they are the instrument's: {}.\n", fmt::join(corrected.instrument, ", "));
  text << root << "\n";
  out.write("corrected/case.toml", text.str());
}

}  // namespace hosel::app
