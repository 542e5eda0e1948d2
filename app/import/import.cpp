#include "app/import/import.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ranges>
#include <set>

#include "app/implausible.hpp"
#include "app/import/session.hpp"
#include "app/offer.hpp"
#include "app/reader.hpp"
#include "app/terminal.hpp"
#include "post/csv.hpp"
#include "post/file.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

/// A column under its name, or its header where it has none.
void write_csv(const fs::path& file, const std::vector<const Understood*>& columns) {
  std::string text;
  const auto line = [&](const auto& said) {
    for (const Understood* u : columns) text += (u == columns.front() ? "" : ",") + post::csv_cell(said(*u));
    text += '\n';
  };
  line([](const Understood& u) { return u.name.empty() ? u.header : u.name; });
  for (std::size_t r = 0; !columns.empty() && r < columns.front()->cells.size(); ++r)
    line([&](const Understood& u) { return u.cells[r]; });
  post::write_file(file, text);
}

/// Of what was written: shots that no blow makes.
void tell_implausible(const fs::path& out, std::vector<const Understood*> kept, const Dictionary& d) {
  std::vector<std::string> rows = implausible_rows(loop::read_shots(post::read_csv(out / "shots.csv")));
  std::erase_if(kept, [&](const Understood* u) { return d.bookkeeping_of(u->header) != "carry"; });
  for (const Understood* u : kept) {  // it is no column of shots.csv
    loop::Shots carry{.file = (out / "kept.csv").string(), .columns = {{.stem = "carry", .numeric = true}}};
    for (const std::string& cell : u->cells) {
      carry.line.push_back(carry.id.size() + 2);
      carry.id.emplace_back();
      carry.columns[0].value.push_back(si_of(unit_in(u->header)) * plain_number(cell).value_or(kNaN));
    }
    for (std::string& said : implausible_rows(carry)) rows.push_back(std::move(said));
  }
  for (const std::string& said : rows) fmt::print("  in doubt: {}\n", said);
}

/// The table of what was understood.
void show(Session& x) {
  fmt::print("{}: {}, cells separated by {}{}\n", x.file.string(), post::counted(x.shots, "shot"),
             x.sheet.delimiter == "JSON"  ? "JSON's own signs"
             : x.sheet.delimiter == "tab" ? "tabs"
                                          : "'" + x.sheet.delimiter + "'",
             x.sheet.layout.empty() ? "" : ", " + x.sheet.layout);
  const auto passed_over = [](std::size_t n, const char* one, const char* several) {
    if (n) fmt::print("  passed over: {} {}\n", n, n > 1 ? several : one);
  };
  passed_over(x.sheet.before.size(), "line before the header", "lines before the header");
  passed_over(x.sheet.summaries, "summary row", "summary rows");
  passed_over(x.sheet.speedless, "row without a speed", "rows without a speed");
  passed_over(x.sheet.notes.size(), "line of text below the header", "lines of text below the header");
  passed_over(x.sheet.headers_again, "repeated header", "repeated headers");
  passed_over(x.sheet.units_again, "repeated row of units", "repeated rows of units");
  passed_over(x.sheet.messages, "message without a shot", "messages without a shot");
  for (const std::string& told : x.told) fmt::print("  {}\n", told);
  if (x.other_clubs) fmt::print("  left out: {} with other clubs\n", post::counted(x.other_clubs, "shot"));
  if (x.modelled)
    fmt::print("  spin modelled, not measured, left out (--modelled takes it): {} of {}\n", x.modelled,
               post::counted(x.shots, "shot"));
  if (x.left_handed)
    fmt::print("  left-handed, mirrored to a right-handed player's: {} of {}\n", x.left_handed,
               post::counted(x.shots, "shot"));
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
               unit && u.name != "head_mass_kg" && !u.header.starts_with('(')
                   ? fmt::format("{:.4g}", u.median / unit->si + 0.0)
                   : "",
               u.note.empty() ? "" : "  " + u.note);
  }
  std::string aside;
  for (const Understood& u : x.columns)
    if (u.name.empty()) aside += (aside.empty() ? "" : ", ") + u.header + (u.note.empty() ? "" : " (" + u.note + ")");
  if (!aside.empty()) fmt::print("\n  in kept.csv only: {}\n", aside);
  if (!x.no_nominal.empty())
    fmt::print("  not a known club: {}; these shots will be left out\n",
               fmt::join(x.no_nominal | std::views::transform([](const std::string& n) {
                           return n.empty() ? std::string("(no club)") : n;
                         }),
                         ", "));
}

