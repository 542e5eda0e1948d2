#include "loop/shots/shots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "golf/units.hpp"
#include "loop/deviation.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

constexpr std::array<std::string_view, 5> kBookkeeping = {"shot", "club", "ball", "player", "session"};

/// Two names of the same length but for one letter: added, left out, replaced, or swapped with its neighbour.
bool misspelt(std::string_view name, std::string_view meant) {
  if (name == meant || name.size() + 1 < meant.size() || name.size() > meant.size() + 1) return false;
  const auto [a, b] = std::ranges::mismatch(name, meant);
  const std::string_view x(a, name.end()), y(b, meant.end());
  if (name.size() < meant.size()) return x == y.substr(1);
  if (name.size() > meant.size()) return x.substr(1) == y;
  return x.substr(1) == y.substr(1) || (x.size() > 1 && x[0] == y[1] && x[1] == y[0] && x.substr(2) == y.substr(2));
}

/// Number of different values, at most twenty.
std::size_t different(const std::vector<double>& values) {
  std::set<double> seen;
  for (const double x : values)
    if (std::isfinite(x) && seen.size() < 20) seen.insert(x);
  return seen.size();
}

/// The step of a recording with so many decimals, and a coarser one that all values share (100 rpm recorded without
/// decimals), in the values' unit.
double shared_step(const std::vector<double>& values, double step) {
  if (different(values) < kFewestDifferent) return step;
  for (const double factor : {100.0, 50.0, 20.0, 10.0, 5.0, 2.0}) {
    const auto off = [&](double x) {
      const double q = x / (step * factor);
      return std::isfinite(x) && std::abs(q - std::round(q)) > 1e-6;
    };
    if (std::ranges::none_of(values, off)) return step * factor;
  }
  return step;
}

constexpr double kAstray = 0.02;  // share of the cells that may be written otherwise

/// The most digits that at least 2 % of the cells with a value carry; none: there is no value.
std::optional<int> most_digits(const std::vector<std::string>& cells, const std::vector<double>& native,
                               int (*digits_of)(const std::string&)) {
  std::map<int, std::size_t> count;
  std::size_t n = 0;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (std::isfinite(native[i])) ++count[digits_of(cells[i])], ++n;
  std::optional<int> digits;
  for (const auto& [d, k] : count)  // rising
    if (double(k) >= std::max(1.0, kAstray * double(n))) digits = d;
  return digits;
}

/// The step of the recording, header's unit; 0 without a value.
double written_step(const std::vector<std::string>& cells, const std::vector<double>& native) {
  const std::optional<int> digits = most_digits(cells, native, post::decimals);
  return digits ? std::pow(10.0, -*digits) : 0;
}

/// Digits of a number from its first that is no zero.
int significant(const std::string& cell) {
  int n = 0;
  for (const char c : cell) {
    if (c == 'e' || c == 'E') break;
    if (std::isdigit(static_cast<unsigned char>(c)) && (n > 0 || c != '0')) ++n;
  }
  return n;
}

/// What the last digit of each value may be off by, header's unit. A converted column has as many decimals everywhere,
/// or as many digits: then more decimals where its values are small.
std::vector<double> last_digits(const std::vector<std::string>& cells, const std::vector<double>& native, double step) {
  const int digits = std::max(1, most_digits(cells, native, significant).value_or(1));
  std::vector<double> last(native.size(), step);
  for (std::size_t i = 0; i < native.size(); ++i)
    if (std::isfinite(native[i]) && native[i] != 0)
      last[i] = std::max(step, std::pow(10.0, std::floor(std::log10(std::abs(native[i]))) + 1 - digits));
  return last;
}

