#include "app/import/session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <regex>

#include "app/reader.hpp"
#include "loop/deviation.hpp"
#include "models/flight/flight.hpp"
#include "models/rigid/rigid_planar.hpp"
#include "post/labels.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

/// Whether a cell's comma (1) or its point (-1) is the decimal one; 0 where it may as well part thousands, or has none.
int decimal_of(const std::string& cell) {
  const std::string text = figure_of(cell);
  if (text.find_first_of("0123456789") == text.npos) return 0;  // `Std.-Abw.`
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
      if (!cell.empty() && figure_of(cell).size() > 1 && cell.size() < figure_of(cell).size() + 12) {
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

/// Nines alone, or the last number that a computer's integer holds: they stand for nothing where no reading can be so.
bool fills_a_field(double value) {
  const double a = std::abs(value);
  for (const double nines : {99.0, 999.0, 9999.0, 99.9, 999.9, 9999.9, 99.99, 999.99})
    if (a == nines) return true;
  for (const int bits : {15, 16, 24, 31, 32})
    if (a == std::ldexp(1.0, bits) - 1 || a == std::ldexp(1.0, bits)) return true;
  return false;
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

/// Whether a cell answers a question with yes or with no, or with neither.
std::optional<bool> yes_or_no(const std::string& cell) {
  static const std::set<std::string> yes = {"yes", "y", "true", "1"}, no = {"no", "n", "false", "0"};
  const std::string word = plain(cell);
  return yes.contains(word) ? std::optional(true) : no.contains(word) ? std::optional(false) : std::nullopt;
}

/// A header as a person copies it.
std::string copied(const std::string& header) { return lower(trimmed(header)); }

/// Of a header in --column: by its unit as well, where it has one: `SIDE (deg)` beside `SIDE (rpm)`.
std::string header_key(const std::string& header) {
  return unit_in(header).empty() && !plain(header).empty() ? plain(header) : copied(header);
}

/// Face minus path under the name of a place on the face, as one connector writes it: nine cells in ten agree.
bool is_face_to_path(const Understood& u, const Understood* face, const Understood* path) {
  if (!face || !path || !face->filled || !path->filled) return false;
  std::size_t same = 0, seen = 0;
  const double of_face = split_unit(face->name).unit->si / si_of("deg"),
               of_path = split_unit(path->name).unit->si / si_of("deg");
  for (std::size_t i = 0; i < u.cells.size(); ++i) {
    const auto a = plain_number(u.cells[i]), f = plain_number(face->cells[i]), p = plain_number(path->cells[i]);
    if (!a || !f || !p) continue;
    ++seen;
    same += std::abs(*a - (of_face * *f - of_path * *p)) < 0.15;
  }
  return seen > 2 && 10 * same >= 9 * seen;
}

/// A blow's carry by the default law, in calm air at sea level [m].
double carry_of(double speed, double launch, double spin) {
  Launch l;
  l.velocity = speed * Vec3(std::cos(launch), 0, std::sin(launch));
  l.spin = Vec3(0, -spin, 0);
  return models::fly(l, {}, {}).carry;
}

/// One file being understood: each step reads what the steps before it found.
class Reading {
 public:
  Reading(const fs::path& from, Sheet sheet, const ImportOptions& o, const Dictionary& d, const ByHand& by_hand)
      : o_(o), d_(d), by_hand_(by_hand) {
    out_.file = from;
    out_.sheet = std::move(sheet);
    family_ = !o.units.empty() ? o.units : out_.sheet.family;
  }

  Session run(const std::string& club) {
    club_ = club;
    find_roles();
    leave_out_unused();
    keep_one_club();
    read_columns();
    leave_out_placeholders();
    one_name_a_club();
    leave_out_static_loft();
    leave_out_modelled();
    leave_out_false_place();
    compare_with_landing();
    mirror_left_hand();
    leave_out_zeros();
    derive_face();
    leave_out_copies();
    check_speeds();
    add_nominal();
    return std::move(out_);
  }

 private:
  Understood* find(std::string_view stem) { return out_.find(stem); }

  /// Which columns are bookkeeping: of several for one role the one whose cells the dictionary knows best, then the
  /// first.
  void find_roles() {
    const Sheet& sheet = out_.sheet;
    role_.assign(sheet.names.size(), "");
    std::map<std::string, std::pair<std::size_t, std::size_t>> best;  // role -> known cells, column
    for (std::size_t c = 0; c < sheet.names.size(); ++c) {
      if (by_hand_.of(sheet.names[c], sheet.names)) continue;
      std::string r = d_.bookkeeping_of(sheet.names[c]);
      if ((r == "club" || r == "ball") && d_.quantity_of(sheet.names[c]) && is_speed(c, r)) r.clear();
      if (r.empty() && tells_how_spin_was_found(c)) r = "accuracy";
      if (r.empty() && !d_.quantity_of(sheet.names[c]) && names_hands(c)) r = "hand";
      if ((r == "club" || r == "ball") && d_.quantity_of(sheet.names[c])) role_[c] = "aside";  // names in any case
      if (r.empty() || is_empty(c)) continue;
      if (r == "accuracy") {  // one for the rate and one for the axis
        role_[c] = r;
        continue;
      }
      const auto known = r != "club" ? 1 : std::size_t(std::ranges::count_if(sheet.rows, [&](const Row& row) {
        return d_.club(row[c]) != nullptr;
      }));
      const auto [at, first] = best.try_emplace(r, known, c);
      if (!first && known > at->second.first) at->second = {known, c};
    }
    for (const auto& [r, at] : best) role_[at.second] = r;
  }

  /// A column of nothing but words for a left-handed and a right-handed player, whatever its header; or for left and
  /// right under one that may be about hands.
  bool names_hands(std::size_t c) const {
    const bool sides = d_.says("may_name_hands", out_.sheet.names[c]);
    return !is_empty(c) && std::ranges::all_of(out_.sheet.rows, [&](const Row& row) {
      return missing(row[c]) || d_.says("lefty", row[c]) || d_.says("righty", row[c]) ||
             (sides && left_hand(row[c], Asked::nothing));
    });
  }

  bool is_empty(std::size_t c) const {
    return std::ranges::all_of(out_.sheet.rows, [&](const Row& row) { return missing(row[c]); });
  }

  /// The cells of a column, those that say nothing empty.
  Row cells(std::size_t c) const {
    Row out;
    for (const Row& row : out_.sheet.rows) out.push_back(missing(row[c]) ? "" : row[c]);
    return out;
  }

  /// The unit in a column's header or in the row of units; empty where neither has one.
  std::string headed_unit(std::size_t c) const {
    const std::string unit = unit_in(out_.sheet.names[c]);
    return unit.empty() && c < out_.sheet.units.size() ? unit_of(out_.sheet.units[c]) : unit;
  }

  /// "Club" and "Ball" are names where their cells are not numbers, speeds where they are; "Ball" without a unit, and
  /// beside a column of ball speed, is a number of the ball.
  bool is_speed(std::size_t c, const std::string& role) const {
    const Sheet& sheet = out_.sheet;
    const auto same = std::ranges::count_if(
        sheet.names, [&](const std::string& n) { return d_.quantity_of(n) == d_.quantity_of(sheet.names[c]); });
    const bool unit = !headed_unit(c).empty();
    return std::ranges::all_of(sheet.rows, [&](const Row& row) {
      return missing(row[c]) || (plain_number(row[c]) && (unit || (role == "ball" && same == 1)));
    });
  }

  /// A column about spin that holds nothing but words for measured and estimated.
  bool tells_how_spin_was_found(std::size_t c) const {
    if (!says_any(out_.sheet.names[c], {"spin"})) return false;
    std::size_t said = 0;
    for (const Row& row : out_.sheet.rows) {
      if (missing(row[c])) continue;
      if (!d_.says("estimated", row[c]) && !d_.says("measured", row[c])) return false;
      ++said;
    }
    return said > 0;
  }

  std::optional<std::size_t> column_of(std::string_view role) const {
    const auto at = std::ranges::find(role_, role);
    return at == role_.end() ? std::nullopt : std::optional(std::size_t(at - role_.begin()));
  }

  /// Shots that the file itself marks as deleted, or as none of its statistics.
  void leave_out_unused() {
    std::vector<Row>& rows = out_.sheet.rows;
    for (const auto& [role, unwanted] : {std::pair{"used", false}, {"deleted", true}}) {
      const auto c = column_of(role);
      if (!c) continue;
      const auto marked = [&](const Row& row) { return yes_or_no(row[*c]) == unwanted; };
      const auto n = std::size_t(std::ranges::count_if(rows, marked));
      const std::string& header = out_.sheet.names[*c];
      if (n == rows.size()) out_.told.push_back(fmt::format("'{}' leaves out every shot: all of them stay in", header));
      else if (n > 0) {
        std::erase_if(rows, marked);
        out_.told.push_back(
            fmt::format("left out by '{}': {}; --column '{}=' takes them", header, post::counted(n, "shot"), header));
      }
    }
  }

  void keep_one_club() {
    const auto c = column_of("club");
    if (o_.club.empty() || !c) return;
    Sheet& sheet = out_.sheet;
    std::vector<std::string> names;
    for (const Row& row : sheet.rows)
      if (!std::ranges::count(names, row[*c])) names.push_back(row[*c]);
    const NominalClub* wanted = d_.club(o_.club);
    const auto is_it = [&](const std::string& name) {
      return d_.club_key(name) == d_.club_key(o_.club) || (wanted && d_.club(name) == wanted);
    };
    // `Irn` for every shot says no more than that they are of one club.
    if (names.size() == 1 && wanted && !d_.club(names[0]) && !is_it(names[0])) {
      role_[*c] = "aside";
      out_.told.push_back(fmt::format("'{}' in column '{}' is not a known club: taken as {}, by --club", names[0],
                                      sheet.names[*c], o_.club));
      return;
    }
    out_.other_clubs = sheet.rows.size();
    std::erase_if(sheet.rows, [&](const Row& row) { return !is_it(row[*c]); });
    out_.other_clubs -= sheet.rows.size();
    if (sheet.rows.empty())
      throw InputError(fmt::format("{}: no shot with club '{}'; there are: {}", out_.file.string(), o_.club,
                                   fmt::join(names, ", ")));
  }

  void read_columns() {
    const Sheet& sheet = out_.sheet;
    out_.shots = sheet.rows.size();
    find_speed_unit();
    out_.columns.reserve(sheet.names.size() + 4);  // pointers into it stay good
    std::set<std::string> quantities, said_by_hand;
    for (std::size_t c = 0; c < sheet.names.size(); ++c)
      if (const std::string* hand = by_hand_.of(sheet.names[c], sheet.names); hand && !hand->empty() && !is_empty(c))
        said_by_hand.insert(split_unit(*hand).stem);
    for (std::size_t c = 0; c < sheet.names.size(); ++c) {
      const std::string& header = sheet.names[c];
      const std::string* hand = by_hand_.of(header, sheet.names);
      const MonitorQuantity* q = nullptr;
      std::string unit;
      if (hand && !hand->empty()) {
        const SplitName part = split_unit(*hand);
        q = d_.quantity(part.stem);
        unit = std::string(part.unit->suffix);
      } else if (!hand && role_[c].empty()) {
        q = d_.quantity_of(header);
      }
      // A second column of one quantity is kept aside, and one that is empty; what --column says is the first.
      const bool beaten = q && !hand && said_by_hand.contains(q->name);
      const bool second = q && !is_empty(c) && (beaten || !quantities.insert(q->name).second);
      if (!q || second || is_empty(c)) {
        keep(c);
        if (second && out_.columns.back().name.empty())
          out_.columns.back().remark("a second column of " + post::spoken(q->name));
        continue;
      }
      if (unit.empty()) unit = unit_of_column(*q, c);
      const HeaderSign said = sign_in(header, q->sides);
      const std::string whole = copied(header);
      const bool turned = by_hand_.turned.contains(plain(header)) || by_hand_.turned.contains(whole);
      out_.columns.push_back(make_quantity(*q, c, unit, turned || said.sign < 0 ? -1 : 1, said.own));
      if (said.strange && !turned) out_.columns.back().remark("signs in the header not understood: taken as ours");
      if (q->name == "impact_toe" && said.sign == 0 && !turned && !hand && d_.says("heel_positive", header) &&
          std::ranges::none_of(sheet.rows, [&](const Row& row) {
            const auto cell = number(row[c], false, q->sides);
            return cell && cell->sided;
          }))
        out_.columns.back().remark(fmt::format(
            "no sign said: taken as towards the toe; Foresight has heel +, and --column '{}=-impact_toe_mm' turns it",
            header));
      if (!o_.modelled && !hand && (says_modelled(whole) || says_modelled(foot_note(header))))
        out_.columns.back().name.clear(), out_.columns.back().note = "modelled by the instrument; --modelled takes it";
    }
  }

  static bool says_modelled(const std::string& text) {
    return std::ranges::any_of(std::array{"estimated", "calculated", "modelled", "modeled"},
                               [&](const char* word) { return text.find(word) != text.npos; });
  }

  /// The line of the file that explains the mark behind a header: `Spin Rate (rpm)*`, `* estimated from launch data`.
  std::string foot_note(const std::string& header) const {
    for (const std::string mark : {"***", "**", "*", "\xE2\x80\xA0", "\xC2\xB9", "\xC2\xB2"}) {
      if (!header.ends_with(mark)) continue;
      std::vector<std::string> lines = out_.sheet.notes;
      for (const Row& row : out_.sheet.before) lines.push_back(trimmed(fmt::format("{}", fmt::join(row, " "))));
      for (const std::string& line : lines)
        if (line.starts_with(mark)) return lower(line);
      break;
    }
    return "";
  }

  /// In the row of a value that stands for nothing the same value stands for nothing in other columns, too, where it
  /// might be a reading.
  void leave_out_placeholders() {
    for (const auto& [row, value] : placeholders_)
      for (Understood& u : out_.columns)
        if (!u.name.empty() && split_unit(u.name).unit && plain_number(u.cells[row]) == value) {
          u.cells[row].clear();
          u.remark(fmt::format("{:g} in shot {} is no reading, as beside it", value, row + 1));
          count_again(u);
        }
  }

  /// `Loft` may be what is stamped on the club: the same in every shot, which no blow's loft is.
  void leave_out_static_loft() {
    Understood* loft = find("dynamic_loft");
    if (!loft || !d_.says("may_be_static", loft->header) || by_hand_.of(loft->header, out_.sheet.names)) return;
    const Understood* clubs = find("club");
    std::map<std::string, std::pair<std::string, std::size_t>> of;  // club -> loft, shots
    std::size_t most = 0;
    for (std::size_t i = 0; i < out_.shots; ++i) {
      if (loft->cells[i].empty()) continue;
      auto& [first, n] = of.try_emplace(clubs ? clubs->cells[i] : "", loft->cells[i], 0).first->second;
      if (first != loft->cells[i]) return;
      most = std::max(most, ++n);
    }
    if (most < 5) return;
    loft->name.clear();
    loft->note = fmt::format(
        "the same in every shot: the club's own loft, not that at impact; --column "
        "'{}=dynamic_loft_deg' takes it",
        loft->header);
  }

  /// From the header, the row of units or the first cell, of a column of distances; empty where none of them says.
  std::string stated_length(std::size_t c) const {
    std::string unit = headed_unit(c);
    for (const Row& row : out_.sheet.rows) {
      if (!unit.empty() || missing(row[c])) continue;
      if (const auto cell = number(row[c], false, Sides::none)) unit = cell->unit;
      break;
    }
    return dimension_of(unit) == Dimension::length ? unit : "";
  }

  /// From the header, the row of units or the cells; empty where none of them says.
  std::string stated_unit(const MonitorQuantity& q, std::size_t c) const {
    const Sheet& sheet = out_.sheet;
    std::string unit = headed_unit(c);
    const std::string& header = sheet.names[c];
    std::string strange = unit.empty() && c < sheet.units.size() ? strange_unit(sheet.units[c]) : "";
    if (unit.empty() && strange.empty())
      strange = strange_unit(header.substr(std::min(header.find_first_of("(["), header.size())));
    if (!strange.empty())
      throw InputError(fmt::format("{}: column '{}': the unit '{}' is not known; --column '{}={}_{}' states one",
                                   out_.file.string(), header, strange, header, q.name, q.metric));
    if (unit.empty() && q.metric == "mm" && (family_ == "si" || in_metres(c))) unit = "m";
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

  /// Places on a face that would all be within 0.05 mm of its centre are in metres.
  bool in_metres(std::size_t c) const {
    const Row said = cells(c);
    const bool comma = decimal_comma(said, out_.sheet, out_.sheet.names[c], out_.file);
    double most = 0;
    for (const std::string& cell : said)
      if (const auto x = number(cell, comma, Sides::any))
        most = std::max(most, x->unit.empty() ? std::abs(x->value) : 1);
    return most > 0 && most < 0.05;
  }

  /// Of a file that names none, by what its layout is known for or --units says, as far as its carry bears it out.
  void find_speed_unit() {
    if (family_ == "si") return;
    for (std::size_t c = 0; c < role_.size(); ++c) {
      const MonitorQuantity* q = d_.quantity_of(out_.sheet.names[c]);
      if (!q || q->name != "ball_speed" || !role_[c].empty() || by_hand_.of(out_.sheet.names[c], out_.sheet.names) ||
          !stated_unit(*q, c).empty())
        continue;
      speed_unit_ = unit_by_carry();
      by_carry_ = !speed_unit_.empty() &&
                  (family_.empty() || speed_unit_ != (family_ == "imperial" ? q->imperial : q->metric));
      if (family_.empty() && by_carry_) family_ = speed_unit_ == q->imperial ? "imperial" : "metric";
    }
  }

  std::string unit_of_column(const MonitorQuantity& q, std::size_t c) const {
    const std::string& header = out_.sheet.names[c];
    std::string unit = stated_unit(q, c);
    if (unit.empty() && (q.name == "ball_speed" || q.name == "club_speed")) unit = speed_unit_;
    if (unit.empty() && !family_.empty()) unit = family_ == "imperial" ? q.imperial : q.metric;
    if (unit.empty())
      throw InputError(
          fmt::format("{}: column '{}' has no unit; say --units imperial, --units metric or --column '{}={}_{}'",
                      out_.file.string(), header, header, q.name, q.imperial));
    if (dimension_of(unit) != dimension_of(q.metric))
      throw InputError(fmt::format("{}: column '{}': {} is no unit of {}; --column '{}={}_{}' states one",
                                   out_.file.string(), header, unit, q.name, header, q.name, q.metric));
    return unit;
  }

  /// Of the shots, in a unit; NaN where there is none.
  struct Numbers {
    std::vector<double> value;
    double si = 1;
  };

  /// The numbers of a quantity as they stand, of a role likewise; NaN where there is none.
  std::vector<double> raw(std::string_view quantity, std::string_view role = "") const {
    const Sheet& sheet = out_.sheet;
    std::vector<double> out(sheet.rows.size(), NAN);
    for (std::size_t c = 0; c < sheet.names.size(); ++c) {
      const MonitorQuantity* q = d_.quantity_of(sheet.names[c]);
      if (role.empty() ? !q || q->name != quantity || !role_[c].empty() : role_[c] != role) continue;
      const Row said = cells(c);
      const bool comma = decimal_comma(said, sheet, sheet.names[c], out_.file);
      for (std::size_t i = 0; i < said.size(); ++i)
        if (const auto x = number(said[i], comma, role.empty() ? q->sides : Sides::none)) out[i] = x->value;
      return out;
    }
    return out;
  }

  /// A file that names no unit: that of the ball's speed by which its shots carry most nearly as far as the file says.
  /// Empty where no shot has what this takes.
  std::string unit_by_carry() const {
    Numbers speed{raw("ball_speed")}, carry{raw("", "carry")};
    const Numbers launch{raw("launch_angle"), si_of("deg")}, spin{raw("spin_rate"), si_of("rpm")};
    const auto carried = column_of("carry");
    const std::string carry_unit = carried ? stated_length(*carried) : "";
    // What --units says stands; of metric units there are two.
    std::vector<std::string> units = {"mps", "kmh"};
    if (o_.units == "imperial") units = {"mph"};
    else if (family_ == "imperial") units = {"mph", "kmh", "mps"};
    else if (o_.units.empty()) units.push_back("mph");
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
    if (!told || (family_.empty() && fit != 1)) return "";
    if (!best.empty()) return best;
    throw InputError(
        fmt::format("{}: the ball's speed in {} does not fit the carry in the file; --column 'header=ball_speed_mph' "
                    "states its unit",
                    out_.file.string(), fmt::join(units, ", ")));
  }

  /// Recorded over computed carry in the median, of at most 25 shots that have speed and launch; a spin that is
  /// missing is that of a middle iron, 5,000 rpm. Nothing where there are none.
  static std::optional<double> carry_ratio(const Numbers& speed, const Numbers& launch, const Numbers& spin,
                                           const Numbers& carry) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < speed.value.size() && ratios.size() < 25; ++i) {
      const double v = speed.si * speed.value[i], a = launch.si * launch.value[i];
      if (!(v > 3 && v < 150 && a > 0.03 && a < 1.2 && carry.value[i] > 0)) continue;
      const double rate = spin.value[i] > 0 ? spin.si * spin.value[i] : 5000 * si_of("rpm");
      try {
        if (const double x = carry_of(v, a, rate); x > 0) ratios.push_back(carry.si * carry.value[i] / x);
      } catch (const solvers::NonConvergence&) {}  // no flight that ends: another shot tells
    }
    return ratios.empty() ? std::nullopt : std::optional(loop::median(ratios));
  }

  Understood make_quantity(const MonitorQuantity& q, std::size_t column, std::string unit, double sign, bool own) {
    const Sheet& sheet = out_.sheet;
    Understood out;
    out.header = sheet.names[column];
    const auto fail = [&](const std::string& why) {
      return InputError(fmt::format("{}: column '{}'{}", out_.file.string(), out.header, why));
    };
    const Row raw = cells(column);
    const bool comma = decimal_comma(raw, sheet, out.header, out_.file);
    std::vector<double> values;
    const std::string given = unit;
    if (dimension_of(unit) == Dimension::length) unit = "mm";
    else if (dimension_of(unit) == Dimension::mass) unit = "kg";
    else if (!split_unit("x_" + unit).unit) unit = q.metric;
    std::size_t others = 0, empty = 0, zeros = 0, marked = 0;
    const std::vector<bool> placeholder = find_placeholders(q, raw, given, comma);
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
      const bool zero = cell->value == 0 && !q.zero, left_out = cell->marked && !o_.modelled;
      if (placeholder[i]) {
        out.cells.emplace_back();
        ++placed[cell->value];
        placeholders_.emplace_back(i, cell->value);
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
    if (given == "m" && family_ != "si" && headed_unit(column).empty() && q.metric == "mm")
      out.remark("no unit in the file: metres, by their size");
    if (by_carry_ && (q.name == "ball_speed" || q.name == "club_speed") && stated_unit(q, column).empty())
      out.remark("no unit in the file: this one by its carry");
    if (comma) out.remark("decimal comma");
    if (sign < 0) out.remark("sign turned");
    if (others > 0) out.remark(fmt::format("cells in a unit of their own: {}", others));
    if (zeros > 0) out.remark(fmt::format("0 taken as not measured: {}", zeros));
    if (marked > 0) out.remark(fmt::format("marked as estimated, left out (--modelled takes them): {}", marked));
    if (empty > 0) out.remark(fmt::format("cells without a reading: {}", empty));
    for (const auto& [value, n] : placed) out.remark(fmt::format("{:.10g} is no reading: {}", value, n));
    if (given == "mm" && !by_hand_.of(out.header, sheet.names) && values.size() > 2 && in_metres(column))
      throw fail(
          fmt::format(": no shot is 0.05 mm from the centre of the face: it reads like m; say --column "
                      "'{}={}_m'",
                      out.header, q.name));
    out.name = q.name + "_" + unit;
    out.median = loop::median(values);
    if (!values.empty() && !(out.median >= q.low && out.median <= q.high)) {
      std::string reads;
      for (const Unit& u : all_units())
        if (u.dimension == split_unit(out.name).unit->dimension && u.suffix != given) {
          const double other = out.median / si_of(given) * u.si;
          if (other >= q.low && other <= q.high) reads += (reads.empty() ? "" : " or ") + std::string(u.suffix);
        }
      throw fail(fmt::format(": the median {:.4g} {} is no {} (allowed: {}){}; say --column '{}={}_UNIT'",
                             out.median / si_of(given), given, q.name,
                             Range{q.low, q.high}.allowed(Unit{given, *dimension_of(given), si_of(given)}),
                             reads.empty() ? "" : ": it reads like " + reads, out.header, q.name));
    }
    return out;
  }

  /// The cells whose value no reading can have, and which fill a field or stand several times among readings.
  std::vector<bool> find_placeholders(const MonitorQuantity& q, const Row& raw, const std::string& unit,
                                      bool comma) const {
    std::vector<bool> out(raw.size()), far(raw.size());
    std::map<double, std::size_t> times;
    std::vector<double> value(raw.size(), NAN);
    std::size_t inside = 0, filled = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      const auto cell = number(raw[i], comma, q.sides);
      if (!cell) continue;
      const double si = si_of(cell->unit.empty() ? unit : cell->unit) * cell->value;
      value[i] = cell->value;
      ++filled;
      if (si >= q.low && si <= q.high) {
        ++inside;
        continue;
      }
      ++times[cell->value];
      out[i] = fills_a_field(cell->value);
      far[i] = std::abs(si) > 2 * std::max(std::abs(q.low), std::abs(q.high));
    }
    for (std::size_t i = 0; i < raw.size(); ++i)
      if (far[i] && 2 * inside >= filled && times[value[i]] > 1) out[i] = true;
    return out;
  }

  /// A column that is no quantity: bookkeeping, or kept aside.
  void keep(std::size_t c) {
    const Sheet& sheet = out_.sheet;
    const std::string& header = sheet.names[c];
    Understood u;
    u.header = header.empty() ? fmt::format("column {}", c + 1) : header;
    u.cells = cells(c);
    if (role_[c] == "session")  // a day, not a second
      for (std::string& day : u.cells)
        if (!day.empty() && std::isdigit(static_cast<unsigned char>(day.front())) && day.find(':') != day.npos)
          day.erase(std::min(day.find_first_of(" T"), day.size()));
    u.filled = std::size_t(std::ranges::count_if(u.cells, [](const std::string& cell) { return !cell.empty(); }));
    if (role_[c] == "carry") {
      std::string unit = stated_length(c);
      const bool imperial = speed_unit_.empty() ? family_ == "imperial" : speed_unit_ == "mph";
      if (unit.empty() && !family_.empty()) unit = imperial ? "yd" : "m";
      if (dimension_of(unit) == Dimension::length) {
        out_.carry = {.header = header, .name = unit};
        const bool comma = decimal_comma(u.cells, sheet, header, out_.file);
        for (const std::string& cell : u.cells) {
          const auto x = number(cell, comma, Sides::none);
          const bool other = x && !x->unit.empty() && x->unit != unit, far = x && x->value > 0;
          if (!far || (other && dimension_of(x->unit) != Dimension::length)) out_.carry.cells.emplace_back();
          else if (other) out_.carry.cells.push_back(fmt::format("{:.6g}", x->value * si_of(x->unit) / si_of(unit)));
          else out_.carry.cells.push_back(x->digits);
        }
      }
    }
    const std::string role = role_[c] == "aside" ? "" : role_[c];
    if (role == "accuracy" || role == "hand" || role == "used" || role == "deleted") u.note = "read";
    else if (!role.empty() && role != "carry" && u.filled > 0) u.name = role;
    else if (std::ranges::any_of(o_.keep, [&](const std::string& k) { return letters(k) == letters(header); })) {
      u.name = plain(header);
      std::ranges::replace(u.name, ' ', '_');
      const std::string name = "kept_" + u.name;
      u.name = name;
      for (int k = 2; std::ranges::count(out_.columns, u.name, &Understood::name); ++k)
        u.name = fmt::format("{}_{}", name, k);
    }
    if (role.empty() || role == "carry") write_with_points(u);
    out_.columns.push_back(std::move(u));
  }

  /// Numbers with a decimal comma are numbers for who reads shots.csv and kept.csv, too; a date is none.
  void write_with_points(Understood& u) const {
    static const std::regex with_comma("[+-]?([0-9]+|[0-9]{1,3}([.][0-9]{3})+)(,[0-9]+)?");
    const auto is_number = [](const std::string& cell) { return cell.empty() || std::regex_match(cell, with_comma); };
    const auto has_comma = [](const std::string& cell) { return cell.find(',') != cell.npos; };
    const int decimals = decimal_of(out_.sheet);
    if (decimals < 0 || (decimals == 0 && out_.sheet.delimiter == ",") || !std::ranges::all_of(u.cells, is_number) ||
        std::ranges::none_of(u.cells, has_comma))
      return;
    for (std::string& cell : u.cells)
      if (const auto x = number(cell, true, Sides::none)) cell = x->digits;
    u.remark("decimal comma");
  }

  /// A club's first spelling for all of its shots.
  void one_name_a_club() {
    Understood* clubs = find("club");
    if (!clubs) return;
    std::map<std::string, std::string> names;
    std::set<std::string> said;
    for (std::string& cell : clubs->cells) {
      if (cell.empty()) continue;
      const std::string& first = names.try_emplace(d_.club_key(cell), cell).first->second;
      if (cell != first && said.insert(cell).second) clubs->remark(fmt::format("'{}' is '{}'", cell, first));
      cell = first;
    }
  }

  /// What the instrument modelled says nothing of the blow: its own model's answer would be explained.
  void leave_out_modelled() {
    for (std::size_t c = 0; c < role_.size(); ++c) {
      if (role_[c] != "accuracy" || o_.modelled) continue;
      const std::string& header = out_.sheet.names[c];
      // A header that the dictionary has for it is about spin in any language.
      const bool of_spin = says_any(header, {"spin"}) ||
                           (d_.bookkeeping_of(header) == "accuracy" && !says_any(header, {"accuracy"})),
                 asks = says_any(header, {"measured"}), of_axis = says_any(header, {"axis"});
      const auto estimated = [&](const std::string& cell) {
        return d_.begins_or_ends("estimated", cell) || (asks && yes_or_no(cell) == false) ||
               says_any(cell, {"estim", "calc", "model", "simul", "predict"});
      };
      const auto measured = [&](const std::string& cell) {
        return d_.begins_or_ends("measured", cell) || (asks && yes_or_no(cell) == true);
      };
      // A word that is neither leaves the spin out too, where others are known; a column of other words says nothing.
      const bool speaks = of_spin && std::ranges::any_of(out_.sheet.rows, [&](const Row& row) {
                            return estimated(row[c]) || measured(row[c]);
                          });
      std::vector<bool> rate, axis;
      for (const Row& row : out_.sheet.rows) {
        const bool open = speaks && !missing(row[c]) && !measured(row[c]);
        rate.push_back((open && !of_axis) || says_any(row[c], {"spinrate", "spin rate"}));
        axis.push_back(open || says_any(row[c], {"spinaxis", "spin axis"}));
      }
      for (const char* q : {"spin_rate", "backspin", "sidespin"})
        if (Understood* u = find(q)) out_.modelled = std::max(out_.modelled, blank(*u, rate));
      if (Understood* u = find("spin_axis")) blank(*u, axis);
    }
  }

  /// What a header asks of a hand that a yes or no answers.
  enum class Asked { nothing, left, right };
  Asked asked_by(const std::string& header) const {
    const std::string words = plain(header);
    if (d_.says("lefty", header) || words.find("left handed") != words.npos) return Asked::left;
    if (d_.says("righty", header) || words.find("right handed") != words.npos) return Asked::right;
    return Asked::nothing;
  }

  /// Whether a cell names the left hand (1), the right one (0), or says nothing of a hand.
  std::optional<bool> left_hand(const std::string& cell, Asked asked) const {
    const auto answer = yes_or_no(cell);
    if (d_.says("left_hand", cell) || d_.says("lefty", cell)) return true;
    if (d_.says("right_hand", cell) || d_.says("righty", cell) || missing(cell)) return false;
    if (asked == Asked::nothing || !answer) return {};
    return *answer == (asked == Asked::left);
  }

  /// A left-handed player's shots as a right-handed one's: what is signed towards the right turns round. The place on
  /// the face is towards the toe for both, and in-to-out, open and a fade are the same words for both.
  void mirror_left_hand() {
    const Sheet& sheet = out_.sheet;
    std::vector<bool> left(sheet.rows.size(), o_.left_handed);
    for (const Row& row : sheet.before) {  // `Player: Jo, Handedness: Left`
      std::string line = fmt::format("{}", fmt::join(row, " "));
      std::ranges::replace_if(
          line, [](char c) { return std::string_view("()[]").find(c) != std::string_view::npos; }, ' ');
      const std::vector<std::string> words = words_of(plain(line));
      for (std::size_t i = 0; i < words.size(); ++i) {  // the words beside the hand's name, not those further on
        if (!names_a_hand(words[i]) && d_.bookkeeping_of(words[i]) != "hand") continue;
        const std::string next = i + 1 < words.size() ? words[i + 1] : "";
        const bool denied = next == "no" || next == "false" || left_hand(next, Asked::nothing) == false;
        if (left_hand(next, Asked::nothing) == true ||
            (i > 0 && left_hand(words[i - 1], Asked::nothing) == true && (next.empty() || !denied)))
          left.assign(left.size(), true);
      }
    }
    for (std::size_t c = 0; c < sheet.names.size(); ++c) {
      if (role_[c] != "hand") continue;
      std::size_t right = 0;
      for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
        const auto hand = left_hand(sheet.rows[i][c], asked_by(sheet.names[c]));
        if (!hand)
          throw InputError(
              fmt::format("{}: column '{}', shot {}: '{}' is neither left nor right; --column '{}=' leaves "
                          "it out, --left-handed mirrors every shot",
                          out_.file.string(), sheet.names[c], i + 1, sheet.rows[i][c], sheet.names[c]));
        left[i] = left[i] || *hand;
        right += !*hand && !missing(sheet.rows[i][c]);
      }
      if (o_.left_handed && right > 0)
        out_.told.push_back(
            fmt::format("column '{}' says right-handed in {} of {} shots, which --left-handed mirrors "
                        "all the same",
                        sheet.names[c], right, sheet.rows.size()));
    }
    for (const char* q : {"azimuth", "spin_axis", "sidespin", "club_path", "face_angle", "face_to_path"}) {
      Understood* u = find(q);
      if (!u) continue;
      for (std::size_t i = 0; i < u->cells.size(); ++i)
        if (left[i] && !u->own[i] && !u->cells[i].empty()) u->cells[i] = negated(u->cells[i]);
      count_again(*u);
    }
    out_.left_handed = std::size_t(std::ranges::count(left, true));
  }

  /// A spin that curves the shots to the other side than the one to which the file says they curve.
  void compare_with_landing() {
    Understood* spin = find("spin_axis") ? find("spin_axis") : find("sidespin");
    const Understood* azimuth = find("azimuth");
    if (!spin || !azimuth || out_.carry.cells.empty()) return;
    const Sheet& sheet = out_.sheet;
    for (std::size_t c = 0; c < sheet.names.size(); ++c) {
      if (!d_.says("carry_side", sheet.names[c]) || !role_[c].empty() || is_empty(c)) continue;
      const Row said = cells(c);
      const bool comma = decimal_comma(said, sheet, sheet.names[c], out_.file);
      const std::string unit = stated_length(c).empty() ? out_.carry.name : stated_length(c);
      const double turn = sign_in(sheet.names[c], Sides::across).sign < 0 ? -1 : 1;
      std::vector<std::pair<double, double>> both;  // spin, and by how much the side exceeds that of a straight flight
      for (std::size_t i = 0; i < out_.shots; ++i) {
        const auto side = number(said[i], comma, Sides::across);
        const auto x = plain_number(spin->cells[i]), a = plain_number(azimuth->cells[i]),
                   carry = plain_number(out_.carry.cells[i]);
        if (!side || !x || !a || !carry || *carry <= 0) continue;
        const double across = (side->sided ? 1 : turn) * side->value * si_of(unit) / (*carry * si_of(out_.carry.name));
        both.emplace_back(*x, across - std::sin(*a * split_unit(azimuth->name).unit->si));
      }
      double n = double(both.size()), sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
      for (const auto& [x, y] : both) sx += x / n, sy += y / n;
      for (const auto& [x, y] : both) xx += (x - sx) * (x - sx), yy += (y - sy) * (y - sy), xy += (x - sx) * (y - sy);
      if (n >= 8 && xy < -0.6 * std::sqrt(xx * yy))
        spin->remark(fmt::format("shots curve to the other side by '{}': --column '{}=-{}' turns it", sheet.names[c],
                                 spin->header, spin->name));
      return;
    }
  }

  void leave_out_zeros() {
    // Zeros of the club beside no speed of it, of the axis beside no spin, and through a whole column are no readings.
    const auto silent = [&](const char* of, std::initializer_list<const char*> others) {
      const Understood* measured = find(of);
      for (const char* other : others) {
        Understood* u = find(other);
        if (!u || !u->filled) continue;
        std::vector<bool> zero, silent_zero;
        for (std::size_t i = 0; i < out_.shots; ++i) {
          zero.push_back(plain_number(u->cells[i]) == 0);
          silent_zero.push_back(zero.back() && measured && measured->cells[i].empty());
        }
        const bool all = std::size_t(std::ranges::count(zero, true)) == u->filled && out_.shots > 1;
        if (const std::size_t n = blank(*u, all ? zero : silent_zero); n > 0)
          u->remark(fmt::format("0 taken as not measured: {}", n));
      }
    };
    silent("club_speed", {"attack_angle", "club_path", "face_angle", "face_to_path", "impact_toe", "impact_high"});
    silent("spin_rate", {"spin_axis", "sidespin"});
    silent("ball_speed", {"azimuth"});
  }

  void leave_out_false_place() {
    if (Understood* u = find("impact_toe"); u && is_face_to_path(*u, find("face_angle"), find("club_path")))
      u->name.clear(), u->note = "holds face angle minus path";
  }

  void derive_face() {
    // The face is path and face-to-path together, where it is not recorded by itself.
    if (Understood* across = find("face_to_path")) {
      const Understood* path = find("club_path");
      if (path && across->filled && path->filled && !find("face_angle")) {
        Understood face;
        face.header = across->header + " + " + path->header;
        face.name = "face_angle_deg";
        const double a = split_unit(across->name).unit->si, p = split_unit(path->name).unit->si;
        for (std::size_t i = 0; i < out_.shots; ++i) {
          const auto x = plain_number(across->cells[i]), y = plain_number(path->cells[i]);
          face.cells.push_back(x && y ? fmt::format("{:.6g}", (a * *x + p * *y) / si_of("deg")) : "");
        }
        count_again(face);
        out_.columns.push_back(std::move(face));
      }
      across = find("face_to_path");
      across->name.clear(), across->note = "face minus path";
    }
  }

  void leave_out_copies() {
    // Spin stands twice in most exports: rate and tilt are what is measured, back and side follow from them.
    // Where a row has the one and not the other, nothing follows.
    Understood *rate = find("spin_rate"), *axis = find("spin_axis"), *back = find("backspin"), *side = find("sidespin");
    if (rate && rate->filled && axis && axis->filled) {
      const auto has = [](const Understood* u, std::size_t row) { return u && !u->cells[row].empty(); };
      bool follows = true;
      for (std::size_t row = 0; row < rate->cells.size(); ++row)
        follows = follows && (has(rate, row) && has(axis, row) ? true : !has(back, row) && !has(side, row));
      for (Understood* u : {back, side})
        if (u && follows) u->name.clear(), u->note = "follows from rate and axis";
    }
    for (Understood& u : out_.columns)
      if (!u.name.empty() && u.filled == 0) {
        u.name.clear();
        if (u.note.empty()) u.note = "empty";
      }
  }

  /// Two speeds check each other, and the carry in the file checks the ball's.
  void check_speeds() {
    Understood *club = find("club_speed"), *ball = find("ball_speed");
    for (const auto& [u, what] : {std::pair{ball, "ball"}, {club, "club"}}) {
      if (u) continue;
      std::string empty;                              // the file has such a column, and nothing in it
      for (std::size_t c = 0; c < role_.size(); ++c)  // `Club` may hold names
        if (const MonitorQuantity* q = d_.quantity_of(out_.sheet.names[c]);
            q && q->name == std::string(what) + "_speed" && role_[c].empty())
          empty = out_.sheet.names[c];
      if (!empty.empty())
        throw InputError(
            fmt::format("{}: column '{}' is empty: without the speed of the {} there is no blow to compute",
                        out_.file.string(), empty, what));
      list_columns(out_.sheet.names, out_.sheet.rows.front(), d_);
      throw InputError(
          fmt::format("{}: no column of {} speed; --column 'header={}_speed_mph' names one: the loop "
                      "computes the blow, which takes the speeds of club and ball",
                      out_.file.string(), what, what));
    }
    const auto said = [](const Understood& u) {
      const auto unit = split_unit(u.name).unit;
      return fmt::format("{:.4g} {}", u.median / unit->si, unit->suffix);
    };
    const auto numbers = [&](const Understood* u, double si) {
      Numbers out{std::vector<double>(out_.shots, NAN), si};
      for (std::size_t i = 0; u && i < out_.shots; ++i) out.value[i] = plain_number(u->cells[i]).value_or(NAN);
      return out;
    };
    const auto quantity = [&](std::string_view stem) {
      const Understood* u = find(stem);
      return numbers(u, u ? split_unit(u->name).unit->si : 1);
    };
    // Recorded over computed carry, with the ball's speed and the carry in these units.
    const auto carried = [&](double of_speed, double of_carry) -> std::optional<double> {
      if (out_.carry.cells.empty()) return {};
      Numbers speed = quantity("ball_speed");
      speed.si = of_speed;
      return carry_ratio(speed, quantity("launch_angle"), quantity("spin_rate"), numbers(&out_.carry, of_carry));
    };
    const double of_ball = split_unit(ball->name).unit->si, of_club = split_unit(club->name).unit->si;
    const double smash = ball->median / club->median, expected = expected_smash();
    const auto carry = carried(of_ball, si_of(out_.carry.name));
    // The unit of a speed in which `off`, a ratio that should be 1, is much nearer to it than `now`; empty: none is.
    const auto better = [](double now, double si, const auto& off) {
      std::string best;
      double least = std::min(std::log(kFits), std::abs(std::log(now)) / 2);
      for (const char* unit : {"mph", "kmh", "mps"}) {
        const std::optional<double> r = si_of(unit) == si ? std::nullopt : off(si_of(unit));
        if (r && *r > 0 && std::abs(std::log(*r)) < least) least = std::abs(std::log(*r)), best = unit;
      }
      return best;
    };
    const auto option = [](const Understood& u, const char* stem, const std::string& unit) {
      return fmt::format("--column '{}={}_{}'", u.header, stem, unit);
    };
    const bool carry_fits = carry && std::abs(std::log(*carry)) < std::log(kDoubtful);
    const bool no_blow = !(smash > 0.8 && smash < 1.62);
    if (no_blow || (expected > 0 && std::abs(std::log(smash / expected)) > std::log(kNoSmash))) {
      std::string reads;
      if (expected > 0) {
        const double now = smash / expected;
        const std::string other_club =
            better(now, of_club, [&](double si) { return std::optional(now * of_club / si); });
        const std::string other_ball =
            better(now, of_ball, [&](double si) { return std::optional(now * si / of_ball); });
        if (!other_club.empty() && (carry_fits || !carry || other_ball.empty()))
          reads =
              fmt::format("'{}' reads like {} ({})", club->header, other_club, option(*club, "club_speed", other_club));
        if (!other_ball.empty() && !carry_fits)
          reads += fmt::format("{}'{}' reads like {} ({})", reads.empty() ? "" : ", or ", ball->header, other_ball,
                               option(*ball, "ball_speed", other_ball));
      }
      if (no_blow || !reads.empty())
        throw InputError(fmt::format(
            "{}: ball over club speed is {:.2f} in the median, no blow's ({} over {}): one of the two units is wrong; "
            "{}",
            out_.file.string(), smash, said(*ball), said(*club),
            !reads.empty() ? reads
                           : fmt::format("--column '{}=ball_speed_UNIT' or '{}=club_speed_UNIT' corrects it",
                                         ball->header, club->header)));
    }
    if (!carry || carry_fits) return;
    const std::string other = better(*carry, of_ball, [&](double si) { return carried(si, si_of(out_.carry.name)); });
    std::string length;
    for (const char* unit : {"yd", "m", "ft"})
      if (const double r = *carry * si_of(unit) / si_of(out_.carry.name);
          unit != out_.carry.name && std::abs(std::log(r)) < std::log(kFits))
        length = unit;
    if (other.empty() && *carry > 1 / kCarryFits && *carry < kCarryFits) return;
    std::string reads;
    if (!other.empty()) {
      reads =
          fmt::format("; the ball's speed reads like {}, and {} says so", other, option(*ball, "ball_speed", other));
      if (of_ball == of_club) reads += fmt::format(" ({} for the club's)", option(*club, "club_speed", other));
    }
    if (!length.empty()) reads += fmt::format("; the carry reads like {}", length);
    throw InputError(
        fmt::format("{}: '{}' is {:.2f} of what the ball's speed ({}), launch angle and spin make in the median: a "
                    "unit is wrong{}; "
                    "{}--column '{}=' leaves the carry out",
                    out_.file.string(), out_.carry.header, *carry, said(*ball), reads,
                    other.empty() ? fmt::format("{} corrects the speed's, ", option(*ball, "ball_speed", "UNIT")) : "",
                    out_.carry.header));
  }

  /// Ball over club speed that a rigid head makes with the loft at impact, in the median of the shots whose loft is
  /// recorded or the club's nominal one; 0 where there is none.
  double expected_smash() {
    const Understood *loft = find("dynamic_loft"), *clubs = find("club");
    std::vector<double> ratios;
    for (std::size_t i = 0; i < out_.shots; ++i) {
      const NominalClub* club = d_.club(clubs ? clubs->cells[i] : club_);
      const auto recorded = loft ? plain_number(loft->cells[i]) : std::nullopt;
      if (!recorded && !club) continue;
      const double angle = recorded ? *recorded * split_unit(loft->name).unit->si : club->loft * si_of("deg");
      if (!(std::abs(angle) < radians(80))) continue;  // told elsewhere
      Blow blow;
      blow.delivery = {.club_speed = 40, .dynamic_loft = angle};
      blow.club.head.mass = club ? club->head_mass : 0.25;
      ratios.push_back(models::RigidPlanar().launch(blow).ball_speed() / blow.delivery.club_speed);
    }
    return ratios.empty() ? 0 : loop::median(ratios);
  }

  /// The header of a column that has no role and whose cells are clubs, by more than their numbers.
  std::string looks_like_clubs() const {
    for (std::size_t c = 0; c < role_.size(); ++c)
      if (role_[c].empty() && !out_.sheet.names[c].empty() && std::ranges::all_of(out_.sheet.rows, [&](const Row& row) {
            return d_.club(row[c]) && !plain_number(row[c]);
          }))
        return out_.sheet.names[c];
    return "header";
  }

  /// What the loop needs and the file lacks comes from the clubs' nominal figures, said as such.
  void add_nominal() {
    const Understood* clubs = find("club");
    if (!clubs) {
      out_.club = club_;
      if (!club_.empty() && club_ != o_.club)
        out_.told.push_back(fmt::format("club, from the name of the file: {}", club_));
    }
    std::vector<std::string>& unknown = out_.no_nominal;
    // Cells of a quantity, those that are empty from the shot's club.
    const auto nominal = [&](double NominalClub::*what, std::string_view option, Understood u) {
      u.cells.resize(out_.shots);
      for (std::size_t i = 0; i < out_.shots; ++i) {
        if (!u.cells[i].empty()) continue;
        const std::string name = clubs ? clubs->cells[i] : out_.club;
        const NominalClub* entry = d_.club(name);
        if (!entry && !std::ranges::count(unknown, name)) unknown.push_back(name);
        u.cells[i] = entry ? fmt::format("{:g}", entry->*what) : "";
        u.filled += entry != nullptr;
      }
      if (u.filled == 0) {
        const std::string name = clubs ? clubs->cells.front() : out_.club;
        throw InputError(
            !name.empty()
                ? fmt::format(
                      "{}: {} is not a known club, and the file has no {}: a [[club]] in --dictionary FILE makes "
                      "it known, --club NAME says which it is where every shot is of it; a column "
                      "head_mass_kg serves, too",
                      out_.file.string(), clubs ? fmt::format("'{}' ({})", name, clubs->header) : "'" + name + "'",
                      option)
                : fmt::format("{}: {} is not in the file, and no club is known to take it from (no column of clubs; "
                              "--column '{}=club' names one); --club NAME names the club of every shot",
                              out_.file.string(), option, looks_like_clubs()));
      }
      return u;
    };
    if (!find("dynamic_loft")) {
      out_.columns.push_back(nominal(&NominalClub::loft, "dynamic loft",
                                     {.header = "(nominal)",
                                      .name = "dynamic_loft_deg",
                                      .note = "not recorded: nominal of the club, +- 4 deg",
                                      .cells = {}}));
      out_.nominal_loft = true;
    }
    if (Understood* mass = find("head_mass")) {
      const std::size_t recorded = mass->filled;
      if (recorded < out_.shots) {
        *mass = nominal(&NominalClub::head_mass, "head mass", *mass);
        mass->remark(fmt::format("nominal of the club in {} of {} shots", mass->filled - recorded, out_.shots));
      }
    } else
      out_.columns.push_back(nominal(
          &NominalClub::head_mass, "head mass",
          {.header = "(nominal)", .name = "head_mass_kg", .note = "not recorded: nominal of the club", .cells = {}}));
  }

  /// Other balls, air and laws change a carry by a tenth or two, a wrong unit by a factor of 1.4 at least: beyond
  /// kCarryFits a unit is wrong, beyond kDoubtful where another brings it within kFits.
  static constexpr double kCarryFits = 1.45, kDoubtful = 1.25, kFits = 1.15;
  /// Mishits and wedges change ball over club speed by less than this, km/h under mph by 1.61.
  static constexpr double kNoSmash = 1.35;

  const ImportOptions& o_;
  const Dictionary& d_;
  const ByHand& by_hand_;
  Session out_;
  std::string club_;  ///< of every shot, where no column names it
  std::string family_;
  std::vector<std::string> role_;                             ///< of every column; empty: none
  std::vector<std::pair<std::size_t, double>> placeholders_;  ///< row and value that are no reading
  std::string speed_unit_;                                    ///< of a file that names none; empty: not known
  bool by_carry_ = false;                                     ///< it is not the layout's
};

}  // namespace

