#include "app/implausible.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "golf/units.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

/// What a quantity (over another one) of a shot may be [of its unit].
struct Plausible {
  std::string_view what, stem, over, unit;
  double low, high;
};
constexpr std::array kPlausible = {
    Plausible{"ball speed over club speed", "ball_speed", "club_speed", "", 0, 1.6},
    Plausible{"spin rate", "spin_rate", "", "rpm", 0, 16000},
    Plausible{"backspin", "backspin", "", "rpm", -3000, 16000},
    Plausible{"launch angle", "launch_angle", "", "deg", -15, 75},
    Plausible{"dynamic loft", "dynamic_loft", "", "deg", -15, 75},
    Plausible{"carry", "carry", "", "m", 0, 450},
};

}  // namespace

std::vector<std::string> implausible_rows(const loop::Shots& shots) {
  constexpr std::size_t named = 8;
  const std::string file = std::filesystem::path(shots.file).filename().string();  // wherever the case lies
  std::vector<std::string> out;
  for (const Plausible& p : kPlausible) {
    const loop::Column *of = shots.find_stem(p.stem), *over = p.over.empty() ? nullptr : shots.find_stem(p.over);
    if (!of || !of->numeric || (!p.over.empty() && (!over || !over->numeric))) continue;
    const double si = p.unit.empty() ? 1 : split_unit(fmt::format("x_{}", p.unit)).unit->si;
    std::string rows;
    double worst = 0;
    std::size_t count = 0;
    for (std::size_t r = 0; r < shots.rows(); ++r) {
      const double x = of->value[r] / (over ? over->value[r] : si);
      if (!(x < p.low || x > p.high)) continue;
      if (count == 0 || std::abs(x) > std::abs(worst)) worst = x;
      if (count++ < named) rows += fmt::format("{}{}", rows.empty() ? file + ":" : ", ", shots.line[r]);
    }
    if (count > 0)
      out.push_back(fmt::format(
          "{} of {}: {} is {:.4g}{} at the worst, and a blow gives {:g} to {:g}: {}{}; they stay in", count,
          post::counted(shots.rows(), "shot"), p.what, worst, p.unit.empty() ? "" : fmt::format(" {}", p.unit), p.low,
          p.high, rows, count > named ? fmt::format(" and {} more", count - named) : ""));
  }
  return out;
}

std::string repeated_rows(const loop::Shots& shots) {
  if (shots.repeated == 0) return "";
  return fmt::format("{} of the shots {} an earlier row: each shot counts once", post::counted(shots.repeated, "row"),
                     shots.repeated == 1 ? "repeats" : "repeat");
}

}  // namespace hosel::app
