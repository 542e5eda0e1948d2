#include "loop/wrong_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "golf/units.hpp"
#include "loop/fit.hpp"

namespace hosel::loop {
namespace {

constexpr double kSure = 30;     // least fall of the deviance,
constexpr double kShare = 0.15;  // and share of it
constexpr double kClean = 1.7;   // deviance per value that a slip of free size may leave

/// Quantities whose sign is a convention.
bool has_sign(const Column& c) {
  const auto i = input_of(c.stem);
  const auto o = output_of(c.stem);
  if (i) return *i != Input::club_speed && *i != Input::head_mass && *i != Input::dynamic_loft;
  return o && *o != Output::ball_speed && *o != Output::spin_rate;
}

Dimension dimension(const Column& c) {
  if (const auto i = input_of(c.stem)) return quantity(*i).dimension;
  return quantity(*output_of(c.stem)).dimension;
}

bool same_unit(double a, double b) { return std::abs(a / b - 1) < kRoundOff; }

/// Returns the project's units of a dimension, and others that launch monitors and people write.
std::vector<Unit> likely_units(Dimension d) {
  std::vector<Unit> all;
  for (const Unit& u : units())
    if (u.dimension == d && u.suffix != "um") all.push_back(u);  // of no blow: it would be a column that is left out
  switch (d) {
    case Dimension::length:
      all.push_back({"inch", d, 0.0254});
      all.push_back({"cm", d, 0.01});
      all.push_back({"feet", d, 0.3048});
      break;
    case Dimension::angular_velocity: all.push_back({"revolutions per second", d, 2 * kPi}); break;
    case Dimension::speed: all.push_back({"feet per second", d, 0.3048}); break;
    case Dimension::mass: all.push_back({"pounds", d, 0.45359237}); break;
    default: break;
  }
  return all;
}

/// Of its column, or of the second.
std::string in_words(const ColumnSlip& s, ColumnList columns, bool second) {
  const Column& c = *columns[std::size_t(second ? s.second : s.column)];
  const std::string unit = split_unit(c.name).unit ? std::string(split_unit(c.name).unit->suffix) : "";
  const std::string where = s.where.empty() ? "" : " " + s.where;
  if (s.finding == "unit")
    return fmt::format("{} reads like {}{}: ratio {:.4g} to what the other columns allow", c.name, s.what, where,
                       s.factor < 1 ? 1 / s.factor : s.factor);
  if (s.finding == "sign") return fmt::format("{} reads with the other sign{}", c.name, where);
  if (s.finding == "rows")
    return fmt::format("{} is that of the row {}{}", c.name, s.rows > 0 ? "before" : "after", where);
  if (s.finding == "swapped")
    return fmt::format("{} reads like {}: the two columns are swapped", c.name,
                       columns[std::size_t(second ? s.column : s.second)]->name);
  if (s.finding == "scale")
    return fmt::format("{} reads {:.4g} times what the other columns allow", c.name, 1 / s.factor);
  const std::string by =
      fmt::format("{:.4g} {} too {}", std::abs(s.offset) / c.si, unit, s.offset < 0 ? "high" : "low");
  if (s.finding == "offset") return fmt::format("{} reads {} throughout", c.name, by);
  return fmt::format("{} reads {}{}", c.name, by, where);
}

}  // namespace

std::vector<ColumnSlip> constant_slips(ColumnList columns) {
  std::vector<ColumnSlip> all;
  const int count = int(columns.size());
  for (int k = 0; k < count; ++k) {
    const Column& c = *columns[std::size_t(k)];
    const auto units = likely_units(dimension(c));
    for (const Unit& u : units) {
      if (same_unit(u.si, c.si)) continue;
      all.push_back({.finding = "unit", .column = k, .factor = u.si / c.si, .what = std::string(u.suffix), .cost = 2});
    }
    if (has_sign(c)) all.push_back({.finding = "sign", .column = k, .factor = -1, .cost = 2});
    for (const int rows : {-1, 1}) all.push_back({.finding = "rows", .column = k, .rows = rows, .cost = 4});
    for (int l = k + 1; l < count; ++l) {
      const Column& d = *columns[std::size_t(l)];
      if (dimension(c) != dimension(d)) continue;
      all.push_back({.finding = "swapped", .column = k, .second = l, .cost = 4});
      // Both in the same other unit: one monitor, one setting.
      if (!same_unit(c.si, d.si)) continue;
      for (const Unit& u : units)
        if (!same_unit(u.si, c.si))
          all.push_back({.finding = "unit",
                         .column = k,
                         .second = l,
                         .factor = u.si / c.si,
                         .what = std::string(u.suffix),
                         .cost = 8});
    }
  }
  return all;
}

bool contradicts(const ColumnSlip& s, double recorded, double library, double scale, double values, double tie) {
  const bool sized = !s.where.empty() || s.finding == "offset" || s.finding == "scale";
  return recorded - s.criterion() > std::max(kSure, kShare * (recorded - scale)) && library - s.criterion() > tie &&
         (!sized || s.deviance - scale < kClean * values);
}

std::vector<WrongColumn> told(ColumnList columns, const std::vector<ColumnSlip>& slips, double tie,
                              const std::function<bool(const ColumnSlip&)>& holds) {
  const auto best = std::ranges::find_if(slips, holds);
  if (best == slips.end() || best->criterion() > slips.front().criterion() + tie || best->disputed) return {};
  std::string also;
  for (const ColumnSlip& s : slips)
    if (&s != &*best && s.criterion() < best->criterion() + tie && s.column != best->column && holds(s)) {
      also = "; or " + in_words(s, columns, false);
      break;
    }
  std::vector<WrongColumn> all;
  for (const bool second : {false, true})
    if (!second || best->second >= 0)
      all.push_back({columns[std::size_t(second ? best->second : best->column)]->name, best->finding,
                     in_words(*best, columns, second) + also});
  return all;
}

Refitted refitted(const Model& model, const Eigen::VectorXd& start, int residuals, const solvers::Loss& loss,
                  const solvers::Residuals& whitened) {
  if (model.size() == 0) return {};
  solvers::LeastSquares problem{.residuals = residuals};
  const Eigen::VectorXd scale = scales(model);
  for (const Parameter* q : model.parameters()) problem.bounds.push_back({q->min / q->scale, q->max / q->scale, 1});
  problem.loss = loss;
  problem.value = [&](const Eigen::VectorXd& p, Eigen::VectorXd& z) { return whitened(p.cwiseProduct(scale), z); };
  problem.step = 0.1;  // of what matters: blow and flight are nearly linear in it
  const auto at = solvers::minimise(problem, start.cwiseQuotient(scale), {.iterations = 6, .cost = 1e-4});
  if (!at || std::ranges::any_of(solvers::at_bounds(at->parameters, problem.bounds), std::identity{})) return {};
  return {at->parameters.cwiseProduct(scale), 2 * at->cost};
}

}  // namespace hosel::loop
