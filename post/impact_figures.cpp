#include "post/impact_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "post/csv.hpp"
#include "post/svg.hpp"
#include "solvers/peak.hpp"

namespace hosel::post {
namespace {

std::vector<double> column(const Sheet& sheet, std::string_view name, double unit) {
  const auto at = std::ranges::find(sheet.names, name);
  if (at == sheet.names.end()) throw std::invalid_argument(fmt::format("{}: no column '{}'", sheet.file, name));
  std::vector<double> out;
  for (const std::string& cell : sheet.columns[std::size_t(at - sheet.names.begin())])
    out.push_back(number(cell).value() / unit);
  return out;
}

std::string plot(SvgPlot p) {
  p.width = 480, p.height = 330;
  p.x0 = 0, p.x1 = p.series.front().x.back();
  for (const SvgSeries& s : p.series) {
    p.y0 = std::min(p.y0, std::ranges::min(s.y));
    p.y1 = std::max(p.y1, std::ranges::max(s.y));
  }
  const double pad = 0.1 * (p.y1 - p.y0);
  p.y1 += pad;
  if (p.y0 < 0) p.y0 -= 0.4 * pad;
  p.x_label = "time [ms]";
  return svg(p);
}

}  // namespace

std::string force_svg(const std::filesystem::path& history) {
  const Sheet sheet = read_csv(history);
  const auto time = column(sheet, "time_s", 1e-3), normal = column(sheet, "normal_force_N", 1e3),
             tangential = column(sheet, "tangential_force_N", 1e3);
  solvers::Peak peak;
  for (std::size_t i = 0; i < time.size(); ++i) peak.add(time[i], normal[i]);
  SvgPlot p{.y_label = "force on the ball [kN]", .told = "normal and tangential force over time"};
  p.series = {{"line-1", time, normal}, {"line-2", time, tangential}};
  p.series[0].label = "normal";
  p.series[1].label = "along the slip";
  p.marks = {{peak.time, peak.value, fmt::format("{:.2f} kN at {:.3f} ms", peak.value, peak.time)}};
  return plot(std::move(p));
}

std::string energy_svg(const std::filesystem::path& history) {
  const Sheet sheet = read_csv(history);
  const auto time = column(sheet, "time_s", 1e-3);
  auto motion = column(sheet, "kinetic_J", 1);
  const double start = motion.front();
  for (double& x : motion) x = start - x;
  SvgPlot p{.y_label = "energy [J]", .told = "where the energy is over time"};
  p.series = {{"line-1", time, motion}};
  p.series[0].label = "taken from the motion";
  int style = 1;
  for (const auto& [name, said] : {std::pair{"strain_ball_J", "held by the ball"},
                                   {"viscous_J", "turned into heat"},
                                   {"friction_J", "lost in friction"},
                                   {"strain_face_J", "held by the face"}}) {
    if (std::ranges::find(sheet.names, name) == sheet.names.end()) continue;
    auto y = column(sheet, name, 1);
    if (std::ranges::max(y) < 0.01 * std::ranges::max(motion)) continue;
    p.series.push_back({fmt::format("line-{}", ++style), time, std::move(y), 0, said});
  }
  return plot(std::move(p));
}

}  // namespace hosel::post
