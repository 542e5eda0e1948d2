#include "hosel/app/import/import.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "hosel/app/import/cells.hpp"
#include "hosel/app/import/sheet.hpp"
#include "hosel/app/reader.hpp"
#include "hosel/loop/median.hpp"
#include "hosel/post/csv.hpp"
#include "hosel/post/file.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

struct Understood {
  std::string header, name, note;  // name: of shots.csv; empty: goes to kept.csv
  std::vector<std::string> cells;
  std::size_t filled = 0;
  double median = 0;
};

bool decimal_comma(const std::vector<std::string>& cells, const std::string& delimiter) {
  // 94,2 is a decimal comma wherever the group after it has not three digits.
  bool any = false;
  for (const std::string& c : cells) {
    const auto comma = c.rfind(',');
    if (comma == std::string::npos) continue;
    any = true;
    std::size_t digits = 0;
    while (comma + 1 + digits < c.size() && std::isdigit(static_cast<unsigned char>(c[comma + 1 + digits]))) ++digits;
    if (digits != 3) return true;
  }
  return any && delimiter != "," && delimiter != "JSON" &&
         std::ranges::none_of(cells, [](const std::string& c) { return c.find('.') != std::string::npos; }) &&
         std::ranges::all_of(cells, [](const std::string& c) { return c.size() < 6; });
}

Understood make_quantity(const MonitorQuantity& q, const std::string& header, std::string unit, const Sheet& sheet,
                         std::size_t column, const fs::path& file) {
  Understood out;
  out.header = header;
  std::vector<std::string> raw;
  for (const Row& row : sheet.rows) raw.push_back(missing(row[column]) ? "" : row[column]);
  const bool comma = decimal_comma(raw, sheet.delimiter);
  std::vector<double> values;
  const bool convert = unit == "cm" || unit == "in";
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i].empty()) {
      out.cells.emplace_back();
      continue;
    }
    const auto cell = number(raw[i], comma, q.side);
    if (!cell)
      throw InputError(
          fmt::format("{}: column '{}', shot {}: '{}' is not a number", file.string(), header, i + 1, raw[i]));
    out.cells.push_back(convert ? fmt::format("{:.6g}", 1e3 * si_of(unit) * cell->value) : cell->digits);
    values.push_back(si_of(unit) * cell->value);
    ++out.filled;
  }
  if (convert) out.note = fmt::format("{} made mm", unit), unit = "mm";
  if (comma) out.note += out.note.empty() ? "decimal comma" : ", decimal comma";
  out.name = q.name + "_" + unit;
  out.median = loop::median(values);
  if (!values.empty() && !(out.median >= q.low && out.median <= q.high)) {
    std::string reads;
    for (const Unit& u : units())
      if (u.dimension == split_unit(out.name).unit->dimension && u.suffix != unit) {
        const double other = out.median / si_of(unit) * u.si;
        if (other >= q.low && other <= q.high) reads += (reads.empty() ? "" : " or ") + std::string(u.suffix);
      }
    throw InputError(fmt::format(
        "{}: column '{}': the median {:.4g} {} is no {} ({:.3g} to {:.3g} in SI){}; say --column '{}={}_UNIT'",
        file.string(), header, out.median / si_of(unit), unit, q.name, q.low, q.high,
        reads.empty() ? "" : ": it reads like " + reads, header, q.name));
  }
  return out;
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

}  // namespace

