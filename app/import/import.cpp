#include "app/import/import.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/import/cells.hpp"
#include "app/import/sheet.hpp"
#include "app/reader.hpp"
#include "loop/median.hpp"
#include "post/csv.hpp"
#include "post/file.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

struct Understood {
  std::string header, name, note;  // name: of shots.csv; empty: goes to kept.csv
  std::vector<std::string> cells;
  std::size_t filled = 0;
  double median = 0;
};

/// What stands before a unit or a side: `1,3` of `1,3 L`.
std::string figure_of(const std::string& cell) {
  const auto end = cell.find_first_not_of("0123456789.,+-'");
  return cell.substr(0, end);
}

/// Whether a cell's comma (1) or its point (-1) is the decimal one; 0 where it may as well part thousands, or has none.
int decimal_of(const std::string& cell) {
  const std::string text = figure_of(cell);
  const auto point = text.rfind('.'), comma = text.rfind(',');
  constexpr auto none = std::string::npos;
  if (point == none && comma == none) return 0;
  if (point != none && comma != none) return comma > point ? 1 : -1;
  const char sign = comma != none ? ',' : '.';
  const int decimal = comma != none ? 1 : -1;
  const auto first = text.find(sign), last = text.rfind(sign);
  if (first != last) return -decimal;  // thousands stand several times
  const std::size_t before = first - std::min(first, text.find_first_of("0123456789")), after = text.size() - last - 1;
  return after == 3 && before >= 1 && before <= 3 && text[text.find_first_of("0123456789")] != '0' ? 0 : decimal;
}

/// Of a whole file: 1 where a column of it surely has decimal commas and none has points, -1 the contrary, else 0.
int decimal_of(const Sheet& sheet) {
  bool comma = false, point = false;
  for (const Row& row : sheet.rows)
    for (const std::string& cell : row)
      if (!cell.empty() && figure_of(cell).size() > 1 && trimmed(cell.substr(figure_of(cell).size())).size() < 12) {
        const int d = decimal_of(cell);
        comma |= d > 0;
        point |= d < 0;
      }
  return comma == point ? 0 : comma ? 1 : -1;
}

bool decimal_comma(const std::vector<std::string>& cells, const Sheet& sheet, const std::string& header,
                   const fs::path& file) {
  std::vector<std::size_t> commas, points;
  bool any = false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int d = decimal_of(cells[i]);
    if (d > 0) commas.push_back(i);
    if (d < 0) points.push_back(i);
    any |= figure_of(cells[i]).find(',') != std::string::npos;
  }
  if (!commas.empty() && !points.empty()) {
    const std::size_t odd = commas.size() < points.size() ? commas.front() : points.front();
    throw InputError(
        fmt::format("{}: column '{}', shot {}: '{}' among {} that write the decimals otherwise: correct it",
                    file.string(), header, odd + 1, cells[odd], std::max(commas.size(), points.size())));
  }
  if (!commas.empty() || !points.empty()) return !commas.empty();
  if (const int d = decimal_of(sheet); d != 0) return d > 0;
  // 94,213 alone: thousands in a file of commas, decimals where small numbers stand in a file of semicolons.
  return any && sheet.delimiter != "," && sheet.delimiter != "JSON" &&
         std::ranges::all_of(cells, [](const std::string& c) { return c.size() < 6; });
}

/// What some programs write where nothing was measured.
bool no_reading(double value) {
  const double a = std::abs(value);
  return a == 99999 || a == 999999 || a == 99999.9 || value == -9999 || value == -999;
}

std::optional<Dimension> dimension_of(const std::string& unit) {
  if (unit == "cm" || unit == "in") return Dimension::length;
  for (const Unit& u : units())
    if (u.suffix == unit) return u.dimension;
  return {};
}

