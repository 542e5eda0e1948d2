// An effect of one's own, handed to the loop beside the library's: found in shots that were made with it, and named.
#include <cmath>
#include <cstdio>
#include <random>

#include "golf/units.hpp"
#include "loop/shots/run.hpp"
#include "models/rigid/rigid_eccentric.hpp"

namespace {

using hosel::loop::Parametrisation;
using hosel::loop::Shot;

/// The face gives back more the higher it is struck: one parameter, and what it changes of a declared blow.
std::vector<Parametrisation> lively_above(const hosel::loop::Setting&) {
  Parametrisation f{.what = "restitution in proportion to the height of the strike",
                    .parameters = {{"restitution_per_height", "1/m", 1, -10, 10, 0.5}}};
  f.before = [](std::span<const double> p, Shot& s) {
    s.blow.contact.restitution += p[0] * s.blow.delivery.impact_high;
  };
  return {f};
}

constexpr double kTruth = 2.5;  // 1/m

/// Ninety shots as a monitor would write them: the column's numbers as text, ball speed with 0.25 m/s of noise.
hosel::post::Sheet measured(const hosel::Blow& club) {
  hosel::post::Sheet sheet{"made here", {}, {}, {}};
  for (const char* name : {"club_speed_mps", "dynamic_loft_deg", "impact_toe_mm", "impact_high_mm", "ball_speed_mps",
                           "launch_angle_deg", "backspin_rpm"})
    sheet.names.emplace_back(name);
  sheet.columns.resize(sheet.names.size());
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  const hosel::models::RigidEccentric model;
  for (std::size_t i = 0; i < 90; ++i) {
    Shot s;
    s.blow = club;
    s.blow.delivery = {.club_speed = 45 + 3 * gauss(random),
                       .dynamic_loft = hosel::radians(14 + 3 * gauss(random)),
                       .impact_toe = 0.009 * gauss(random),
                       .impact_high = 0.007 * gauss(random)};
    const hosel::Delivery& d = s.blow.delivery;
    lively_above({}).front().before(std::vector{kTruth}, s);
    const hosel::Launch l = model.launch(s.blow);
    const double row[] = {d.club_speed,
                          hosel::degrees(d.dynamic_loft),
                          1e3 * d.impact_toe,
                          1e3 * d.impact_high,
                          l.ball_speed() + 0.25 * gauss(random),
                          hosel::degrees(l.launch_angle()) + 0.2 * gauss(random),
                          hosel::rpm(l.backspin()) + 60 * gauss(random)};
    for (std::size_t k = 0; k < sheet.columns.size(); ++k) sheet.columns[k].push_back(std::to_string(row[k]));
    sheet.lines.push_back(i + 2);
  }
  return sheet;
}

}  // namespace

int main() {
  const hosel::models::RigidEccentric base;
  hosel::loop::ShotCase c;
  c.base = "rigid-eccentric";
  c.model = &base;
  c.head_mass_declared = c.inertia_declared = true;
  c.blow.club.head = {.mass = 0.2,
                      .cg = hosel::Vec3(-0.035, 0, 0),
                      .inertia = hosel::Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(),
                      .face = {}};
  c.shots = hosel::loop::read_shots(measured(c.blow));
  c.noise = {{"ball_speed_mps", 0.25}, {"launch_angle_deg", 0.2}, {"backspin_rpm", 60}};
  c.own = {{"lively-above", "restitution rises up the face", "restitution of the bare face at several heights",
            lively_above}};
  const hosel::loop::LoopResult found = hosel::loop::run(c);
  const hosel::loop::Fit& fit = found.selection.chosen;
  std::printf("%s:", std::string(name(found.verdict)).c_str());
  for (const std::string& effect : found.adopted) std::printf(" %s", effect.c_str());
  for (Eigen::Index k = 0; k < fit.p.size(); ++k) std::printf(" %.2f", fit.p[k]);
  std::printf(" (made with %.2f)\n", kTruth);
  return found.adopted == std::vector<std::string>{"lively-above"} && std::abs(fit.p[0] - kTruth) < 0.5 ? 0 : 1;
}
