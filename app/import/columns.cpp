#include "app/import/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "app/import/checks.hpp"
#include "app/import/column_units.hpp"
#include "app/import/decimals.hpp"
#include "app/import/no_readings.hpp"
#include "app/import/not_measured.hpp"
#include "app/reader.hpp"
#include "loop/deviation.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

Understood make_quantity(Reading& r, const MonitorQuantity& q, std::size_t column, std::string unit, double sign,
                         bool own) {
  const Sheet& sheet = r.session.sheet;
  Understood out;
  out.header = sheet.names[column];
  const auto fail = [&](const std::string& why) {
    return InputError(fmt::format("{}: column '{}'{}", r.session.file.string(), out.header, why));
  };
  const Row raw = r.cells(column);
  const bool comma = r.has_decimal_comma(column);
  std::vector<double> values;
  const std::string given = unit;
  if (dimension_of(unit) == Dimension::length) unit = "mm";
  else if (dimension_of(unit) == Dimension::mass) unit = "kg";
  else if (!split_unit("x_" + unit).unit) unit = q.metric;
  std::size_t others = 0, empty = 0, zeros = 0, marked = 0;
  const std::vector<bool> placeholder = find_placeholders(q, raw, given, comma),
                          impossible = find_impossible(q, raw, given, comma);
  const std::string allowed = Range{q.least, q.greatest}.allowed(Unit{given, *dimension_of(given), si_of(given)});
  std::vector<std::string> left_out_cells;
  std::map<double, std::size_t> placed;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    out.own.push_back(own);
    if (raw[i].empty()) {
      out.cells.emplace_back();
      continue;
    }
    const auto cell = number(raw[i], comma, q.sides);
    if (!cell)
      throw fail(
          fmt::format(", shot {}: '{}' is not a number: correct or empty the cell; --column '{}=' leaves the "
                      "column out",
                      i + 1, raw[i], out.header));
    out.own.back() = own || cell->own;
    const bool zero = cell->value == 0 && !q.zero, left_out = cell->marked && !r.options.modelled;
    if (placeholder[i]) {
      out.cells.emplace_back();
      ++placed[cell->value];
      r.placeholders.emplace_back(i, cell->value);
      continue;
    }
    if (impossible[i] && !no_reading(cell->value)) {
      out.cells.emplace_back();
      left_out_cells.push_back(fmt::format("'{}' in shot {}", raw[i], i + 1));
      continue;
    }
    if (zero || left_out || no_reading(cell->value)) {
      out.cells.emplace_back();
      ++(left_out ? marked : zero ? zeros : empty);
      continue;
    }
    const std::string of_cell = cell->unit.empty() ? given : cell->unit;
    if (dimension_of(of_cell) != dimension_of(given))
      throw fail(fmt::format(" in {}, shot {}: '{}' is in another kind of unit", given, i + 1, raw[i]));
    others += of_cell != given;
    const double turn = cell->sided ? 1 : sign;  // the cell's own word is nearer than the header's
    const double si = turn * si_of(of_cell) * cell->value;
    const bool as_recorded = of_cell == unit;
    out.cells.push_back(!as_recorded ? fmt::format("{:.6g}", si / si_of(unit))
                        : turn > 0   ? cell->digits
                                     : negated(cell->digits));
    values.push_back(si);
    ++out.filled;
  }
  if (given != unit) out.remark(fmt::format("{} made {}", given, unit));
  if (given == "m" && r.family != "si" && r.headed_unit(column).empty() && q.metric == "mm")
    out.remark("no unit in the file: metres, by their size");
  if (r.by_carry && (q.name == "ball_speed" || q.name == "club_speed") && stated_unit(r, q, column).empty())
    out.remark("no unit in the file: this one by its carry");
  if (comma) out.remark("decimal comma");
  if (sign < 0) out.remark("sign turned");
  if (others > 0) out.remark(fmt::format("cells in a unit of their own: {}", others));
  if (zeros > 0) out.remark(fmt::format("0 taken as not measured: {}", zeros));
  if (marked > 0) out.remark(fmt::format("marked as estimated, left out (--modelled takes them): {}", marked));
  if (empty > 0) out.remark(fmt::format("cells without a reading: {}", empty));
  for (const auto& [value, n] : placed) out.remark(fmt::format("{:.10g} is no reading: {}", value, n));
  if (constexpr std::size_t most = 5; !left_out_cells.empty()) {
    const std::size_t more = left_out_cells.size() - std::min(most, left_out_cells.size());
    left_out_cells.resize(left_out_cells.size() - more);
    out.remark(fmt::format("left out: {}{} (allowed: {})", fmt::join(left_out_cells, ", "),
                           more ? fmt::format(" and {} more", more) : "", allowed));
  }
  out.name = q.name + "_" + unit;
  out.median = loop::median(values);
  check_range(r, q, column, out, given);
  return out;
}