Understood make_quantity(const MonitorQuantity& q, const std::string& header, std::string unit, double sign,
                         const Sheet& sheet, std::size_t column, const fs::path& file) {
  Understood out;
  out.header = header;
  std::vector<std::string> raw;
  for (const Row& row : sheet.rows) raw.push_back(missing(row[column]) ? "" : row[column]);
  const bool comma = decimal_comma(raw, sheet, header, file);
  std::vector<double> values;
  const std::string given = unit;
  const bool lengths = dimension_of(unit) == Dimension::length;
  if (lengths) unit = "mm";
  std::size_t others = 0, empty = 0, zeros = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i].empty()) {
      out.cells.emplace_back();
      continue;
    }
    const auto cell = number(raw[i], comma, q.side);
    if (!cell)
      throw InputError(
          fmt::format("{}: column '{}', shot {}: '{}' is not a number", file.string(), header, i + 1, raw[i]));
    const bool zero = cell->value == 0 && !q.zero;
    if (zero || no_reading(cell->value)) {
      out.cells.emplace_back();
      ++(zero ? zeros : empty);
      continue;
    }
    const std::string own = cell->unit.empty() ? given : cell->unit;
    if (dimension_of(own) != dimension_of(given))
      throw InputError(fmt::format("{}: column '{}' in {}, shot {}: '{}' is in another kind of unit", file.string(),
                                   header, given, i + 1, raw[i]));
    others += own != given;
    const double si = sign * si_of(own) * cell->value;
    const bool as_recorded = own == unit;
    out.cells.push_back(!as_recorded ? fmt::format("{:.6g}", si / si_of(unit))
                        : sign > 0   ? cell->digits
                                     : (cell->digits.front() == '-' ? cell->digits.substr(1) : "-" + cell->digits));
    values.push_back(si);
    ++out.filled;
  }
  const auto note = [&](const std::string& text) { out.note += (out.note.empty() ? "" : ", ") + text; };
  if (lengths && given != "mm") note(fmt::format("{} made mm", given));
  if (comma) note("decimal comma");
  if (sign < 0) note("sign turned");
  if (others > 0) note(fmt::format("cells in a unit of their own: {}", others));
  if (zeros > 0) note(fmt::format("0 taken as not measured: {}", zeros));
  if (empty > 0) note(fmt::format("cells without a reading: {}", empty));
  out.name = q.name + "_" + unit;
  out.median = loop::median(values);
  if (!values.empty() && !(out.median >= q.low && out.median <= q.high)) {
    std::string reads;
    for (const Unit& u : units())
      if (u.dimension == split_unit(out.name).unit->dimension && u.suffix != given) {
        const double other = out.median / si_of(given) * u.si;
        if (other >= q.low && other <= q.high) reads += (reads.empty() ? "" : " or ") + std::string(u.suffix);
      }
    throw InputError(fmt::format(
        "{}: column '{}': the median {:.4g} {} is no {} ({:.3g} to {:.3g} in SI){}; say --column '{}={}_UNIT'",
        file.string(), header, out.median / si_of(given), given, q.name, q.low, q.high,
        reads.empty() ? "" : ": it reads like " + reads, header, q.name));
  }
  return out;
}

/// Counts what stands in the cells of a quantity anew.
void count_again(Understood& u) {
  std::vector<double> values;
  for (const std::string& cell : u.cells)
    if (const auto x = number(cell, false, false)) values.push_back(x->value * split_unit(u.name).unit->si);
  u.filled = values.size();
  u.median = loop::median(values);
}

/// Empties the cells of the rows where `which`; how many had something.
std::size_t blank(Understood& u, const std::vector<bool>& which) {
  const std::size_t before = u.filled;
  for (std::size_t i = 0; i < u.cells.size(); ++i)
    if (which[i]) u.cells[i].clear();
  count_again(u);
  return before - u.filled;
}

bool says_any(const std::string& cell, std::initializer_list<const char*> words) {
  const std::string text = plain(cell);
  return std::ranges::any_of(words, [&](const char* w) { return text.find(w) != std::string::npos; });
}

/// Whether a cell names the left hand (1), the right one (0), or says nothing of a hand.
std::optional<bool> left_hand(const std::string& cell, bool asked) {
  const std::string word = plain(cell);
  static const std::set<std::string> left = {"l", "lh", "left", "left hand", "left handed", "lefty", "links"},
                                     right = {"r", "rh", "right", "right hand", "right handed", "righty", "rechts"},
                                     yes = {"yes", "y", "true", "1"}, no = {"no", "n", "false", "0"};
  if (left.contains(word) || (asked && yes.contains(word))) return true;
  if (right.contains(word) || missing(cell) || (asked && no.contains(word))) return false;
  return {};
}

/// A left-handed player's shots as a right-handed one's: what is signed towards the right turns round. The place on the
/// face is towards the toe for both.
std::size_t mirror(std::vector<Understood>& columns, const std::vector<bool>& left) {
  for (Understood& u : columns) {
    if (u.name.empty()) continue;
    static const std::set<std::string> sideways = {"azimuth", "spin_axis", "sidespin", "club_path", "face_angle"};
    if (!sideways.contains(std::string(split_unit(u.name).stem))) continue;
    for (std::size_t i = 0; i < u.cells.size(); ++i)
      if (left[i] && !u.cells[i].empty())
        u.cells[i] = u.cells[i].front() == '-' ? u.cells[i].substr(1) : "-" + u.cells[i];
    count_again(u);
  }
  return std::size_t(std::ranges::count(left, true));
}

/// Face minus path under the name of a place on the face, as one connector writes it: nine cells in ten agree.
bool is_face_to_path(const Understood& u, const Understood* face, const Understood* path) {
  if (!face || !path || !face->filled || !path->filled) return false;
  std::size_t same = 0, seen = 0;
  for (std::size_t i = 0; i < u.cells.size(); ++i) {
    const auto a = number(u.cells[i], false, false), f = number(face->cells[i], false, false),
               p = number(path->cells[i], false, false);
    if (!a || !f || !p) continue;
    ++seen;
    same += std::abs(a->value - (f->value - p->value)) < 0.15;
  }
  return seen > 2 && 10 * same >= 9 * seen;
}