const std::string* ByHand::of(const std::string& header, const Row& headers) const {
  if (const auto at = quantity.find(copied(header)); at != quantity.end()) return &at->second;
  const auto at = quantity.find(plain(header));
  if (at == quantity.end()) return nullptr;
  for (const std::string& other : headers)
    if (other != header && plain(other) == plain(header) && copied(other) == at->first) return nullptr;
  return &at->second;
}

ByHand read_by_hand(const ImportOptions& o, Dictionary& d) {
  ByHand out;
  auto& [by_hand, turned] = out;
  for (const std::string& c : o.columns) {
    const auto at = c.rfind('=');
    if (at == std::string::npos || at == 0)
      throw InputError(fmt::format("--column '{}': header=quantity_unit is wanted", c));
    const std::string header = c.substr(0, at);
    std::string name = c.substr(at + 1);
    if (name.starts_with('-')) turned.insert(header_key(header)), name.erase(0, 1);
    by_hand[header_key(header)] = name;
    if (name.empty()) {
      d.learn(header, "");
      continue;
    }
    const std::vector<std::string> roles = d.roles();
    if (std::ranges::count(roles, name)) {
      d.learn(header, name);
      by_hand.erase(header_key(header));
      continue;
    }
    const SplitName part = split_unit(name);
    const std::vector<std::string> known = d.quantity_names();
    if (!part.unit || !std::ranges::count(known, part.stem))
      throw InputError(fmt::format("--column '{}': no such quantity with a unit, nor {}; quantities: {}", c,
                                   fmt::join(roles, ", "), fmt::join(known, ", ")));
    if (const auto wanted = dimension_of(d.quantity(part.stem)->metric); part.unit->dimension != wanted)
      throw InputError(fmt::format("--column '{}': '{}' is a unit of {}, {} wants one of {} ({}_{})", c,
                                   part.unit->suffix, hosel::name(part.unit->dimension), part.stem,
                                   hosel::name(*wanted), part.stem, d.quantity(part.stem)->metric));
    d.learn(header, part.stem);
  }
  return out;
}