/// Numbers with a decimal comma are numbers for who reads shots.csv and kept.csv, too; a date is none.
void write_with_points(const Reading& r, Understood& u) {
  static const std::regex with_comma("[+-]?([0-9]+|[0-9]{1,3}([.][0-9]{3})+)(,[0-9]+)?");
  const auto is_number = [](const std::string& cell) { return cell.empty() || std::regex_match(cell, with_comma); };
  const auto has_comma = [](const std::string& cell) { return cell.find(',') != cell.npos; };
  const int decimals = decimal_of(r.session.sheet);
  if (decimals < 0 || (decimals == 0 && r.session.sheet.delimiter == ",") || !std::ranges::all_of(u.cells, is_number) ||
      std::ranges::none_of(u.cells, has_comma))
    return;
  for (std::string& cell : u.cells)
    if (const auto x = number(cell, true, Sides::none)) cell = x->digits;
  u.remark("decimal comma");
}

/// A column that is no quantity: bookkeeping, or kept aside.
void keep(Reading& r, std::size_t c) {
  const Sheet& sheet = r.session.sheet;
  const std::string& header = sheet.names[c];
  Understood u;
  u.header = header.empty() ? fmt::format("column {}", c + 1) : header;
  u.cells = r.cells(c);
  if (r.roles[c] == "session")  // a day, not a second
    for (std::string& day : u.cells)
      if (!day.empty() && std::isdigit(static_cast<unsigned char>(day.front())) && day.find(':') != day.npos)
        day.erase(std::min(day.find_first_of(" T"), day.size()));
  u.filled = std::size_t(std::ranges::count_if(u.cells, [](const std::string& cell) { return !cell.empty(); }));
  if (r.roles[c] == "carry") {
    std::string unit = r.stated_length(c);
    const bool imperial = r.speed_unit.empty() ? r.family == "imperial" : r.speed_unit == "mph";
    if (unit.empty() && !r.family.empty()) unit = imperial ? "yd" : "m";
    if (dimension_of(unit) == Dimension::length) {
      r.session.carry = {.header = header, .name = unit};
      const bool comma = r.has_decimal_comma(c);
      for (const std::string& cell : u.cells) {
        const auto x = number(cell, comma, Sides::none);
        const bool other = x && !x->unit.empty() && x->unit != unit, far = x && x->value > 0;
        if (!far || (other && dimension_of(x->unit) != Dimension::length)) r.session.carry.cells.emplace_back();
        else if (other) r.session.carry.cells.push_back(fmt::format("{:.6g}", x->value * si_of(x->unit) / si_of(unit)));
        else r.session.carry.cells.push_back(x->digits);
      }
    }
  }
  const std::string role = r.roles[c] == "aside" ? "" : r.roles[c];
  if (role == "accuracy" || role == "hand" || role == "used" || role == "deleted") u.note = "read";
  else if (!role.empty() && role != "carry" && u.filled > 0) u.name = role;
  else if (std::ranges::any_of(r.options.keep, [&](const std::string& k) { return letters(k) == letters(header); })) {
    u.name = plain(header);
    std::ranges::replace(u.name, ' ', '_');
    const std::string name = "kept_" + u.name;
    u.name = name;
    for (int k = 2; std::ranges::count(r.session.columns, u.name, &Understood::name); ++k)
      u.name = fmt::format("{}_{}", name, k);
  }
  if (role.empty() || role == "carry") write_with_points(r, u);
  r.session.columns.push_back(std::move(u));
}

