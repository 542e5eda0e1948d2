#include "app/kinds/impact_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/command_help.hpp"
#include "golf/units.hpp"
#include "models/reduced/face_strike.hpp"
#include "post/html.hpp"
#include "post/impact_figures.hpp"

namespace hosel::app {
namespace {

const post::LaunchColumn* find(const ImpactStory& s, std::string_view title) {
  const auto it = std::ranges::find(s.columns, title, &post::LaunchColumn::title);
  return it == s.columns.end() ? nullptr : &*it;
}

/// The launch in large type, in the unit of speed that the case speaks, the other beneath.
void answer(Output& out, const ImpactStory& s) {
  RunPage& page = out.page();
  const post::LaunchColumn& c = s.columns.back();
  const Launch& l = c.launch;
  const bool mph = out.page_units() == post::Units::golf;
  const auto note = [&](std::string_view channel, double si, int decimals, std::string_view unit) {
    const post::Channel* of = post::find_channel(channel);
    std::string text;
    if (c.coarser)
      text =
          fmt::format("± {:.{}f} by the numerics",
                      std::abs(post::difference(*of, (l.*of->value)() / of->si, ((*c.coarser).*of->value)() / of->si)) *
                          of->si / si,
                      decimals);
    if (const post::MeasuredValue* seen = post::find(s.measured, of))
      text += fmt::format("{}measured {:.{}f} {}", text.empty() ? "" : "; ", seen->value / si, decimals, unit);
    return text;
  };
  const double v = l.ball_speed(), in_mph = v / kMpsPerMph;
  std::string more = mph ? note("ball_speed", kMpsPerMph, 1, "mph") : note("ball_speed", 1, 2, "m/s");
  if (!more.empty()) more = "; " + more;
  page.answer("ball speed", mph ? fmt::format("{:.1f} mph", in_mph) : fmt::format("{:.2f} m/s", v),
              (mph ? fmt::format("{:.2f} m/s", v) : fmt::format("{:.1f} mph", in_mph)) + more);
  const double club = s.blow.delivery.club_speed;
  if (std::isfinite(s.blow.club.head.mass) && club > 0)
    page.answer("smash factor", fmt::format("{:.3f}", v / club),
                mph ? fmt::format("club {:.1f} mph", club / kMpsPerMph) : fmt::format("club {:.2f} m/s", club));
  page.answer("launch angle", fmt::format("{:.2f}°", degrees(l.launch_angle())),
              note("launch_angle", kRadPerDeg, 2, "°"));
  const auto beside = [](const char* word, const std::string& rest) {
    return rest.empty() ? word : word + ("; " + rest);
  };
  const double aside = degrees(l.azimuth());
  page.answer("direction", fmt::format("{:.2f}°", std::abs(aside)),
              beside(aside < -0.005  ? "left of the target"
                     : aside > 0.005 ? "right of the target"
                                     : "at the target",
                     note("azimuth", kRadPerDeg, 2, "°")));
  page.answer("spin", fmt::format("{:.0f} rpm", rpm(l.spin_rate())), note("spin_rate", kRadPerSecPerRpm, 0, "rpm"));
  const double axis = degrees(l.spin_axis());
  if (rpm(l.spin_rate()) > 0.5)
    page.answer("spin axis", fmt::format("{:.1f}°", axis),
                beside(axis < -0.05  ? "a draw"
                       : axis > 0.05 ? "a fade"
                                     : "level",
                       note("spin_axis", kRadPerDeg, 1, "°")));
  if (!c.flight) return;
  for (const post::FlightChannel& f : post::flight_channels(c.flight->unit))
    if (const auto x = f.value(*c.flight); x && (f.name == "carry" || f.name == "total" || f.name == "side"))
      page.answer(std::string(f.name), fmt::format("{:.1f} {}", *x / f.si, f.unit));
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
  post::TextTable t{.rows = {{"energy [J]"}}};
  for (const FeRun& r : runs) t.rows[0].push_back(r.model);
  const auto row = [&](const char* name, double solvers::Ledger::*value) {
    auto& cells = t.rows.emplace_back(1, name);
    for (const FeRun& r : runs) cells.push_back(fmt::format("{:.4f}", r.result.ledger.*value));
  };
  row("before", &solvers::Ledger::initial);
  row("of motion, after", &solvers::Ledger::kinetic);
  auto& strain = t.rows.emplace_back(1, "of strain, after");
  for (const FeRun& r : runs) strain.push_back(fmt::format("{:.4f}", r.result.ledger.strain_total()));
  row("turned into heat: ball, face, shaft, grip", &solvers::Ledger::viscous);
  row("lost in friction", &solvers::Ledger::friction);
  row("in the contact's penalty", &solvers::Ledger::contact);
  row("lost by the time scheme", &solvers::Ledger::numerical);
  row("unaccounted for", &solvers::Ledger::closure);
  return t;
}

void suggest(Output& out, const ImpactStory& s) {
  RunPage& page = out.page();
  const std::string here = shell_word(out.directory().string()),
                    again = "hosel run " + shell_word((out.directory() / "case.resolved.toml").string());
  const bool fe = !s.runs.empty();
  if (fe && out.resolved_case().find("accuracy = \"look\"") != std::string::npos)
    page.suggest("A finer answer, with the numerical error of every number (some ten times as long):",
                 again + " --set accuracy=default --set error_estimate=true --out finer");
  if (!s.yields && std::isfinite(s.blow.club.head.mass) && models::wants_yielding_face(s.blow.club.head))
    page.suggest("A face that yields, as a modern driver's does:",
                 again + " --set face.name=modern-driver --out yielding");
  if (!s.flies) page.suggest("How far the ball goes:", again + " --set flight.law=ferguson-2022 --out flight");
  page.suggest("The same blow 10 mm nearer the toe, and what that changes:",
               again + fmt::format(" --set delivery.impact_toe_mm={:g} --out toe\nhosel diff {} toe",
                                   1e3 * s.blow.delivery.impact_toe + 10, here));
  if (fe && s.vtk) page.suggest("Ball, patch and club in ParaView, frame by frame:", "hosel open " + here);
}

}  // namespace

std::string shaft_sentence(const ImpactStory& s) {
  const post::LaunchColumn *club = find(s, "fe-full-club"), *head = find(s, "fe-free-body");
  if (!club || !head) return {};
  const Launch &a = club->launch, &b = head->launch;
  std::vector<std::string> parts{fmt::format("{:+.2f} m/s of ball speed", a.ball_speed() - b.ball_speed())};
  if (!s.matched)
    parts.push_back(fmt::format("{:+.2f} deg of launch angle", degrees(a.launch_angle() - b.launch_angle())));
  parts.push_back(fmt::format("{:+.0f} rpm of backspin", rpm(a.backspin() - b.backspin())));
  parts.push_back(fmt::format("{:+.0f} rpm of sidespin", rpm(a.sidespin() - b.sidespin())));
  if (club->flight && head->flight)
    for (const post::FlightChannel& f : post::flight_channels(club->flight->unit)) {
      const auto x = f.value(*club->flight), y = f.value(*head->flight);
      if (f.name == "carry" && x && y) parts.push_back(fmt::format("{:+.1f} {} of carry", (*x - *y) / f.si, f.unit));
    }
  return fmt::format("The shaft changes this blow by {}{}.", fmt::join(parts, ", "),
                     s.matched ? " at the same launch angle" : "");
}

void show_shaft(Output& out, const ImpactStory& s) {
  if (const std::string effect = shaft_sentence(s); !effect.empty())
    out.page().section(
        "", fmt::format("<p class='verdict good'><b>The shaft</b><span>{}</span></p>", post::escape_html(effect)));
}

void show_impact(Output& out, const ImpactStory& s) {
  RunPage& page = out.page();
  answer(out, s);
  page.section("The launch", fmt::format("<p class='soft'>The numbers above are those of {}.</p>",
                                         post::escape_html(s.columns.back().title)) +
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
                         : "<p><small>No numerical error was asked for: <code>error_estimate = true</code> with "
                           "a named accuracy runs a coarser companion.</small></p>");
    page.section("Where the energy went", ledger(s.runs).html());
  }
  suggest(out, s);
}

}  // namespace hosel::app