void write_csv(const fs::path& file, const std::vector<const Understood*>& columns,
               const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t c = 0; c < columns.size(); ++c) text += (c ? "," : "") + post::csv_cell(names[c]);
  text += '\n';
  for (std::size_t r = 0; !columns.empty() && r < columns.front()->cells.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) text += (c ? "," : "") + post::csv_cell(columns[c]->cells[r]);
    text += '\n';
  }
  post::write_file(file, text);
}

/// A text as a TOML basic string.
std::string toml_text(const std::string& text) { return nlohmann::json(text).dump(); }

/// What --column says.
struct ByHand {
  std::map<std::string, std::string> quantity;  ///< header -> quantity with unit
  std::set<std::string> turned;                 ///< headers whose numbers grow the other way
};

ByHand read_by_hand(const ImportOptions& o, Dictionary& d) {
  ByHand out;
  auto& [by_hand, turned] = out;
  for (const std::string& c : o.columns) {
    const auto at = c.rfind('=');
    if (at == std::string::npos || at == 0)
      throw InputError(fmt::format("--column '{}': header=quantity_unit is wanted", c));
    std::string name = c.substr(at + 1);
    if (name.starts_with('-')) turned.insert(plain(c.substr(0, at))), name.erase(0, 1);
    by_hand[plain(c.substr(0, at))] = name;
    if (name.empty()) {
      d.learn(c.substr(0, at), "");
      continue;
    }
    const std::vector<std::string> roles = d.roles();
    if (std::ranges::count(roles, name)) {
      d.learn(c.substr(0, at), name);
      by_hand.erase(plain(c.substr(0, at)));
      continue;
    }
    const SplitName part = split_unit(name);
    const std::vector<std::string> known = d.quantity_names();
    if (!part.unit || !std::ranges::count(known, part.stem))
      throw InputError(fmt::format("--column '{}': no such quantity with a unit, nor {}; quantities: {}", c,
                                   fmt::join(roles, ", "), fmt::join(known, ", ")));
    d.learn(c.substr(0, at), part.stem);
  }
  return out;
}

/// What one file says, or several together.
struct Session {
  fs::path file;
  Sheet sheet;
  std::string club;  ///< of every shot, where no column names it; empty: unknown
  std::vector<Understood> columns;
  std::size_t shots = 0, other_clubs = 0, modelled = 0, left_handed = 0;
  std::vector<std::string> no_nominal;  ///< clubs that the dictionary does not know
  bool nominal_loft = false;
  Understood carry;  ///< of the monitor's own flight model; its name is its unit; empty: none

  Understood* find(std::string_view stem) {
    for (Understood& u : columns)
      if (!u.name.empty() && split_unit(u.name).stem == stem) return &u;
    return nullptr;
  }
};