/// A `Direction` of the ball or of the club: numbers that may be degrees.
bool is_some_direction(const Reading& r, std::size_t c) {
  if (!r.dictionary.says("may_be_azimuth", r.session.sheet.names[c]) || r.is_empty(c)) return false;
  const auto may_be_angle = [](const std::string& unit) {
    return unit.empty() || dimension_of(unit) == Dimension::angle;
  };
  const bool comma = r.has_decimal_comma(c);
  return may_be_angle(r.headed_unit(c)) && std::ranges::all_of(r.cells(c), [&](const std::string& said) {
           const auto cell = number(said, comma, Sides::across);
           return said.empty() || (cell && may_be_angle(cell->unit));
         });
}

/// Whether a column that is not empty holds this quantity.
bool has_column(const Reading& r, std::string_view quantity) {
  const Row& names = r.session.sheet.names;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::string* hand = r.by_hand.of(names[c], names);
    const MonitorQuantity* q = hand || !r.roles[c].empty() ? nullptr : r.dictionary.quantity_of(names[c]);
    if (!r.is_empty(c) && ((q && q->name == quantity) || (hand && split_unit(*hand).stem == quantity))) return true;
  }
  return false;
}

}  // namespace

void read_columns(Reading& r) {
  const Sheet& sheet = r.session.sheet;
  r.session.shots = sheet.rows.size();
  find_speed_unit(r);
  r.session.columns.reserve(sheet.names.size() + 4);  // pointers into it stay good
  std::set<std::string> quantities, said_by_hand;
  for (std::size_t c = 0; c < sheet.names.size(); ++c)
    if (const std::string* hand = r.by_hand.of(sheet.names[c], sheet.names); hand && !hand->empty() && !r.is_empty(c))
      said_by_hand.insert(split_unit(*hand).stem);
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::string& header = sheet.names[c];
    const std::string* hand = r.by_hand.of(header, sheet.names);
    const MonitorQuantity* q = nullptr;
    std::string unit;
    if (hand && !hand->empty()) {
      const SplitName part = split_unit(*hand);
      q = r.dictionary.quantity(part.stem);
      unit = std::string(part.unit->suffix);
    } else if (!hand && r.roles[c].empty()) {
      q = r.dictionary.quantity_of(header);
    }
    const bool direction = !hand && !q && r.roles[c].empty() && is_some_direction(r, c);
    const bool of_some = direction && !has_column(r, "azimuth"), of_ball = of_some && has_column(r, "club_path");
    if (of_ball) q = r.dictionary.quantity("azimuth");
    // A second column of one quantity is kept aside, and one that is empty; what --column says is the first.
    const bool beaten = q && !hand && said_by_hand.contains(q->name);
    const bool second = q && !r.is_empty(c) && (beaten || !quantities.insert(q->name).second);
    if (!q || second || r.is_empty(c)) {
      keep(r, c);
      if (of_some && r.session.columns.back().name.empty())
        r.session.columns.back().remark(fmt::format(
            "of the ball or of the club? --column '{0}=azimuth_deg' takes it as the ball's, '{0}=club_path_deg' as the "
            "club's",
            header));
      if (second && r.session.columns.back().name.empty())
        r.session.columns.back().remark("a second column of " + post::spoken(q->name));
      continue;
    }
    if (unit.empty()) unit = unit_of_column(r, *q, c);
    const HeaderSign said = sign_in(header, q->sides);
    const bool turned = r.by_hand.turns(header);
    r.session.columns.push_back(make_quantity(r, *q, c, unit, turned || said.sign < 0 ? -1 : 1, said.own));
    if (of_ball) r.session.columns.back().remark("the ball's, since the club's path has a column of its own");
    if (said.strange && !turned) r.session.columns.back().remark("signs in the header not understood: taken as ours");
    if (q->name == "impact_toe" && said.sign == 0 && !turned && !hand && r.dictionary.says("heel_positive", header) &&
        std::ranges::none_of(sheet.rows, [&](const Row& row) {
          const auto cell = number(row[c], false, q->sides);
          return cell && cell->sided;
        }))
      r.session.columns.back().remark(fmt::format(
          "no sign said: taken as towards the toe; Foresight has heel +, and --column '{}=-impact_toe_mm' turns it",
          header));
    if (!r.options.modelled && !hand && modelled_by_its_header(r, header))
      r.session.columns.back().name.clear(),
          r.session.columns.back().note = "modelled by the instrument; --modelled takes it";
  }
}

}  // namespace hosel::app