/// Values that were recorded in another unit of the same dimension and then converted lie on that unit's decimal steps
/// to within their own last digit. Then they are taken from there, as if the header said that unit. So are values of
/// the header's own unit that a program wrote with all its digits, 12.300000000000001. SI; 0: they do not.
double recorded_elsewhere(std::vector<double>& si, const Unit& unit, double step, const std::vector<double>& last) {
  constexpr double kCoarser = 4;  // than what is written; and so many bits against chance, over all different values
  constexpr double kBits = 24;
  const double apart = double(different(si));
  double best = 0;
  std::vector<double> taken;
  for (const Unit& other : units()) {
    if (other.dimension != unit.dimension) continue;
    const double astray = other.suffix == unit.suffix ? 0 : kAstray;  // share beside the steps
    for (int digits = 0; digits <= 6; ++digits) {
      const double power = std::pow(10.0, digits), coarse = other.si / power;
      const double ratio = coarse / std::max(step * unit.si, kRoundOff * coarse);
      if (ratio < kCoarser || apart * std::log2(ratio) < kBits) break;
      std::vector<double> values = si;
      std::size_t off = 0, n = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        double& x = values[i];
        if (!std::isfinite(x)) continue;
        const double whole = std::round(x / coarse);
        const double rounding = std::max(0.51 * last[i] * unit.si, kLastBits * std::abs(x));
        ++n;
        if (std::abs(x - whole * coarse) > rounding) ++off;
        else x = whole / power * other.si;
      }
      if (double(off) > astray * double(n)) continue;
      std::vector<double> there = values;
      for (double& x : there) x /= other.si;
      if (const double found = shared_step(there, 1 / power) * other.si; found > best) {
        best = found;
        taken = std::move(values);
      }
      break;
    }
  }
  if (best > 0) si = std::move(taken);
  return best;
}

Column make_column(const std::string& header, const std::vector<std::string>& cells, const post::Sheet& sheet,
                   int outputs) {
  Column c;
  c.name = header;
  const SplitName split = split_unit(header);
  c.stem = split.stem;
  if (split.unit && split.unit->dimension != Dimension::percent) c.si = split.unit->si;
  std::optional<Dimension> wanted;
  if (std::ranges::count(kBookkeeping, header)) {
    c.role = Role::bookkeeping;
    c.stem = header;
    c.si = 1;
  } else if (const auto i = input_of(c.stem)) {
    c.role = Role::input;
    wanted = quantity(*i).dimension;
  } else if (const auto o = output_of(c.stem); o && int(*o) < outputs) {
    c.role = Role::output;
    wanted = quantity(*o).dimension;
  }
  // An input that is not recognised would count as zero.
  if (c.role == Role::other) {
    std::vector<std::string_view> known;
    for (int i = 0; i < kInputs; ++i) known.push_back(stem(Input(i)));
    for (int o = 0; o < outputs; ++o) known.push_back(stem(Output(o)));
    for (const std::string_view meant : known)
      if (misspelt(c.stem, meant))
        throw DataError(fmt::format(
            "{}:1: column '{}' is no quantity of a shot; did you mean '{}'? (rename it where it is another quantity)",
            sheet.file, header, meant));
    for (int i = 0; i < kInputs && !split.unit; ++i)
      if (header == stem(Input(i)) || header.starts_with(fmt::format("{}_", stem(Input(i)))))
        wanted = quantity(Input(i)).dimension;
  }
  if (wanted && (!split.unit || split.unit->dimension != *wanted))
    throw DataError(fmt::format("{}:1: column '{}' needs a unit of {}", sheet.file, header, name(*wanted)));

  c.value.assign(cells.size(), kNaN);
  c.numeric = true;
  for (std::size_t i = 0; i < cells.size() && c.numeric; ++i) {
    if (cells[i].empty()) continue;
    if (const auto x = post::number(cells[i])) {
      if (std::isfinite(*x)) c.value[i] = *x;
      else c.broken.push_back(i);
    } else if (wanted) {
      throw DataError(
          fmt::format("{}:{}: column '{}': '{}' is not a number", sheet.file, sheet.lines[i], header, cells[i]));
    } else {
      c.numeric = false;
    }
  }
  // Names of clubs and sessions are labels even where they are written as numbers.
  if (c.role == Role::bookkeeping && header != "shot") c.numeric = false;
  if (c.numeric) {
    const double step = written_step(cells, c.value);
    const std::vector<double> last = last_digits(cells, c.value, step);
    c.resolution = shared_step(c.value, step) * c.si;
    for (double& x : c.value) x *= c.si;
    if (split.unit && c.role != Role::bookkeeping)
      c.resolution = std::max(c.resolution, recorded_elsewhere(c.value, *split.unit, step, last));
  } else {
    c.value.clear();
    c.broken.clear();
    c.text = cells;
  }
  return c;
}