void check_headers(const ImportOptions& o, const ByHand& by_hand, const std::vector<Sheet>& sheets) {
  std::vector<std::string> headers;
  for (const Sheet& sheet : sheets) headers.insert(headers.end(), sheet.names.begin(), sheet.names.end());
  const auto check = [&](const std::string& option, const std::string& said, const std::string& header,
                         const auto& is_it) {
    for (const Sheet& sheet : sheets)
      if (std::ranges::any_of(sheet.names, [&](const std::string& n) { return is_it(n, sheet.names); })) return;
    throw InputError(
        fmt::format("{} '{}': no column '{}'{}", option, said, header,
                    or_nearest(header, headers, fmt::format("; there are: {}", fmt::join(headers, ", ")))));
  };
  for (const std::string& c : o.columns) {
    const std::string header = c.substr(0, c.rfind('='));
    const auto at = by_hand.quantity.find(header_key(header));
    check("--column", c, header, [&](const std::string& name, const Row& names) {
      return at == by_hand.quantity.end() || at->second.empty() ? letters(name) == letters(header)
                                                                : by_hand.of(name, names) == &at->second;
    });
  }
  for (const std::string& k : o.keep)
    check("--keep", k, k, [&](const std::string& name, const Row&) { return letters(name) == letters(k); });
}

Understood* Session::find(std::string_view stem) {
  for (Understood& u : columns)
    if (!u.name.empty() && split_unit(u.name).stem == stem) return &u;
  return nullptr;
}

void count_again(Understood& u) {
  std::vector<double> values;
  for (const std::string& cell : u.cells)
    if (const auto x = plain_number(cell)) values.push_back(*x * split_unit(u.name).unit->si);
  u.filled = values.size();
  u.median = loop::median(values);
}

Session understand(const fs::path& from, Sheet sheet, const std::string& club, const ImportOptions& options,
                   const Dictionary& dictionary, const ByHand& by_hand) {
  return Reading(from, std::move(sheet), options, dictionary, by_hand).run(club);
}

}  // namespace hosel::app
