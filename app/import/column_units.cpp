#include "app/import/column_units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/import/carry_ratio.hpp"
#include "app/reader.hpp"

namespace hosel::app {
namespace {

/// The numbers of a quantity as they stand, of a role likewise; NaN where there is none.
std::vector<double> raw(const Reading& r, std::string_view quantity, std::string_view role = "") {
  const Sheet& sheet = r.session.sheet;
  std::vector<double> out(sheet.rows.size(), NAN);
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const MonitorQuantity* q = r.dictionary.quantity_of(sheet.names[c]);
    if (role.empty() ? !q || q->name != quantity || !r.roles[c].empty() : r.roles[c] != role) continue;
    const Row said = r.cells(c);
    const bool comma = r.has_decimal_comma(c);
    for (std::size_t i = 0; i < said.size(); ++i)
      if (const auto x = number(said[i], comma, role.empty() ? q->sides : Sides::none)) out[i] = x->value;
    return out;
  }
  return out;
}

/// A file that names no unit: that of the ball's speed by which its shots carry most nearly as far as the file says.
/// Empty where no shot has what this takes.
std::string unit_by_carry(const Reading& r) {
  Numbers speed{raw(r, "ball_speed")}, carry{raw(r, "", "carry")};
  const Numbers launch{raw(r, "launch_angle"), si_of("deg")}, spin{raw(r, "spin_rate"), si_of("rpm")};
  const auto carried = r.column_of("carry");
  const std::string carry_unit = carried ? r.stated_length(*carried) : "";
  // What --units says stands; of metric units there are two.
  std::vector<std::string> units = {"mps", "kmh"};
  if (r.options.units == "imperial") units = {"mph"};
  else if (r.family == "imperial") units = {"mph", "kmh", "mps"};
  else if (r.options.units.empty()) units.push_back("mph");
  std::string best;
  std::size_t fit = 0;
  bool told = false;
  double least = std::log(kCarryFits);
  for (const std::string& unit : units) {
    speed.si = si_of(unit);
    carry.si = si_of(!carry_unit.empty() ? carry_unit : unit == "mph" ? "yd" : "m");
    const auto ratio = carry_ratio(speed, launch, spin, carry);
    if (!ratio) continue;  // no shot has all of it, or none flies at such speeds
    told = true;
    const double off = std::abs(std::log(*ratio));
    if (!(off < std::log(kCarryFits))) continue;
    ++fit;
    if (off < least) least = off, best = unit;
  }
  // Where no layout is known one alone must fit.
  if (!told || (r.family.empty() && fit != 1)) return "";
  if (!best.empty()) return best;
  throw InputError(
      fmt::format("{}: the ball's speed in {} does not fit the carry in the file; --column 'header=ball_speed_mph' "
                  "states its unit",
                  r.session.file.string(), fmt::join(units, ", ")));
}

}  // namespace

std::string stated_unit(const Reading& r, const MonitorQuantity& q, std::size_t c) {
  const Sheet& sheet = r.session.sheet;
  std::string unit = r.headed_unit(c);
  const std::string& header = sheet.names[c];
  std::string strange = unit.empty() && c < sheet.units.size() ? strange_unit(sheet.units[c]) : "";
  if (unit.empty() && strange.empty())
    strange = strange_unit(header.substr(std::min(header.find_first_of("(["), header.size())));
  if (!strange.empty())
    throw InputError(fmt::format("{}: column '{}': the unit '{}' is not known; --column '{}={}_{}' states one",
                                 r.session.file.string(), header, strange, header, q.name, q.metric));
  if (unit.empty() && q.metric == "mm" && (r.family == "si" || in_metres(r, c))) unit = "m";
  if (unit.empty() && q.imperial == q.metric) unit = q.imperial;  // degrees, rpm, mm: no monitor uses others
  if (!unit.empty()) return unit;
  // One cell alone does not speak for the others.
  for (const Row& row : sheet.rows) {
    if (missing(row[c])) continue;
    const auto cell = number(row[c], false, q.sides);
    if (!cell || cell->unit.empty()) return "";
    if (unit.empty()) unit = cell->unit;
  }
  return unit;
}

bool in_metres(const Reading& r, std::size_t c) {
  const Row said = r.cells(c);
  const bool comma = r.has_decimal_comma(c);
  double most = 0;
  for (const std::string& cell : said)
    if (const auto x = number(cell, comma, Sides::any)) most = std::max(most, x->unit.empty() ? std::abs(x->value) : 1);
  return most > 0 && most < 0.05;
}

void find_speed_unit(Reading& r) {
  if (r.family == "si") return;
  for (std::size_t c = 0; c < r.roles.size(); ++c) {
    const MonitorQuantity* q = r.dictionary.quantity_of(r.session.sheet.names[c]);
    if (!q || q->name != "ball_speed" || !r.roles[c].empty() ||
        r.by_hand.of(r.session.sheet.names[c], r.session.sheet.names) || !stated_unit(r, *q, c).empty())
      continue;
    r.speed_unit = unit_by_carry(r);
    r.by_carry = !r.speed_unit.empty() &&
                 (r.family.empty() || r.speed_unit != (r.family == "imperial" ? q->imperial : q->metric));
    if (r.family.empty() && r.by_carry) r.family = r.speed_unit == q->imperial ? "imperial" : "metric";
  }
}

std::string unit_of_column(const Reading& r, const MonitorQuantity& q, std::size_t c) {
  const std::string& header = r.session.sheet.names[c];
  std::string unit = stated_unit(r, q, c);
  if (unit.empty() && (q.name == "ball_speed" || q.name == "club_speed")) unit = r.speed_unit;
  if (unit.empty() && !r.family.empty()) unit = r.family == "imperial" ? q.imperial : q.metric;
  if (unit.empty())
    throw InputError(
        fmt::format("{}: column '{}' has no unit; say --units imperial, --units metric or --column '{}={}_{}'",
                    r.session.file.string(), header, header, q.name, q.imperial));
  if (dimension_of(unit) != dimension_of(q.metric))
    throw InputError(fmt::format("{}: column '{}': {} is no unit of {}; --column '{}={}_{}' states one",
                                 r.session.file.string(), header, unit, q.name, header, q.name, q.metric));
  return unit;
}

}  // namespace hosel::app