/// Rows that are not, letter for letter, an earlier one. Two shots may well read alike where little is recorded: fewer
/// than twelve digits, no number of the shot. A shot that stands twice under two numbers has the same letters in every
/// column of inputs and results, with twelve digits of results. `elsewhere`: results in another file.
std::vector<std::size_t> different_rows(const post::Sheet& sheet, const std::vector<std::string>& ids,
                                        const std::map<std::string, std::vector<std::string>>& elsewhere) {
  constexpr std::ptrdiff_t kDigits = 12;
  const auto numbered = std::ranges::find(sheet.names, "shot") - sheet.names.begin();
  std::vector<std::size_t> kept;
  std::set<std::vector<std::string>> seen, struck;
  const auto digits_of = [](const std::string& cell) {
    return std::ranges::count_if(cell, [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  std::vector<bool> result, used;  // by column
  for (const std::string& name : sheet.names) {
    const std::string stem = split_unit(name).stem;
    result.push_back(output_of(stem).has_value());
    used.push_back(result.back() || input_of(stem).has_value());
  }
  for (std::size_t i = 0; i < sheet.rows(); ++i) {
    std::vector<std::string> row, shot;
    std::ptrdiff_t digits = 0, of_results = 0;
    for (std::size_t c = 0; c < sheet.columns.size(); ++c) {
      const std::string& cell = sheet.columns[c][i];
      const std::ptrdiff_t count = digits_of(cell);
      row.push_back(cell);
      digits += count;
      if (result[c]) of_results += count;
      if (used[c]) shot.push_back(cell);
    }
    if (const auto more = elsewhere.find(ids[i]); more != elsewhere.end())
      for (const std::string& cell : more->second) {
        row.push_back(cell);
        shot.push_back(cell);
        digits += digits_of(cell);
        of_results += digits_of(cell);
      }
    const bool tells = digits >= kDigits || (numbered < std::ssize(sheet.names) && !row[numbered].empty());
    const bool again = !seen.insert(std::move(row)).second && tells,
               twice = !struck.insert(std::move(shot)).second && of_results >= kDigits;
    if (!again && !twice) kept.push_back(i);
  }
  return kept;
}

/// In the order of their numbers where every row has one of its own: the order of the file then tells nothing.
void in_order_of_shots(const post::Sheet& sheet, std::vector<std::size_t>& rows) {
  const auto numbered = std::ranges::find(sheet.names, "shot");
  if (numbered == sheet.names.end()) return;
  const auto& cells = sheet.columns[numbered - sheet.names.begin()];
  std::map<double, std::size_t> by_number;
  for (const std::size_t i : rows)
    if (const auto x = post::number(cells[i]); !x || !std::isfinite(*x) || !by_number.emplace(*x, i).second) return;
  rows.clear();
  for (const auto& [number, i] : by_number) rows.push_back(i);
}

/// Columns in an order that does not depend on the file's: bookkeeping, inputs, outputs, and the others by their names
/// without units.
void in_order_of_quantities(std::vector<Column>& columns) {
  const auto place = [](const Column& c) {
    const int k = c.role == Role::input ? int(*input_of(c.stem)) : c.role == Role::output ? int(*output_of(c.stem)) : 0;
    return std::tuple(int(c.role), k, std::string_view(c.stem), std::string_view(c.name));
  };
  std::ranges::stable_sort(columns, {}, place);
}

post::Sheet only(const post::Sheet& sheet, const std::vector<std::size_t>& rows) {
  post::Sheet out{.file = sheet.file, .names = sheet.names};
  out.columns.resize(sheet.columns.size());
  for (const std::size_t i : rows) {
    for (std::size_t c = 0; c < sheet.columns.size(); ++c) out.columns[c].push_back(sheet.columns[c][i]);
    out.lines.push_back(sheet.lines[i]);
  }
  return out;
}

}  // namespace

const Column* Shots::find(std::string_view wanted) const {
  const auto it = std::ranges::find(columns, wanted, &Column::name);
  return it == columns.end() ? nullptr : &*it;
}

const Column* Shots::find_stem(std::string_view wanted) const {
  const auto it = std::ranges::find(columns, wanted, &Column::stem);
  return it == columns.end() ? nullptr : &*it;
}

std::vector<std::size_t> rows_by_value(const Shots& shots) {
  std::vector<std::size_t> rows(shots.rows());
  std::iota(rows.begin(), rows.end(), std::size_t(0));
  // A missing value before all others.
  const auto key = [](double x) { return std::pair(!std::isnan(x), std::isnan(x) ? 0.0 : x); };
  std::ranges::stable_sort(rows, [&](std::size_t a, std::size_t b) {
    for (const Column& c : shots.columns)
      if (c.numeric && c.role != Role::bookkeeping)
        if (const auto x = key(c.value[a]), y = key(c.value[b]); x != y) return x < y;
    return false;
  });
  return rows;
}

std::vector<std::string> ids_of(const post::Sheet& sheet) {
  const auto shot = std::ranges::find(sheet.names, "shot");
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < sheet.rows(); ++i) {
    const std::string cell = shot == sheet.names.end() ? "" : sheet.columns[std::size_t(shot - sheet.names.begin())][i];
    ids.push_back(cell.empty() ? std::to_string(i + 1) : cell);
  }
  return ids;
}

Shots read_shots(const post::Sheet& all, bool flights,
                 const std::map<std::string, std::vector<std::string>>& elsewhere) {
  const std::vector<std::string> ids = ids_of(all);
  std::vector<std::size_t> kept = different_rows(all, ids, elsewhere);
  in_order_of_shots(all, kept);
  const post::Sheet sheet = only(all, kept);
  Shots shots;
  shots.repeated = all.rows() - kept.size();
  shots.file = sheet.file;
  shots.line = sheet.lines;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    Column column = make_column(sheet.names[c], sheet.columns[c], sheet, flights ? kOutputs : kLaunchOutputs);
    if (column.role == Role::input || column.role == Role::output)
      if (const Column* other = shots.find_stem(column.stem))
        throw DataError(
            fmt::format("{}:1: columns '{}' and '{}' hold the same quantity", sheet.file, other->name, column.name));
    shots.columns.push_back(std::move(column));
  }
  shots.has_shot_column = std::ranges::count(sheet.names, "shot") > 0;
  for (const std::size_t i : kept) shots.id.push_back(ids[i]);
  in_order_of_quantities(shots.columns);
  return shots;
}

