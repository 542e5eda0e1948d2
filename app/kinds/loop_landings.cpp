#include "app/kinds/loop_landings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "post/csv.hpp"
#include "post/digits.hpp"
#include "post/scatter.hpp"
#include "post/table.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

struct LandedClub {
  std::string name;
  std::vector<double> ball_speed, launch_angle, spin_rate, carry, side;  ///< SI; of the shots that have it
  std::vector<Eigen::Vector2d> landed;                                   ///< side, carry
  std::size_t shots = 0;
};

std::string spread(const std::vector<double>& values, double unit, int digits) {
  if (values.empty()) return "-";
  double mean = 0, square = 0;
  for (const double v : values) mean += v / double(values.size());
  for (const double v : values) square += (v - mean) * (v - mean);
  std::string said = post::fixed(mean / unit, digits);
  if (values.size() == 1) return said;
  return fmt::format("{} ± {:.{}f}", said, std::sqrt(square / double(values.size() - 1)) / unit, digits);
}

}  // namespace

std::set<std::size_t> flagged_rows(const std::vector<loop::Flag>& flagged, const loop::Shots& shots) {
  std::set<std::size_t> rows;
  for (const loop::Flag& f : flagged) {
    const bool shared = std::ranges::count(shots.id, f.id) > 1;
    for (std::size_t i = 0; i < shots.rows(); ++i)
      if (shots.id[i] == f.id && (!shared || shots.line[i] == f.line)) rows.insert(i);
  }
  return rows;
}

void show_landings(Output& out, const loop::Shots& shots, const std::set<std::size_t>& left_out, const Ball& ball,
                   const models::FlightConditions& conditions, bool mirrored) {
  const loop::Column *clubs = shots.find("club"), *speed = shots.find_stem("ball_speed"),
                     *angle = shots.find_stem("launch_angle"), *spin = shots.find_stem("spin_rate");
  const bool back = spin == nullptr;  // all that the file has of the spin
  if (back) spin = shots.find_stem("backspin");
  const loop::Column *azimuth = shots.find_stem("azimuth"), *axis = shots.find_stem("spin_axis"),
                     *sidespin = shots.find_stem("sidespin");
  const auto has = [](const loop::Column* c, std::size_t i) { return c && c->numeric && std::isfinite(c->value[i]); };
  // Distances in the family of the ball's speed.
  const bool imperial = speed && speed->name.ends_with("_mph");
  const double metre = imperial ? 0.9144 : 1;
  const std::string unit = imperial ? "yd" : "m";

  std::vector<LandedClub> all;
  post::Table landings;
  landings.in_files({"shot", "club", "carry_" + unit, "side_" + unit}, "{:.2f}");
  std::size_t without = 0;
  for (std::size_t i = 0; i < shots.rows(); ++i) {
    if (left_out.contains(i)) {
      ++without;
      continue;
    }
    const std::string name = !clubs                           ? "all shots"
                             : !clubs->numeric                ? clubs->text[i]
                             : std::isfinite(clubs->value[i]) ? fmt::format("{:g}", clubs->value[i])
                                                              : "";
    auto club = std::ranges::find(all, name, &LandedClub::name);
    if (club == all.end()) club = all.insert(all.end(), LandedClub{.name = name});
    ++club->shots;
    const auto add = [&](std::vector<double>& to, const loop::Column* from) {
      if (from && std::isfinite(from->value[i])) to.push_back(from->value[i]);
    };
    add(club->ball_speed, speed);
    add(club->launch_angle, angle);
    add(club->spin_rate, spin);
    const auto launch = loop::seen_launch(shots, i);
    if (!launch) continue;
    try {
      const models::Flight f = models::fly(*launch, ball, conditions);
      if (!(f.carry > 0)) continue;  // it rolls
      const bool aside = has(azimuth, i) && (has(axis, i) || has(sidespin, i));
      club->carry.push_back(f.carry);
      if (aside) club->side.push_back(f.side), club->landed.emplace_back(f.side / metre, f.carry / metre);
      landings.add(shots.id[i], name, f.carry / metre, aside ? std::optional(f.side / metre + 0.0) : std::nullopt);
    } catch (const solvers::NonConvergence&) {  // it does not come down within a minute
    } catch (const std::invalid_argument&) {}   // it does not rise to the case's ground
  }

  post::TextTable table{.rows = {{"club", "shots", fmt::format("ball speed [{}]", imperial ? "mph" : "m/s"),
                                  "launch angle [deg]", back ? "backspin [rpm]" : "spin [rpm]",
                                  fmt::format("carry [{}]", unit), fmt::format("side [{}]", unit)}},
                        .first_width = 12,
                        .least_width = 14};
  for (const LandedClub& c : all)
    table.rows.push_back({c.name.empty() ? "(none)" : c.name, fmt::format("{}", c.shots),
                          spread(c.ball_speed, imperial ? 0.44704 : 1, 1), spread(c.launch_angle, kRadPerDeg, 1),
                          spread(c.spin_rate, 2 * kPi / 60, 0), spread(c.carry, metre, 1), spread(c.side, metre, 1)});
  out.show(table, "The clubs");
  std::string told = fmt::format(
      "Mean ± standard deviation of the shots. Carry and side are computed from the measured launches, {}, by the law "
      "{}; "
      "side to the right is positive.",
      conditions.wind.speed > 0 ? "in the case's wind" : "in calm air", conditions.law.name);
  if (without > 0)
    told += fmt::format(" {} shot{} that the loop flagged {} left out.", without, without == 1 ? "" : "s",
                        without == 1 ? "is" : "are");
  if (mirrored)
    told += " The player is left-handed and the shots are mirrored: what is called right is the player's left.";
  out.page().section("", "<p><small>" + told + "</small></p>");
  const std::size_t flew = landings.rows.size();
  if (flew == 0) return;
  out.write("landings.csv", landings.csv());

  constexpr std::size_t most_points = 400, most_clubs = 8;
  post::Figure figure{.title = "where the shots land, seen from above; ellipses: 95 % of each club's",
                      .panel_width = 560,
                      .panel_height = 620};
  post::Panel panel{.x_label = fmt::format("side, to the right [{}]", unit),
                    .y_label = fmt::format("carry [{}]", unit)};
  std::size_t drawn = 0;
  int colour = 0;
  for (LandedClub& c : all) {
    if (c.landed.empty() || ++drawn > most_clubs) continue;
    ++colour;
    const post::Scatter scatter(std::move(c.landed));
    if (flew <= most_points) {
      post::Series balls{.label = c.name, .style = "points", .colour = colour};
      for (const auto& p : scatter.at) balls.add(p.x(), p.y());
      panel.series.push_back(std::move(balls));
    }
    if (scatter.at.size() < 3) continue;
    post::Series ellipse = scatter.ellipse(0.95, flew <= most_points ? "" : c.name);
    ellipse.colour = colour;
    panel.series.push_back(std::move(ellipse));
  }
  if (panel.series.empty()) return;
  figure.panels = {std::move(panel)};
  out.draw(figure, "figures/landings");
  if (drawn > most_clubs)
    out.page().section("", fmt::format("<p><small>Of {} clubs the first {} are drawn.</small></p>", drawn, most_clubs));
}

}  // namespace hosel::app