/// `club`: of the shots, where the file names none.
Session understand(const fs::path& from, const std::string& club_of_file, const ImportOptions& o, const Dictionary& d,
                   const ByHand& hand_made) {
  const auto& [by_hand, turned] = hand_made;
  Session out;
  out.file = from;
  out.sheet = read_sheet(from, d);
  Sheet& sheet = out.sheet;
  const std::string family = !o.units.empty() ? o.units : sheet.family;

  // The club's column first: the others may be cut down to one club.
  std::vector<std::string> role(sheet.names.size());
  std::map<std::string, std::size_t> taken;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    if (by_hand.contains(plain(sheet.names[c]))) continue;
    std::string r = d.bookkeeping_of(sheet.names[c]);
    if ((r == "club" || r == "ball") && d.quantity_of(sheet.names[c])) {
      // "Club" and "Ball" are names where their cells are not numbers, speeds where they are; "Ball" without a unit,
      // and beside a column of ball speed, is a number of the ball.
      const auto same = std::ranges::count_if(
          sheet.names, [&](const std::string& n) { return d.quantity_of(n) == d.quantity_of(sheet.names[c]); });
      const bool unit = !unit_in(sheet.names[c]).empty() ||
                        (c < sheet.units.size() && !unit_of(sheet.units[c]).empty());
      if (std::ranges::all_of(sheet.rows, [&](const Row& row) {
            return missing(row[c]) || (number(row[c], false, false) && (unit || (r == "ball" && same == 1)));
          }))
        r.clear();
    }
    if (r.empty() || taken.contains(r)) continue;
    if (std::ranges::all_of(sheet.rows, [&](const Row& row) { return missing(row[c]); })) continue;
    role[c] = r;
    taken[r] = c;
  }
  std::size_t& other_clubs = out.other_clubs;
  if (!o.club.empty() && taken.contains("club")) {
    std::vector<std::string> names;
    for (const Row& row : sheet.rows)
      if (!std::ranges::count(names, row[taken["club"]])) names.push_back(row[taken["club"]]);
    other_clubs = sheet.rows.size();
    std::erase_if(sheet.rows, [&](const Row& row) { return club_key(row[taken["club"]]) != club_key(o.club); });
    other_clubs -= sheet.rows.size();
    if (sheet.rows.empty())
      throw InputError(
          fmt::format("{}: no shot with club '{}'; there are: {}", from.string(), o.club, fmt::join(names, ", ")));
  }

  std::vector<Understood>& columns = out.columns;
  columns.reserve(sheet.names.size() + 3);  // pointers into it stay good
  std::set<std::string> quantities;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::string& header = sheet.names[c];
    const auto hand = by_hand.find(plain(header));
    const MonitorQuantity* q = nullptr;
    std::string unit;
    if (hand != by_hand.end() && !hand->second.empty()) {
      const SplitName part = split_unit(hand->second);
      q = d.quantity(part.stem);
      unit = std::string(part.unit->suffix);
    } else if (hand == by_hand.end() && role[c].empty()) {
      q = d.quantity_of(header);
    }
    if (q && !quantities.insert(q->name).second) q = nullptr;  // a second column of one quantity is kept aside
    if (q) {
      if (unit.empty()) unit = unit_in(header);
      if (unit.empty() && !sheet.units.empty() && c < sheet.units.size()) unit = unit_of(sheet.units[c]);
      if (unit.empty() && family == "si" && q->metric == "mm") unit = "m";
      if (unit.empty() && q->imperial == q->metric) unit = q->imperial;  // degrees, rpm, mm: no monitor uses others
      if (unit.empty())
        for (const Row& row : sheet.rows)
          if (const auto cell = number(row[c], false, q->side); unit.empty() && cell) unit = cell->unit;
      if (unit.empty() && !family.empty()) unit = family == "imperial" ? q->imperial : q->metric;
      if (unit.empty())
        throw InputError(
            fmt::format("{}: column '{}' has no unit; say --units imperial, --units metric or --column '{}={}_{}'",
                        from.string(), header, header, q->name, q->imperial));
      const double sign = turned.contains(plain(header)) || sign_in(header) < 0 ? -1 : 1;
      columns.push_back(make_quantity(*q, header, unit, sign, sheet, c, from));
      if (!o.modelled && says_any(header, {"estimated", "calculated", "modelled"}))
        columns.back().name.clear(), columns.back().note = "modelled by the instrument; --modelled takes it";
      continue;
    }
    Understood u;
    u.header = header.empty() ? fmt::format("column {}", c + 1) : header;
    for (const Row& row : sheet.rows) {
      u.cells.push_back(missing(row[c]) ? "" : row[c]);
      // A session is a day, not a second.
      if (role[c] == "session") u.cells.back() = u.cells.back().substr(0, u.cells.back().find_first_of(" T"));
      u.filled += !u.cells.back().empty();
    }
    if (role[c] == "carry") {
      std::string of_carry = unit_in(header);
      if (of_carry.empty() && c < sheet.units.size()) of_carry = unit_of(sheet.units[c]);
      if (of_carry.empty() && !family.empty()) of_carry = family == "imperial" ? "yd" : "m";
      if (dimension_of(of_carry) == Dimension::length) {
        out.carry = {.header = header, .name = of_carry};
        const bool comma = decimal_comma(u.cells, sheet, header, from);
        for (const std::string& cell : u.cells) {
          const auto x = number(cell, comma, false);
          out.carry.cells.push_back(x && x->unit.empty() && x->value > 0 ? x->digits : "");
        }
      }
    }
    if (role[c] == "accuracy" || role[c] == "hand") u.note = "read";
    else if (!role[c].empty() && role[c] != "carry" && u.filled > 0) u.name = role[c];
    else if (std::ranges::any_of(o.keep, [&](const std::string& k) { return plain(k) == plain(header); }))
      u.name = "kept_" + [&] {
        std::string s = plain(header);
        std::ranges::replace(s, ' ', '_');
        return s;
      }();
    columns.push_back(std::move(u));
  }
  const std::size_t shots = out.shots = sheet.rows.size();
  const auto find = [&](std::string_view stem) { return out.find(stem); };

  // What the instrument modelled says nothing of the blow: its own model's answer would be explained.
  std::size_t& modelled = out.modelled;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    if (role[c] != "accuracy" || o.modelled) continue;
    std::vector<bool> rate, axis;
    const bool of_spin = says_any(sheet.names[c], {"spin"});
    for (const Row& row : sheet.rows) {
      const bool estimated = of_spin && says_any(row[c], {"est", "calc", "model", "simul", "predicted"});
      rate.push_back(estimated || says_any(row[c], {"spinrate", "spin rate"}));
      axis.push_back(estimated || says_any(row[c], {"spinaxis", "spin axis"}));
    }
    for (const char* q : {"spin_rate", "backspin", "sidespin"})
      if (Understood* u = find(q)) modelled = std::max(modelled, blank(*u, rate));
    if (Understood* u = find("spin_axis")) blank(*u, axis);
  }
  std::vector<bool> left(sheet.rows.size(), o.left_handed);
  for (const Row& row : sheet.before) {  // `Player: Jo, Handedness: Left`
    std::istringstream words(plain(fmt::format("{}", fmt::join(row, " "))));
    std::string before;
    for (std::string word; words >> word; before = word)  // the word beside the hand's name, not one further on
      if (names_a_hand(before) && left_hand(word, false) == true) left.assign(left.size(), true);
  }
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    if (role[c] != "hand") continue;
    for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
      const auto hand = left_hand(sheet.rows[i][c], plain(sheet.names[c]).find("left handed") != std::string::npos);
      if (!hand)
        throw InputError(
            fmt::format("{}: column '{}', shot {}: '{}' is neither left nor right; --column '{}=' leaves "
                        "it out, --left-handed mirrors every shot",
                        from.string(), sheet.names[c], i + 1, sheet.rows[i][c], sheet.names[c]));
      left[i] = left[i] || *hand;
    }
  }
  out.left_handed = mirror(columns, left);
  // Zeros of the club beside no speed of it, of the axis beside no spin, and through a whole column are no readings.
  const auto silent = [&](const char* of, std::initializer_list<const char*> others) {
    const Understood* measured = find(of);
    for (const char* other : others) {
      Understood* u = find(other);
      if (!u || !u->filled) continue;
      std::vector<bool> zero, silent_zero;
      for (std::size_t i = 0; i < shots; ++i) {
        const auto x = number(u->cells[i], false, false);
        zero.push_back(x && x->value == 0);
        silent_zero.push_back(zero.back() && measured && measured->cells[i].empty());
      }
      const bool all = std::size_t(std::ranges::count(zero, true)) == u->filled && shots > 1;
      if (const std::size_t n = blank(*u, all ? zero : silent_zero); n > 0)
        u->note += fmt::format("{}0 taken as not measured: {}", u->note.empty() ? "" : ", ", n);
    }
  };
  silent("club_speed", {"attack_angle", "club_path", "face_angle", "face_to_path", "impact_toe", "impact_high"});
  silent("spin_rate", {"spin_axis", "sidespin"});

  if (Understood* u = find("impact_toe"); u && is_face_to_path(*u, find("face_angle"), find("club_path")))
    u->name.clear(), u->note = "holds face angle minus path";

  // The face is path and face-to-path together, where it is not recorded by itself.
  if (Understood* across = find("face_to_path")) {
    const Understood* path = find("club_path");
    if (path && across->filled && path->filled && !find("face_angle")) {
      Understood face;
      face.header = across->header + " + " + path->header;
      face.name = "face_angle_deg";
      const double a = split_unit(across->name).unit->si, p = split_unit(path->name).unit->si;
      for (std::size_t i = 0; i < shots; ++i) {
        const auto x = number(across->cells[i], false, false), y = number(path->cells[i], false, false);
        face.cells.push_back(x && y ? fmt::format("{:.6g}", (a * x->value + p * y->value) / si_of("deg")) : "");
      }
      count_again(face);
      columns.push_back(std::move(face));
    }
    across = find("face_to_path");
    across->name.clear(), across->note = "face minus path";
  }

  // Spin stands twice in most exports: rate and tilt are what is measured, back and side follow from them.
  if (const auto* rate = find("spin_rate"), *axis = find("spin_axis"); rate && rate->filled && axis && axis->filled)
    for (const char* copy : {"backspin", "sidespin"})
      if (Understood* u = find(copy)) u->name.clear(), u->note = "follows from rate and axis";
  for (Understood& u : columns)
    if (!u.name.empty() && u.filled == 0) {
      u.name.clear();
      if (u.note.empty()) u.note = "empty";
    }

  // Two speeds check each other.
  Understood *club = find("club_speed"), *ball = find("ball_speed");
  if (!ball || !club)
    throw InputError(fmt::format("{}: no column of {} speed; --column 'header={}_speed_mph' names one", from.string(),
                                 club ? "ball" : "club", club ? "ball" : "club"));
  const double smash = ball->median / club->median;
  if (!(smash > 0.8 && smash < 1.62))
    throw InputError(
        fmt::format("{}: ball over club speed is {:.2f} in the median, no blow's ({:.4g} {} over {:.4g} {}): one of "
                    "the two units is wrong; --column '{}=ball_speed_UNIT' or '{}=club_speed_UNIT' corrects it",
                    from.string(), smash, ball->median / split_unit(ball->name).unit->si,
                    split_unit(ball->name).unit->suffix, club->median / split_unit(club->name).unit->si,
                    split_unit(club->name).unit->suffix, ball->header, club->header));

  // What the loop needs and the file lacks comes from the clubs' nominal figures, said as such.
  const Understood* clubs = find("club");
  if (!clubs) out.club = club_of_file;
  std::vector<std::string>& unknown = out.no_nominal;
  const auto nominal = [&](double NominalClub::*what, std::string_view option) {
    Understood u;
    for (std::size_t i = 0; i < shots; ++i) {
      const std::string name = clubs ? clubs->cells[i] : out.club;
      const NominalClub* entry = d.club(name);
      if (!entry && !std::ranges::count(unknown, name)) unknown.push_back(name);
      u.cells.push_back(entry ? fmt::format("{:g}", entry->*what) : "");
      u.filled += entry != nullptr;
    }
    if (u.filled == 0)
      throw InputError(
          fmt::format("{}: {} is not in the file, and no club is known to take it from ({}); add a column, --club NAME "
                      "where the file names none, or a [[club]] to --dictionary",
                      from.string(), option, clubs ? "'" + clubs->cells.front() + "'" : "no column of clubs"));
    return u;
  };
  if (!find("dynamic_loft")) {
    Understood u = nominal(&NominalClub::loft, "dynamic loft");
    u.header = "(nominal)";
    u.name = "dynamic_loft_deg";
    u.note = "not recorded: nominal of the club, +- 4 deg";
    columns.push_back(std::move(u));
    out.nominal_loft = true;
  }
  Understood mass = nominal(&NominalClub::head_mass, "head mass");
  mass.header = "(nominal)";
  mass.name = "head_mass_kg";
  mass.note = "not recorded: nominal of the club";
  columns.push_back(std::move(mass));
  return out;
}