void join(Shots& shots, const post::Sheet& sheet, const std::string& by) {
  const Column* key = shots.find(by);
  if (!key) throw DataError(fmt::format("{}:1: no column '{}' to join by", shots.file, by));
  const auto at = std::ranges::find(sheet.names, by);
  if (at == sheet.names.end()) throw DataError(fmt::format("{}:1: no column '{}' to join by", sheet.file, by));
  const auto& keys = sheet.columns[at - sheet.names.begin()];
  std::map<std::string, std::size_t> row_of;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!row_of.emplace(keys[i], i).second)
      throw DataError(fmt::format("{}:{}: '{}' stands twice", sheet.file, sheet.lines[i], keys[i]));
  const Groups group = groups(*key);
  for (const std::string& g : group.name)
    if (!row_of.contains(g)) throw DataError(fmt::format("{}:1: no row for {} '{}'", sheet.file, by, g));

  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::string& header = sheet.names[c];
    if (header == by || header.starts_with("mean_") || header.starts_with("half_range_")) continue;
    const Column source = make_column(header, sheet.columns[c], sheet, kLaunchOutputs);
    if (source.role != Role::input) continue;
    const auto existing = std::ranges::find(shots.columns, source.stem, &Column::stem);
    Column* target = existing == shots.columns.end() ? nullptr : &*existing;
    if (!target) {
      shots.columns.push_back(source);
      target = &shots.columns.back();
      target->value.assign(shots.rows(), kNaN);
      target->broken.clear();
    }
    for (std::size_t i = 0; i < shots.rows(); ++i)
      if (std::isnan(target->value[i]) && group.of_row[i] >= 0)
        target->value[i] = source.value[row_of.at(group.name[group.of_row[i]])];
  }
  in_order_of_quantities(shots.columns);
}