void import_shots(const ImportOptions& o) {
  Dictionary d;
  if (!o.dictionary.empty()) d.read(o.dictionary);
  d.read(shipped_dictionary());
  if (fs::exists(o.out)) throw InputError(fmt::format("{}: exists already; choose another --out", o.out.string()));
  if (!o.units.empty() && o.units != "imperial" && o.units != "metric") throw InputError("--units: imperial or metric");

  // By hand: header -> quantity with unit.
  std::map<std::string, std::string> by_hand;
  for (const std::string& c : o.columns) {
    const auto at = c.rfind('=');
    if (at == std::string::npos || at == 0)
      throw InputError(fmt::format("--column '{}': header=quantity_unit is wanted", c));
    const std::string name = c.substr(at + 1);
    by_hand[plain(c.substr(0, at))] = name;
    if (name.empty()) {
      d.learn(c.substr(0, at), "");
      continue;
    }
    const SplitName part = split_unit(name);
    const std::vector<std::string> known = d.quantity_names();
    if (!part.unit || !std::ranges::count(known, part.stem))
      throw InputError(
          fmt::format("--column '{}': no such quantity with a unit; quantities: {}", c, fmt::join(known, ", ")));
    d.learn(c.substr(0, at), part.stem);
  }

  Sheet sheet = read_sheet(o.file, d);
  const std::string family = !o.units.empty() ? o.units : sheet.family;

  // The club's column first: the others may be cut down to one club.
  std::vector<std::string> role(sheet.names.size());
  std::map<std::string, std::size_t> taken;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    if (by_hand.contains(plain(sheet.names[c]))) continue;
    std::string r = d.bookkeeping_of(sheet.names[c]);
    if (r == "club" && d.quantity_of(sheet.names[c])) {
      // "Club" is a name where its cells are not numbers, a speed where they are.
      if (std::ranges::all_of(sheet.rows, [&](const Row& row) {
            return missing(row[c]) || (number(row[c], false, false) && !unit_in(sheet.names[c]).empty());
          }))
        r.clear();
    }
    if (r.empty() || taken.contains(r)) continue;
    if (std::ranges::all_of(sheet.rows, [&](const Row& row) { return missing(row[c]); })) continue;
    role[c] = r;
    taken[r] = c;
  }
  std::size_t other_clubs = 0;
  if (!o.club.empty() && taken.contains("club")) {
    std::vector<std::string> names;
    for (const Row& row : sheet.rows)
      if (!std::ranges::count(names, row[taken["club"]])) names.push_back(row[taken["club"]]);
    other_clubs = sheet.rows.size();
    std::erase_if(sheet.rows, [&](const Row& row) { return plain(row[taken["club"]]) != plain(o.club); });
    other_clubs -= sheet.rows.size();
    if (sheet.rows.empty())
      throw InputError(
          fmt::format("{}: no shot with club '{}'; there are: {}", o.file.string(), o.club, fmt::join(names, ", ")));
  }

  std::vector<Understood> columns;
  columns.reserve(sheet.names.size() + 2);  // pointers into it stay good
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
      if (unit.empty() && q->imperial == q->metric) unit = q->imperial;  // degrees, rpm, mm: no monitor uses others
      if (unit.empty() && !family.empty()) unit = family == "metric" ? q->metric : q->imperial;
      if (unit.empty())
        throw InputError(
            fmt::format("{}: column '{}' has no unit; say --units imperial, --units metric or --column '{}={}_{}'",
                        o.file.string(), header, header, q->name, q->imperial));
      columns.push_back(make_quantity(*q, header, unit, sheet, c, o.file));
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
    if (!role[c].empty() && u.filled > 0) u.name = role[c];
    else if (std::ranges::any_of(o.keep, [&](const std::string& k) { return plain(k) == plain(header); }))
      u.name = "kept_" + [&] {
        std::string s = plain(header);
        std::ranges::replace(s, ' ', '_');
        return s;
      }();
    columns.push_back(std::move(u));
  }
  const auto find = [&](std::string_view stem) -> Understood* {
    for (Understood& u : columns)
      if (!u.name.empty() && split_unit(u.name).stem == stem) return &u;
    return nullptr;
  };

  // Spin stands twice in most exports: rate and tilt are what is measured, back and side follow from them.
  if (const auto* rate = find("spin_rate"), *axis = find("spin_axis"); rate && rate->filled && axis && axis->filled)
    for (const char* copy : {"backspin", "sidespin"})
      if (Understood* u = find(copy)) u->name.clear(), u->note = "follows from rate and axis";
  for (Understood& u : columns)
    if (!u.name.empty() && u.filled == 0) u.name.clear(), u.note = "empty";

  // Two speeds check each other.
  Understood *club = find("club_speed"), *ball = find("ball_speed");
  if (!ball || !club)
    throw InputError(fmt::format("{}: no column of {} speed; --column 'header={}_speed_mph' names one", o.file.string(),
                                 club ? "ball" : "club", club ? "ball" : "club"));
  const double smash = ball->median / club->median;
  if (!(smash > 0.8 && smash < 1.62))
    throw InputError(
        fmt::format("{}: ball over club speed is {:.2f} in the median, no blow's ({:.4g} {} over {:.4g} {}): one of "
                    "the two units is wrong; --column '{}=ball_speed_UNIT' or '{}=club_speed_UNIT' corrects it",
                    o.file.string(), smash, ball->median / split_unit(ball->name).unit->si,
                    split_unit(ball->name).unit->suffix, club->median / split_unit(club->name).unit->si,
                    split_unit(club->name).unit->suffix, ball->header, club->header));

  // What the loop needs and the file lacks comes from the clubs' nominal figures, said as such.
  std::vector<std::string> notes;
  const Understood* clubs = find("club");
  const std::size_t shots = sheet.rows.size();
  std::vector<std::string> unknown;
  const auto nominal = [&](double NominalClub::*what, std::string_view option) {
    Understood u;
    for (std::size_t i = 0; i < shots; ++i) {
      const std::string name = clubs ? clubs->cells[i] : o.club;
      const NominalClub* entry = d.club(name);
      if (!entry && !std::ranges::count(unknown, name)) unknown.push_back(name);
      u.cells.push_back(entry ? fmt::format("{:g}", entry->*what) : "");
      u.filled += entry != nullptr;
    }
    if (u.filled == 0)
      throw InputError(
          fmt::format("{}: {} is not in the file, and no club is known to take it from ({}); add a column or a "
                      "[[club]] to --dictionary",
                      o.file.string(), option, clubs ? "'" + clubs->cells.front() + "'" : "no column of clubs"));
    return u;
  };
  if (!find("dynamic_loft")) {
    Understood u = nominal(&NominalClub::loft, "dynamic loft");
    u.header = "(nominal)";
    u.name = "dynamic_loft_deg";
    u.note = "not recorded: nominal of the club, +- 4 deg";
    columns.push_back(std::move(u));
    notes.emplace_back("dynamic_loft_deg");
  }
  Understood mass = nominal(&NominalClub::head_mass, "head mass");
  mass.header = "(nominal)";
  mass.name = "head_mass_kg";
  mass.note = "not recorded: nominal of the club";
  // One club's mass is the head's own, in the case, where its owner corrects it once.
  const bool one_mass = mass.filled == shots &&
                        std::ranges::count(mass.cells, mass.cells.front()) == std::ssize(mass.cells);
  const std::string own_mass = one_mass ? fmt::format("mass_kg = {}  # nominal\n", mass.cells.front()) : "";
  if (one_mass) mass.note += ", in case.toml";
  columns.push_back(std::move(mass));

  // The table of what was understood.
  fmt::print("{}: {} shots, cells separated by {}{}\n", o.file.string(), shots,
             sheet.delimiter == "JSON"  ? "JSON's own signs"
             : sheet.delimiter == "tab" ? "tabs"
                                        : "'" + sheet.delimiter + "'",
             sheet.layout.empty() ? "" : ", " + sheet.layout);
  if (sheet.preamble)
    fmt::print("  passed over: {} line{} before the header\n", sheet.preamble, sheet.preamble > 1 ? "s" : "");
  if (sheet.summaries) fmt::print("  passed over: {} summary row{}\n", sheet.summaries, sheet.summaries > 1 ? "s" : "");
  if (sheet.headers_again)
    fmt::print("  passed over: {} repeated header{}\n", sheet.headers_again, sheet.headers_again > 1 ? "s" : "");
  if (other_clubs) fmt::print("  left out: {} shots with other clubs\n", other_clubs);
  std::size_t width = 6;
  for (const Understood& u : columns) width = std::max(width, u.header.size());
  fmt::print("\n  {:<{}}  {:<20} {:>6}  {:>10}\n", "column", width, "taken as", "filled", "median");
  for (const Understood& u : columns) {
    if (u.name.empty()) continue;
    const auto unit = split_unit(u.name).unit;
    fmt::print("  {:<{}}  {:<20} {:>6}  {:>10}{}\n", u.header, width, u.name, u.filled,
               unit && u.name != "head_mass_kg" && u.header != "(nominal)"
                   ? fmt::format("{:.4g}", u.median / unit->si + 0.0)
                   : "",
               u.note.empty() ? "" : "  " + u.note);
  }
  std::string aside;
  for (const Understood& u : columns)
    if (u.name.empty()) aside += (aside.empty() ? "" : ", ") + u.header + (u.note.empty() ? "" : " (" + u.note + ")");
  if (!aside.empty()) fmt::print("\n  in kept.csv only: {}\n", aside);
  if (!unknown.empty())
    fmt::print("  no nominal figures for: {}; these shots will be left out\n", fmt::join(unknown, ", "));

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
  std::set<std::string> different;
  if (clubs) different.insert(clubs->cells.begin(), clubs->cells.end());
  // Sideways quantities want a head that turns; one head for all, so one kind of club.
  std::set<std::string> heads;
  for (const std::string& name : different)
    if (const NominalClub* entry = d.club(name)) heads.insert(entry->head);
  if (different.empty())
    if (const NominalClub* entry = d.club(o.club)) heads.insert(entry->head);
  const bool turns = find("azimuth") && heads.size() == 1 && d.heads().contains(*heads.begin());
  std::string toml = fmt::format(
      "# Made by `hosel import` from {}. shots.csv holds what the loop uses, kept.csv the rest.\n"
      "kind  = \"loop\"\ntitle = {}\n\n[model]\nbase = \"{}\"\n\n"
      "[ball]\nmass_kg        = 0.04593\nradius_mm      = 21.335\ninertia_factor = 0.4\n",
      toml_text(o.file.filename().string()), toml_text(o.file.stem().string() + (o.club.empty() ? "" : ", " + o.club)),
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
  if (!turns && find("azimuth"))
    fmt::print("  clubs of several kinds: the model is planar and says nothing of direction; --club NAME takes one\n");
  toml += "\n[data]\nshots = \"shots.csv\"\n";
  if (!notes.empty())
    toml += "[data.input_noise]\ndynamic_loft_deg = 4.0  # not recorded: the club's nominal loft, unknown by so much\n";
  if (different.size() > 2) toml += "\n[split]  # whole clubs are held out\nby = \"club\"\n";
  post::write_file(o.out / "case.toml", toml);
  fmt::print("\nwritten: {0}/case.toml, shots.csv{1}\nnext:    hosel run {0}\n", o.out.string(),
             rest.empty() ? "" : ", kept.csv");
}

}  // namespace hosel::app