/// The table of what was understood.
void show(Session& x) {
  fmt::print("{}: {} shots, cells separated by {}{}\n", x.file.string(), x.shots,
             x.sheet.delimiter == "JSON"  ? "JSON's own signs"
             : x.sheet.delimiter == "tab" ? "tabs"
                                          : "'" + x.sheet.delimiter + "'",
             x.sheet.layout.empty() ? "" : ", " + x.sheet.layout);
  if (!x.sheet.before.empty())
    fmt::print("  passed over: {} line{} before the header\n", x.sheet.before.size(),
               x.sheet.before.size() > 1 ? "s" : "");
  if (x.sheet.summaries)
    fmt::print("  passed over: {} summary row{}\n", x.sheet.summaries, x.sheet.summaries > 1 ? "s" : "");
  if (x.sheet.headers_again)
    fmt::print("  passed over: {} repeated header{}\n", x.sheet.headers_again, x.sheet.headers_again > 1 ? "s" : "");
  if (x.other_clubs) fmt::print("  left out: {} shots with other clubs\n", x.other_clubs);
  if (x.modelled)
    fmt::print("  spin modelled, not measured, left out (--modelled takes it): {} of {} shots\n", x.modelled, x.shots);
  if (x.left_handed)
    fmt::print("  left-handed, mirrored to a right-handed player's: {} of {} shots\n", x.left_handed, x.shots);
  if (const Understood* clubs = x.find("club")) {
    std::map<std::string, std::size_t> count;
    for (const std::string& name : clubs->cells) ++count[name.empty() ? "(no club)" : name];
    std::string list;
    for (const auto& [name, n] : count) list += fmt::format("{}{} {}", list.empty() ? "" : ", ", name, n);
    fmt::print("  clubs: {}\n", list);
  }
  std::size_t width = 6;
  for (const Understood& u : x.columns) width = std::max(width, u.header.size());
  fmt::print("\n  {:<{}}  {:<20} {:>6}  {:>10}\n", "column", width, "taken as", "filled", "median");
  for (const Understood& u : x.columns) {
    if (u.name.empty()) continue;
    const auto unit = split_unit(u.name).unit;
    fmt::print("  {:<{}}  {:<20} {:>6}  {:>10}{}\n", u.header, width, u.name, u.filled,
               unit && u.name != "head_mass_kg" && u.header != "(nominal)"
                   ? fmt::format("{:.4g}", u.median / unit->si + 0.0)
                   : "",
               u.note.empty() ? "" : "  " + u.note);
  }
  std::string aside;
  for (const Understood& u : x.columns)
    if (u.name.empty()) aside += (aside.empty() ? "" : ", ") + u.header + (u.note.empty() ? "" : " (" + u.note + ")");
  if (!aside.empty()) fmt::print("\n  in kept.csv only: {}\n", aside);
  if (!x.no_nominal.empty())
    fmt::print("  no nominal figures for: {}; these shots will be left out\n", fmt::join(x.no_nominal, ", "));
}