Groups groups(const Column& column) {
  Groups g;
  const std::size_t n = column.numeric ? column.value.size() : column.text.size();
  g.of_row.assign(n, -1);
  std::map<std::string, int> number_of;
  for (std::size_t i = 0; i < n; ++i) {
    std::string label;
    if (column.numeric) {
      if (!std::isnan(column.value[i])) label = fmt::format("{:.12g}", column.native(i));
    } else {
      label = column.text[i];
    }
    if (label.empty()) continue;
    const auto [it, fresh] = number_of.emplace(label, int(g.name.size()));
    if (fresh) g.name.push_back(label);
    g.of_row[i] = it->second;
  }
  return g;
}

namespace {

/// A reading that only rises or only falls from shot to shot, with hardly a value twice.
bool monotone(const Shots& shots, const Column& reading) {
  const Column* shot = shots.find("shot");
  const bool numbered = shots.has_shot_column && shot && shot->numeric;
  const std::vector<int> by_order =
      rising_order(shots.rows(), [&](int i) { return numbered ? shot->value[i] : double(i); });
  std::size_t values = 0, rises = 0, falls = 0;
  double before = kNaN;
  for (const int i : by_order) {
    const double x = reading.value[i];
    if (!std::isfinite(x)) continue;
    ++values;
    rises += x > before;
    falls += x < before;
    before = x;
  }
  return values >= std::size_t(kFewestRows) && std::min(rises, falls) == 0 &&
         5 * std::max(rises, falls) >= 4 * (values - 1);
}

}  // namespace

const Column* sorted_by(const Shots& shots) {
  for (const Column& c : shots.columns)
    if (c.numeric && c.role == Role::output && monotone(shots, c)) return &c;
  if (shots.has_shot_column) return nullptr;
  for (const Column& c : shots.columns) {
    if (c.numeric) continue;
    const Groups g = groups(c);
    const std::size_t n = g.name.size();
    if (n < 3 || 2 * n > shots.rows() || !std::ranges::is_sorted(g.of_row)) continue;
    return &c;
  }
  return nullptr;
}

bool one_club_after_another(const Shots& shots) {
  const Column* c = shots.find("club");
  if (!c || c->numeric) return false;
  const Groups g = groups(*c);
  std::size_t changes = 0;
  for (std::size_t i = 1; i < g.of_row.size(); ++i) changes += g.of_row[i] != g.of_row[i - 1];
  return g.name.size() > 1 && changes + 1 == g.name.size();
}

Vec3 direction(double up, double right) {
  return {std::cos(up) * std::cos(right), -std::cos(up) * std::sin(right), std::sin(up)};
}

std::optional<double> recorded(const Shots& shots, std::size_t row, Output output) {
  const Column* c = shots.find_stem(stem(output));
  return c && c->numeric && std::isfinite(c->value[row]) ? std::optional(c->value[row]) : std::nullopt;
}

std::optional<Launch> seen_launch(const Shots& shots, std::size_t row) {
  const auto read = [&](Output o) { return recorded(shots, row, o); };
  const auto speed = read(Output::ball_speed), up = read(Output::launch_angle);
  auto back = read(Output::backspin), side = read(Output::sidespin);
  if (const auto rate = read(Output::spin_rate); !(back && side) && rate) {
    const double tilt = read(Output::spin_axis).value_or(0);
    back = *rate * std::cos(tilt);
    side = *rate * std::sin(tilt);
  }
  if (!speed || !(*speed > 0) || !up || !back) return {};
  Launch l;
  l.velocity = *speed * direction(*up, read(Output::azimuth).value_or(0));
  l.spin = Vec3(0, -*back, -side.value_or(0));
  return l;
}

}  // namespace hosel::loop