/// Several files as one: quantities in the unit of the first file that has them, a club under one name.
Session join(std::vector<Session>& sessions, const Dictionary& d) {
  Session out;
  std::map<std::string, std::pair<std::string, std::string>> club_names;  // key -> name, file
  std::map<std::string, std::size_t> known;
  Understood file{.header = "file"};
  std::vector<std::string> left, right;
  for (Session& s : sessions) {
    const std::string name = s.file.filename().string();
    if (!s.find("club")) s.columns.push_back({.header = "(stated)", .name = "club", .cells = Row(s.shots, s.club)});
    for (std::string& cell : s.find("club")->cells) {
      const auto& [first, of] = club_names.try_emplace(d.club_key(cell), cell, name).first->second;
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
        const auto x = other_unit ? plain_number(cell) : std::nullopt;
        all.cells.push_back(x ? fmt::format("{:.6g}", *x * from->si / to->si) : cell);
      }
    }
    if (!s.carry.cells.empty() && out.carry.name.empty()) out.carry = {.name = s.carry.name, .cells = Row(out.shots)};
    for (const std::string& cell : s.carry.cells) {
      const auto x = plain_number(cell);
      out.carry.cells.push_back(x ? fmt::format("{:.6g}", *x * si_of(s.carry.name) / si_of(out.carry.name)) : "");
    }
    out.shots += s.shots;
    out.left_handed += s.left_handed;
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

/// Inputs that no column has: zero in every shot, each with the standard deviation of a golfer's shots, as lines of
/// `[data.input_noise]`. `turns`: the head does, and the model asks for its direction and the place of impact.
std::string add_unrecorded(Session& all, bool turns) {
  struct Unrecorded {
    const char *stem, *unit;
    double sd;
    bool of_turning_head;
  };
  constexpr std::array<Unrecorded, 5> inputs = {{{"attack_angle", "deg", 4, false},
                                                 {"club_path", "deg", 4, true},
                                                 {"face_angle", "deg", 4, true},
                                                 {"impact_toe", "mm", 10, true},
                                                 {"impact_high", "mm", 8, true}}};
  std::string lines;
  for (const Unrecorded& u : inputs) {
    if ((u.of_turning_head && !turns) || all.find(u.stem)) continue;
    Understood column{.header = "(assumed)"};
    column.name = fmt::format("{}_{}", u.stem, u.unit);
    column.cells.assign(all.shots, "0");
    column.filled = all.shots;
    column.note = fmt::format("not recorded: zero, +- {:g} {}", u.sd, u.unit);
    lines += fmt::format("{} = {:.1f}  # not recorded: zero, unknown by so much\n", column.name, u.sd);
    all.columns.push_back(std::move(column));
  }
  return lines;
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
    for (const std::string& cell : u->cells) column.value.push_back(plain_number(cell).value_or(kNaN));
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
  std::vector<Sheet> sheets;
  std::error_code none;
  for (auto file = o.files.begin(); file != o.files.end(); ++file) {
    if (std::any_of(o.files.begin(), file, [&](const fs::path& other) { return fs::equivalent(*file, other, none); }))
      throw InputError(fmt::format("{}: given twice; its shots would count twice", file->string()));
    sheets.push_back(read_sheet(*file, d));
  }
  check_headers(o, by_hand, sheets);
  std::vector<Session> sessions;
  for (std::size_t k = 0; k < o.files.size(); ++k) {
    const fs::path& file = o.files[k];
    // An export of one club is often called by its name; a letter or a number alone is none.
    const std::string stem = file.stem().string();
    const bool named = o.club.empty() && stem.size() > 1 && stem.find_first_not_of("0123456789") != stem.npos &&
                       d.club(stem);
    sessions.push_back(understand(file, std::move(sheets[k]), named ? stem : o.club, o, d, by_hand));
  }
  if (several)
    for (Session& s : sessions) {
      show(s);
      fmt::print("\n");
    }
  if (several) fmt::print("{} files:\n", sessions.size());
  Session all = several ? join(sessions, d) : std::move(sessions.front());

  std::vector<Understood>& columns = all.columns;
  const auto find = [&](std::string_view stem) { return all.find(stem); };
  Understood* mass = find("head_mass");
  const Understood* clubs = find("club");
  // One club's mass is the head's own, in the case, where its owner corrects it once.
  const bool one_mass = mass->filled == all.shots &&
                        std::ranges::count(mass->cells, mass->cells.front()) == std::ssize(mass->cells);
  const std::string own_mass =
      one_mass ? fmt::format("mass_kg = {}{}\n", mass->cells.front(), mass->header == "(nominal)" ? "  # nominal" : "")
               : "";
  if (one_mass) mass->note += ", in case.toml";

  std::set<std::string> different;
  if (clubs) different.insert(clubs->cells.begin(), clubs->cells.end());
  // Sideways quantities want a head that turns; one head for all, so one kind of club.
  std::set<std::string> heads;
  for (const std::string& name : different)
    if (const NominalClub* entry = d.club(name)) heads.insert(entry->head);
  if (different.empty())
    if (const NominalClub* entry = d.club(all.club)) heads.insert(entry->head);
  const bool turns = find("azimuth") && heads.size() == 1 && d.heads().contains(*heads.begin());
  // Whole launches, whatever the case's model takes of them.
  bool sideways = false;
  std::vector<Understood> launches;
  for (const char* q :
       {"club", "ball_speed", "launch_angle", "azimuth", "spin_rate", "spin_axis", "backspin", "sidespin"})
    if (const Understood* u = find(q)) launches.push_back(*u);
  if (!turns && heads.size() > 1)  // the planar model says nothing of these
    for (const char* q : {"azimuth", "spin_axis", "sidespin"})
      if (Understood* u = find(q)) sideways = true, u->name.clear(), u->note = "the planar model has no direction";

  const std::size_t recorded = columns.size();
  std::string unknown = add_unrecorded(all, turns);
  if (several) show_clubs(all);
  else show(all);
  for (std::size_t k = recorded; several && k < columns.size(); ++k)
    fmt::print("  {}: {}\n", columns[k].name, columns[k].note);
  if (sideways)
    fmt::print(
        "  woods and irons in one file: the case judges speed, launch angle and spin rate; --club '{}' takes one "
        "club, and its direction as well\n",
        *different.rbegin());
  if (!find("launch_angle")) fmt::print("  no column of launch angle: nothing will be judged by it\n");

  // The case.
  fs::create_directories(o.out);
  std::vector<const Understood*> good, rest, whole;
  for (const Understood& u : columns)
    if (!one_mass || u.name != "head_mass_kg") (u.name.empty() ? rest : good).push_back(&u);
  for (const Understood& u : launches) whole.push_back(&u);
  write_csv(o.out / "shots.csv", good);
  if (!rest.empty()) write_csv(o.out / "kept.csv", rest);
  tell_implausible(o.out, rest, d);
  if (sideways) write_csv(o.out / "launches.csv", whole);
  std::string names;
  for (const fs::path& file : o.files) names += (names.empty() ? "" : ", ") + file.filename().string();
  const std::string title =
      (several ? fs::absolute(o.out / "").parent_path().filename() : o.files.front().stem()).string();
  std::string toml = fmt::format(
      "# Made by `hosel import` from {}. shots.csv holds what the loop uses{}.\n"
      "kind  = \"loop\"\ntitle = {}\n\n[model]\nbase = \"{}\"\n\n"
      "[ball]\nmass_kg        = 0.04593\nradius_mm      = 21.335\ninertia_factor = 0.4\n",
      toml_text(printable(names)), rest.empty() ? "" : ", kept.csv the rest",
      toml_text(printable(title + (o.club.empty() ? "" : ", " + o.club))), turns ? "rigid-eccentric" : "rigid-planar");
  if (turns) {
    const NominalHead& head = d.heads().at(*heads.begin());
    toml += fmt::format(
        "\n[head]  # a generic {}{}: put in your own\n{}cg_mm = {}\ninertia_kg_m2 = {}\n"
        "bulge_mm = inf  # the recorded face angle and loft are those where the ball met the face\nroll_mm  = inf\n",
        *heads.begin(), one_mass ? "" : ", whose mass stands in shots.csv", own_mass, head.cg_mm, head.inertia_kg_m2);
  } else if (one_mass) {
    toml += "\n[head]\n" + own_mass;
  }
  toml += fmt::format(
      "\n[data]\nshots = \"shots.csv\"\nlandings = \"{}\"  # a line for each club, and where its shots land\n",
      sideways ? "launches.csv" : "shots.csv");
  if (all.left_handed > 0 && all.left_handed == all.shots) toml += "mirrored = true  # the player is left-handed\n";
  if (all.nominal_loft)
    unknown += "dynamic_loft_deg = 4.0  # not recorded: the club's nominal loft, unknown by so much\n";
  if (!unknown.empty()) toml += "[data.input_noise]\n" + unknown;
  if (different.size() > 2) toml += "\n[split]  # whole clubs are held out\nby = \"club\"\n";
  post::write_file(o.out / "case.toml", toml);
  fmt::print("\nwritten: {0}/case.toml, shots.csv{1}{2}\nnext:    hosel run {0}\n", o.out.string(),
             sideways ? ", launches.csv" : "", rest.empty() ? "" : ", kept.csv");
}

}  // namespace hosel::app