/// Several files as one: quantities in the unit of the first file that has them, a club under one name.
Session join(std::vector<Session>& sessions) {
  Session out;
  std::map<std::string, std::pair<std::string, std::string>> club_names;  // key -> name, file
  std::map<std::string, std::size_t> known;
  Understood file{.header = "file"};
  std::vector<std::string> left, right;
  for (Session& s : sessions) {
    const std::string name = s.file.filename().string();
    if (!s.find("club")) s.columns.push_back({.header = "(stated)", .name = "club", .cells = Row(s.shots, s.club)});
    for (std::string& cell : s.find("club")->cells) {
      const auto& [first, of] = club_names.try_emplace(club_key(cell), cell, name).first->second;
      if (cell != first) {
        if (club_names.try_emplace("said " + name + cell).second)
          fmt::print("  {}: '{}' is '{}' of {}: taken as one club\n", name, cell, first, of);
        cell = first;
      }
    }
    // Every file begins to number anew.
    if (Understood* shot = s.find("shot")) shot->name.clear(), shot->note = "numbers of one file";
    for (Understood& u : s.columns) {
      const std::string key = u.name.empty() ? "kept " + u.header : std::string(split_unit(u.name).stem);
      const auto at = known.try_emplace(key, out.columns.size()).first->second;
      if (at == out.columns.size())
        out.columns.push_back({.header = u.header, .name = u.name, .note = u.note, .cells = Row(out.shots)});
      Understood& all = out.columns[at];
      const auto to = split_unit(all.name).unit, from = split_unit(u.name).unit;
      const bool other_unit = !u.name.empty() && to && from && to->suffix != from->suffix;
      for (const std::string& cell : u.cells) {
        const auto x = other_unit ? number(cell, false, false) : std::nullopt;
        all.cells.push_back(x ? fmt::format("{:.6g}", x->value * from->si / to->si) : cell);
      }
    }
    if (!s.carry.cells.empty() && out.carry.name.empty()) out.carry = {.name = s.carry.name, .cells = Row(out.shots)};
    for (const std::string& cell : s.carry.cells) {
      const auto x = number(cell, false, false);
      out.carry.cells.push_back(x ? fmt::format("{:.6g}", x->value * si_of(s.carry.name) / si_of(out.carry.name)) : "");
    }
    out.shots += s.shots;
    if (!out.carry.name.empty()) out.carry.cells.resize(out.shots);
    for (Understood& u : out.columns) u.cells.resize(out.shots);
    file.cells.resize(out.shots, name);
    out.nominal_loft |= s.nominal_loft;
    (s.left_handed ? left : right).push_back(name);
  }
  for (Understood& u : out.columns)
    if (!u.name.empty() && split_unit(u.name).unit) count_again(u);
    else u.filled = std::size_t(std::ranges::count_if(u.cells, [](const std::string& c) { return !c.empty(); }));
  file.filled = out.shots;
  out.columns.push_back(std::move(file));
  if (!left.empty() && !right.empty())
    fmt::print("  the hands differ: left-handed shots in {}; none in {}. Is it one player?\n", fmt::join(left, ", "),
               fmt::join(right, ", "));
  const auto recorded = std::ranges::count(sessions, false, &Session::nominal_loft);
  if (out.nominal_loft && recorded > 0)
    fmt::print("  dynamic loft is recorded in {} of {} files: it counts as unknown by 4 deg in all of them\n", recorded,
               sessions.size());
  return out;
}

