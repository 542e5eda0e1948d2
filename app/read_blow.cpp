#include "hosel/app/read_blow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hosel/app/read_shaft.hpp"
#include "hosel/models/registry.hpp"

namespace hosel::app {
namespace {
constexpr double kInf = std::numeric_limits<double>::infinity();
}

Ball read_ball(Table table) {
  const Ball standard;
  Ball ball;
  ball.mass = table.quantity("mass", "kg", {1e-6, 1.0}, standard.mass);
  ball.radius = table.quantity("radius", "mm", {1e-3, 0.1}, standard.radius);
  ball.inertia_factor = table.number("inertia_factor", {0.05, 0.6667}, standard.inertia_factor);
  return ball;
}

Head read_head(Table table, bool whole) {
  Head head;
  head.mass = table.quantity("mass", "kg", {0, kInf, true});
  head.face.bulge = table.quantity("bulge", "mm", {0.01, kInf}, kInf);
  head.face.roll = table.quantity("roll", "mm", {0.01, kInf}, kInf);
  const bool needed = whole && std::isfinite(head.mass);
  const bool given = table.has_quantity("inertia") || table.has_quantity("cg");
  if (!needed && !given) {
    if (std::isfinite(head.mass)) head.inertia = kInf * Mat3::Identity();
    return head;
  }
  head.cg = table.vector("cg", "mm");
  head.inertia = table.matrix("inertia", "kg_m2");
  if (const auto faults = head.faults(); !faults.empty()) {
    for (const std::string& key : table.keys())
      if (key.starts_with("inertia")) table.fail(key, faults.front());
  }
  return head;
}

Delivery read_delivery(Table table) {
  constexpr double right_angle = kPi / 2;
  Delivery d;
  d.club_speed = table.quantity("club_speed", "mps", {0, 150, true});
  d.attack_angle = table.quantity("attack_angle", "deg", {-right_angle, right_angle}, 0);
  d.club_path = table.quantity("club_path", "deg", {-right_angle, right_angle}, 0);
  d.dynamic_loft = table.quantity("dynamic_loft", "deg", {-right_angle, right_angle}, 0);
  d.face_angle = table.quantity("face_angle", "deg", {-right_angle, right_angle}, 0);
  d.impact_toe = table.quantity("impact_toe", "mm", {-0.1, 0.1}, 0);
  d.impact_high = table.quantity("impact_high", "mm", {-0.1, 0.1}, 0);
  d.head_angular_velocity = table.vector("head_angular_velocity", "rad_per_s", Vec3::Zero());
  return d;
}

ContactLaw read_contact_law(Table table) {
  const ContactLaw standard;
  ContactLaw law;
  law.restitution = table.number("restitution", {0, 1.5}, standard.restitution);
  law.restitution_slope = table.quantity("restitution_slope", "s_per_m", {-0.1, 0.1}, standard.restitution_slope);
  law.restitution_falloff = table.number("restitution_falloff_per_m2", {-1e4, 1e4}, standard.restitution_falloff);
  law.tangential_restitution = table.number("tangential_restitution", {-1, 1}, standard.tangential_restitution);
  law.friction = table.number("friction", {0, kInf}, standard.friction);
  law.normal_force_offset = table.number("normal_force_offset", {-0.5, 0.5}, standard.normal_force_offset);
  return law;
}

std::vector<std::string> read_models(Table root) {
  std::vector<std::string> known;
  for (const auto& m : models::registry()) known.emplace_back(m.name);
  std::vector<std::string> wanted = root.texts("models");
  if (wanted.empty()) root.fail("models", "name at least one model");
  for (const std::string& m : wanted)
    if (!models::find(m)) {
      const std::string near = nearest(m, known);
      root.fail("models", near.empty() ? fmt::format("no model '{}'; `hosel list` shows them", m)
                                       : fmt::format("no model '{}'; did you mean '{}'?", m, near));
    }
  return wanted;
}

Blow read_blow(Table root, const std::vector<std::string>& models) {
  Blow blow;
  blow.ball = root.has("ball") ? read_ball(root.table("ball")) : Ball{};
  const bool whole = std::ranges::any_of(models, [](const std::string& m) { return m != "rigid-planar"; });
  blow.club.head = read_head(root.table("head"), whole);
  blow.delivery = read_delivery(root.table("delivery"));
  if (auto shaft = root.optional_table("shaft")) blow.club.shaft = read_shaft(*shaft);
  if (auto hosel = root.optional_table("hosel")) blow.club.geometry = read_club_geometry(*hosel);
  if (auto contact = root.optional_table("contact")) blow.contact = read_contact_law(*contact);
  return blow;
}

}  // namespace hosel::app
