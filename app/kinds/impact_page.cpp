#include "app/kinds/impact_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/command_help.hpp"
#include "app/library.hpp"
#include "golf/first_contact.hpp"
#include "golf/units.hpp"
#include "models/oblique.hpp"
#include "models/reduced/face_strike.hpp"
#include "post/digits.hpp"
#include "post/energy_table.hpp"
#include "post/html.hpp"
#include "post/impact_figures.hpp"

namespace hosel::app {
namespace {

const post::LaunchColumn* find(const ImpactStory& s, std::string_view title) {
  const auto it = std::ranges::find(s.columns, title, &post::LaunchColumn::title);
  return it == s.columns.end() ? nullptr : &*it;
}

std::string bound(double error, int decimals) { return "± " + post::error_bound(error, decimals); }

/// Which side of the target a signed quantity says; what prints as zero says none.
const char* side(double x, double rounding) {
  return x < -rounding ? "left of the target" : x > rounding ? "right of the target" : "at the target";
}

/// Of a ball against a wall, in whose frame people know it: the wall of the case moves and the ball rests.
void answer_bounce(RunPage& page, const Blow& blow, const Launch& l) {
  const models::WallBounce b = models::off_wall(blow, l);
  const Vec3 wall = blow.delivery.velocity();
  page.answer("restitution", post::fixed(b.restitution(), 4), fmt::format("along the normal, at {:.2f} m/s", b.into));
  page.answer("rebound speed", fmt::format("{:.2f} m/s", (l.velocity - wall).norm()),
              fmt::format("in the wall's frame, where it struck with {:.2f} m/s", wall.norm()));
  page.answer("rebound angle", post::fixed(degrees(b.rebound_angle()), 2) + "°",
              fmt::format("from the normal; it struck at {:.2f}°", degrees(std::atan2(b.along, b.into))));
}

/// The launch in large type, in the unit of speed that the case speaks, the other beneath.
void answer(Output& out, const ImpactStory& s) {
  RunPage& page = out.page();
  const post::LaunchColumn& c = s.columns.back();
  const Launch& l = c.launch;
  const bool wall = std::isinf(s.blow.club.head.mass);
  if (wall) answer_bounce(page, s.blow, l);
  const bool mph = out.page_units() == post::Units::golf;
  const auto numerics = [&](const post::Channel* of, double si, int decimals) {
    if (!c.coarser) return std::string();
    const double apart = post::difference(*of, (l.*of->value)() / of->si, ((*c.coarser).*of->value)() / of->si);
    return bound(std::abs(apart) * of->si / si, decimals) + " by the numerics";
  };
  const auto note = [&](std::string_view channel, double si, int decimals, std::string_view unit) {
    const post::Channel* of = post::find_channel(channel);
    std::string text = numerics(of, si, decimals);
    if (const post::MeasuredValue* seen = post::find(s.measured, of))
      text += fmt::format("{}measured {:.{}f}{}", text.empty() ? "" : "; ", seen->value / si, decimals, unit);
    return text;
  };
  const double v = l.ball_speed(), in_mph = v / kMpsPerMph;
  // Its error before the other unit, which has another.
  std::string more = mph ? note("ball_speed", kMpsPerMph, 1, " mph") : note("ball_speed", 1, 2, " m/s");
  if (!more.empty()) more += "; ";
  page.answer("ball speed", mph ? fmt::format("{:.1f} mph", in_mph) : fmt::format("{:.2f} m/s", v),
              more + (mph ? fmt::format("{:.2f} m/s", v) : fmt::format("{:.1f} mph", in_mph)));
  const double club = s.blow.delivery.club_speed;
  if (std::isfinite(s.blow.club.head.mass) && club > 0)
    page.answer("smash factor", fmt::format("{:.3f}", v / club),
                mph ? fmt::format("club {:.1f} mph", club / kMpsPerMph) : fmt::format("club {:.2f} m/s", club));
  if (!wall)
    page.answer("launch angle", post::fixed(degrees(l.launch_angle()), 2) + "°",
                note("launch_angle", kRadPerDeg, 2, "°"));
  const auto beside = [](const char* word, const std::string& rest) {
    return rest.empty() ? word : word + ("; " + rest);
  };
  // Both without a sign: words say the side.
  const auto direction = [&](double radians, const char* before) {
    return fmt::format("{}{:.2f}°", before, std::abs(degrees(radians)));
  };
  const post::Channel* azimuth = post::find_channel("azimuth");
  std::string told = beside(side(degrees(l.azimuth()), 0.005), numerics(azimuth, kRadPerDeg, 2));
  if (const post::MeasuredValue* seen = post::find(s.measured, azimuth))
    told += direction(seen->value, "; measured ") + " " + side(degrees(seen->value), 0.005);
  if (!wall) page.answer("direction", direction(l.azimuth(), ""), told);
  page.answer("spin", fmt::format("{:.0f} rpm", rpm(l.spin_rate())), note("spin_rate", kRadPerSecPerRpm, 0, " rpm"));
  const double axis = degrees(l.spin_axis());
  if (!wall && rpm(l.spin_rate()) > 0.5)
    page.answer("spin axis", post::fixed(axis, 1) + "°",
                beside(axis < -0.05  ? "a draw"
                       : axis > 0.05 ? "a fade"
                                     : "level",
                       note("spin_axis", kRadPerDeg, 1, "°")));
  if (!c.flight) return;
  for (const post::FlightChannel& f : post::flight_channels(c.flight->unit))
    if (const auto x = f.value(*c.flight); x && (f.name == "carry" || f.name == "total" || f.name == "side")) {
      const auto coarser = c.coarser_flight ? f.value(*c.coarser_flight) : std::nullopt;
      const std::string off = coarser ? bound(std::abs(*x - *coarser) / f.si, 1) + " by the numerics" : "",
                        size = fmt::format("{:.1f} {}", (f.name == "side" ? std::abs(*x) : *x) / f.si, f.unit);
      page.answer(std::string(f.name), size, f.name == "side" ? beside(side(*x / f.si, 0.05), off) : off);
    }
}

post::TextTable solution(const std::vector<FeRun>& runs) {
  post::TextTable t{.rows = {{""}}};
  for (const FeRun& r : runs) t.rows[0].push_back(r.model);
  const auto row = [&](const char* name, auto value) {
    auto& cells = t.rows.emplace_back(1, name);
    for (const FeRun& r : runs) cells.push_back(value(r.result));
  };
  using R = models::FeImpactResult;
  row("contact [ms]", [](const R& r) { return fmt::format("{:.4f}", 1e3 * r.contact_time); });
  row("largest force [kN]", [](const R& r) { return fmt::format("{:.3f}", 1e-3 * r.peak_force); });
  row("compression [mm]", [](const R& r) { return fmt::format("{:.2f}", 1e3 * r.compression); });
  row("penetration of the face [µm]", [](const R& r) { return fmt::format("{:.1f}", 1e6 * r.penetration); });
  row("time steps", [](const R& r) { return fmt::format("{}", r.counts.steps); });
  row("worst residual accepted, of the forces",
      [](const R& r) { return fmt::format("{:.1e}", r.counts.worst_residual); });
  return t;
}

post::TextTable ledger(const std::vector<FeRun>& runs) {
  std::vector<std::pair<std::string, solvers::Ledger>> all;
  for (const FeRun& r : runs) all.emplace_back(r.model, r.result.ledger);
  return post::energy_table(all, post::EnergyOf::blow);
}

void suggest(Output& out, const ImpactStory& s) {
  RunPage& page = out.page();
  const std::string here = shell_word(out.directory().string()),
                    again = "hosel run " + shell_word((out.directory() / "case.resolved.toml").string());
  const bool fe = !s.runs.empty(), wall = std::isinf(s.blow.club.head.mass);
  if (fe && out.resolved_case().find("accuracy = \"look\"") != std::string::npos)
    page.suggest(
        "A finer answer, with the numerical error of every number (some ten times as long):",
        again + " --set accuracy=default --set error_estimate=true --out " + beside_out(out.directory(), "finer"));
  if (!s.yields && !wall && asks_face(s.columns.back().title) && models::wants_yielding_face(s.blow.club.head))
    page.suggest("A face that yields, as a modern driver's does:",
                 again + " --set face.name=modern-driver --out " + beside_out(out.directory(), "yielding"));
  if (!s.flies && !wall)
    page.suggest("How far the ball goes:",
                 again + " --set flight.law=ferguson-2022 --out " + beside_out(out.directory(), "flight"));
  if (!wall)
    page.suggest("The same blow 10 mm nearer the toe, and what that changes:",
                 again + fmt::format(" --set delivery.impact_toe_mm={0:g} --out {2}\nhosel diff {1} {2}",
                                     1e3 * s.blow.delivery.impact_toe + 10, here, beside_out(out.directory(), "toe")));
  if (fe && s.vtk) page.suggest("Ball, patch and club in ParaView, frame by frame:", "hosel open " + here);
}

}  // namespace

std::string shaft_sentence(const ImpactStory& s, post::Units units) {
  const post::LaunchColumn *club = find(s, "fe-full-club"), *head = find(s, "fe-free-body");
  if (!club || !head) return {};
  std::vector<std::string> parts;
  // The error of a difference is how far it moves with the numerics of both: they have most of theirs in common.
  const auto add = [&](double change, std::optional<double> coarser, int decimals, std::string_view what) {
    const std::string error = coarser ? " " + bound(std::abs(change - *coarser), decimals) : "";
    parts.push_back(post::fixed(change, decimals, true) + fmt::format("{} {}", error, what));
  };
  const auto of_launch = [&](double (Launch::*of)() const, double si, int decimals, std::string_view what) {
    const auto change = [&](const Launch& a, const Launch& b) { return ((a.*of)() - (b.*of)()) / si; };
    add(change(club->launch, head->launch),
        club->coarser && head->coarser ? std::optional(change(*club->coarser, *head->coarser)) : std::nullopt, decimals,
        what);
  };
  if (units == post::Units::golf) of_launch(&Launch::ball_speed, kMpsPerMph, 2, "mph of ball speed");
  else of_launch(&Launch::ball_speed, 1, 2, "m/s of ball speed");
  if (!s.matched) of_launch(&Launch::launch_angle, kRadPerDeg, 2, "deg of launch angle");
  of_launch(&Launch::backspin, kRadPerSecPerRpm, 0, "rpm of backspin");
  of_launch(&Launch::sidespin, kRadPerSecPerRpm, 0, "rpm of sidespin");
  if (club->flight && head->flight)
    for (const post::FlightChannel& f : post::flight_channels(club->flight->unit)) {
      if (f.name != "carry") continue;
      const auto change = [&](const auto& a, const auto& b) {
        const auto x = a ? f.value(*a) : std::nullopt, y = b ? f.value(*b) : std::nullopt;
        return x && y ? std::optional((*x - *y) / f.si) : std::nullopt;
      };
      if (const auto carried = change(club->flight, head->flight))
        add(*carried, change(club->coarser_flight, head->coarser_flight), 1, fmt::format("{} of carry", f.unit));
    }
  return fmt::format("The shaft changes this blow by {}{}.", fmt::join(parts, ", "),
                     s.matched ? " at the same launch angle" : "");
}

void show_shaft(Output& out, const ImpactStory& s) {
  if (const std::string effect = shaft_sentence(s, out.units()); !effect.empty())
    out.page().section(
        "", fmt::format("<p class='verdict good'><b>The shaft</b><span>{}</span></p>", post::escape_html(effect)));
}

void show_impact(Output& out, const ImpactStory& s) {
  RunPage& page = out.page();
  answer(out, s);
  const bool wall = std::isinf(s.blow.club.head.mass);
  page.section(
      "The launch",
      fmt::format("<p class='soft'>The numbers above are those of {}.{}</p>", post::escape_html(s.columns.back().title),
                  wall ? " In the table the ball rests before the blow and the wall moves." : "") +
          s.table.html());
  if (!s.runs.empty()) {
    page.section("While the ball touches the face", "");
    const FeRun& r = s.runs.back();
    page.moving(r.model + ": the ball on the face, to scale; the face as it yields.", post::json_for_viewer(r.moving));
    if (r.section)
      page.figure(fmt::format("{}: the ball cut open in the plane of slip at the largest force, {:.2f} kN after "
                              "{:.3f} ms, and the face behind it; the target is to the right.",
                              r.model, 1e-3 * r.result.peak_force, 1e3 * r.result.peak_time),
                  post::svg(*r.section));
    page.figure(r.model + ": force of the face on the ball", post::force_svg(r.home / "history.csv"));
    page.figure(r.model + ": where the energy is", post::energy_svg(r.home / "history.csv"));
    for (const FeRun& one : s.runs)
      if (one.patch)
        out.draw(post::patch_figure(*one.patch, one.model),
                 std::filesystem::relative(one.home / "patch", out.directory()).string(), &one == &r);
    const bool estimated = std::ranges::any_of(s.columns, [](const auto& c) { return c.coarser.has_value(); });
    page.section("How well it was solved", solution(s.runs).html());
    page.section("", estimated
                         ? "<p><small>± in the table of the launch: what a coarser mesh, fewer harmonics and half "
                           "the steps change, an upper bound where both converge.</small></p>"
                         : "<p><small>No numerical error was estimated. With <code>accuracy</code> "
                           "<code>default</code> or <code>reference</code>, <code>error_estimate = true</code> runs "
                           "a coarser companion. <code>look</code> has none.</small></p>");
    page.section("Where the energy went", ledger(s.runs).html());
  }
  suggest(out, s);
}

}  // namespace hosel::app