/// Mean and standard deviation of what is measured, a line for each club.
void show_clubs(Session& all) {
  struct Shown {
    std::string_view title, unit;
    std::vector<double> value;  ///< NaN: not measured
    int digits;
  };
  std::vector<Shown> shown;
  const auto add = [&](std::string_view title, const Understood* u, std::string_view unit, int digits) {
    if (!u) return;
    Shown column{title, unit, {}, digits};
    for (const std::string& cell : u->cells) {
      const auto x = number(cell, false, false);
      column.value.push_back(x ? x->value : std::nan(""));
    }
    shown.push_back(std::move(column));
  };
  for (const auto& [stem, title, digits] :
       {std::tuple{"ball_speed", "ball speed", 1}, {"launch_angle", "launch angle", 1}, {"spin_rate", "spin", 0}})
    if (const Understood* u = all.find(stem)) add(title, u, split_unit(u->name).unit->suffix, digits);
  add("carry", all.carry.cells.empty() ? nullptr : &all.carry, all.carry.name, 1);

  const Row& clubs = all.find("club")->cells;
  Row names;
  std::size_t width = 4;
  for (const std::string& name : clubs)
    if (!std::ranges::count(names, name)) names.push_back(name), width = std::max(width, name.size());
  fmt::print("\n  {:<{}}  {:>5}", "club", width, "shots");
  for (const Shown& s : shown) fmt::print("  {:>18}", fmt::format("{} [{}]", s.title, s.unit));
  fmt::print("\n");
  for (const std::string& name : names) {
    fmt::print("  {:<{}}  {:>5}", name.empty() ? "?" : name, width, std::ranges::count(clubs, name));
    for (const Shown& s : shown) {
      double n = 0, sum = 0, squares = 0;
      for (std::size_t i = 0; i < clubs.size(); ++i)
        if (clubs[i] == name && std::isfinite(s.value[i])) ++n, sum += s.value[i];
      for (std::size_t i = 0; i < clubs.size(); ++i)
        if (clubs[i] == name && std::isfinite(s.value[i])) squares += std::pow(s.value[i] - sum / n, 2);
      fmt::print("  {:>18}", n == 0   ? "-"
                             : n == 1 ? fmt::format("{:.{}f} (1 shot)", sum, s.digits)
                                      : fmt::format("{:.{}f} +- {:.{}f}", sum / n, s.digits,
                                                    std::sqrt(squares / (n - 1)), s.digits));
    }
    fmt::print("\n");
  }
  fmt::print("  mean +- standard deviation of the shots that have a reading\n");
}

}  // namespace

void import_shots(const ImportOptions& o) {
  Dictionary d;
  if (!o.dictionary.empty()) d.read(o.dictionary);
  d.read(shipped_dictionary());
  if (fs::exists(o.out)) throw InputError(fmt::format("{}: exists already; choose another --out", o.out.string()));
  if (!o.units.empty() && o.units != "imperial" && o.units != "metric") throw InputError("--units: imperial or metric");
  const ByHand by_hand = read_by_hand(o, d);
  const bool several = o.files.size() > 1;
  std::vector<Session> sessions;
  std::error_code none;
  for (const fs::path& file : o.files) {
    for (const Session& other : sessions)
      if (fs::equivalent(file, other.file, none))
        throw InputError(fmt::format("{}: given twice; its shots would count twice", file.string()));
    // An export of one club is often called by its name.
    const std::string stem = file.stem().string();
    const bool named = several && o.club.empty() && d.club(stem);
    sessions.push_back(understand(file, named ? stem : o.club, o, d, by_hand));
  }
  if (several)
    for (Session& s : sessions) {
      show(s);
      if (!s.find("club") && o.club.empty()) fmt::print("  club, from the name of the file: {}\n", s.club);
      fmt::print("\n");
    }
  if (several) fmt::print("{} files:\n", sessions.size());
  Session all = several ? join(sessions) : std::move(sessions.front());

  std::vector<Understood>& columns = all.columns;
  const auto find = [&](std::string_view stem) { return all.find(stem); };
  Understood* mass = find("head_mass");
  const Understood* clubs = find("club");
  // One club's mass is the head's own, in the case, where its owner corrects it once.
  const bool one_mass = mass->filled == all.shots &&
                        std::ranges::count(mass->cells, mass->cells.front()) == std::ssize(mass->cells);
  const std::string own_mass = one_mass ? fmt::format("mass_kg = {}  # nominal\n", mass->cells.front()) : "";
  if (one_mass) mass->note += ", in case.toml";

  std::set<std::string> different;
  if (clubs) different.insert(clubs->cells.begin(), clubs->cells.end());
  // Sideways quantities want a head that turns; one head for all, so one kind of club.
  std::set<std::string> heads;
  for (const std::string& name : different)
    if (const NominalClub* entry = d.club(name)) heads.insert(entry->head);
  if (different.empty())
    if (const NominalClub* entry = d.club(o.club)) heads.insert(entry->head);
  const bool turns = find("azimuth") && heads.size() == 1 && d.heads().contains(*heads.begin());
  bool sideways = false;
  if (!turns && heads.size() > 1)  // the planar model says nothing of these
    for (const char* q : {"azimuth", "spin_axis", "sidespin"})
      if (Understood* u = find(q)) sideways = true, u->name.clear(), u->note = "the planar model has no direction";

  if (several) show_clubs(all);
  else show(all);
  if (sideways)
    fmt::print(
        "  woods and irons in one file: the case judges speed, launch angle and spin rate; --club '{}' takes one "
        "club, and its direction as well\n",
        *different.rbegin());
  if (!find("launch_angle")) fmt::print("  no column of launch angle: nothing will be judged by it\n");

  // The case.
  fs::create_directories(o.out);
  std::vector<const Understood*> good, rest;
  std::vector<std::string> good_names, rest_names;
  for (const Understood& u : columns) {
    if (one_mass && u.name == "head_mass_kg") continue;
    (u.name.empty() ? rest : good).push_back(&u);
    (u.name.empty() ? rest_names : good_names).push_back(u.name.empty() ? u.header : u.name);
  }
  write_csv(o.out / "shots.csv", good, good_names);
  if (!rest.empty()) write_csv(o.out / "kept.csv", rest, rest_names);
  std::string names;
  for (const fs::path& file : o.files) names += (names.empty() ? "" : ", ") + file.filename().string();
  const std::string title =
      (several ? fs::absolute(o.out / "").parent_path().filename() : o.files.front().stem()).string();
  std::string toml = fmt::format(
      "# Made by `hosel import` from {}. shots.csv holds what the loop uses, kept.csv the rest.\n"
      "kind  = \"loop\"\ntitle = {}\n\n[model]\nbase = \"{}\"\n\n"
      "[ball]\nmass_kg        = 0.04593\nradius_mm      = 21.335\ninertia_factor = 0.4\n",
      toml_text(names), toml_text(title + (o.club.empty() ? "" : ", " + o.club)),
      turns ? "rigid-eccentric" : "rigid-planar");
  if (turns) {
    const NominalHead& head = d.heads().at(*heads.begin());
    toml += fmt::format(
        "\n[head]  # a generic {}{}: put in your own\n{}cg_mm = {}\ninertia_kg_m2 = {}\n"
        "bulge_mm = inf  # the recorded face angle and loft are those where the ball met the face\nroll_mm  = inf\n",
        *heads.begin(), one_mass ? "" : ", whose mass stands in shots.csv", own_mass, head.cg_mm, head.inertia_kg_m2);
  } else if (one_mass) {
    toml += "\n[head]\n" + own_mass;
  }
  toml += "\n[data]\nshots = \"shots.csv\"\n";
  if (all.nominal_loft)
    toml += "[data.input_noise]\ndynamic_loft_deg = 4.0  # not recorded: the club's nominal loft, unknown by so much\n";
  if (different.size() > 2) toml += "\n[split]  # whole clubs are held out\nby = \"club\"\n";
  post::write_file(o.out / "case.toml", toml);
  fmt::print("\nwritten: {0}/case.toml, shots.csv{1}\nnext:    hosel run {0}\n", o.out.string(),
             rest.empty() ? "" : ", kept.csv");
}

}  // namespace hosel::app
