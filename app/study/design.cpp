#include "app/study/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "app/read_face.hpp"
#include "app/read_sheet.hpp"
#include "post/labels.hpp"
#include "solvers/random.hpp"

namespace hosel::app {
namespace {

using FactorKind = DesignFactor::Kind;

/// A TOML text without its quotes.
std::string without_quotes(const std::string& toml) {
  const bool quoted = toml.size() > 1 && toml.front() == toml.back() && (toml.front() == '"' || toml.front() == '\'');
  return quoted ? toml.substr(1, toml.size() - 2) : toml;
}

/// The keys that a level of the factor sets.
std::set<std::string> keys_of_levels(const DesignFactor& factor) {
  std::set<std::string> out;
  for (const DesignLevel& l : factor.levels)
    for (const std::string& s : l.set)
      for (const std::string& key : keys_of(s)) out.insert(key);
  return out;
}

DesignFactor read_variants(Table root) {
  DesignFactor out{.kind = FactorKind::variants, .columns = {"variant"}};
  std::vector<std::string> taken;
  for (Table t : root.tables("variant")) {
    constexpr std::size_t most = 1000;  // each is read with the case of every one
    if (out.levels.size() == most) root.fail("variant", fmt::format("more than {}: name an [[axis]] or [rows]", most));
    DesignLevel level;
    level.cells = {t.name({"name", "of the variant"}, taken)};
    level.set = t.texts({"set", "keys that the variant changes, table.key=value"}, std::vector<std::string>{});
    for (std::size_t i = 0; i < level.set.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (!replaced(level.set[i], level.set[j]).empty())
          t.fail("set", fmt::format("gives one quantity twice: '{}' and '{}'", level.set[j], level.set[i]));
    level.from = t.place_of("set");
    t.text({"range", "where its figures come from"}, "");
    if (auto m = t.optional_table("measured")) level.measured = read_measured(*m);
    out.levels.push_back(std::move(level));
  }
  return out;
}

DesignFactor read_rows(Table t) {
  DesignFactor out{.kind = FactorKind::rows, .columns = {}};
  const auto file = t.file({"file",
                            "CSV of blows: a head with a dot is a key of the case, `name` a row's name, any "
                            "other head a measured quantity"});
  const post::Sheet sheet = read_sheet(file);
  out.levels.resize(sheet.rows());
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::string& head = sheet.names[c];
    const bool key = head.find('.') != std::string::npos, column = key || head == "name";
    if (column) out.columns.push_back(key ? head : "row");
    const auto measured = column ? std::vector<double>() : column_with_gaps(sheet, head);
    for (std::size_t r = 0; r < sheet.rows(); ++r) {
      DesignLevel& level = out.levels[r];
      level.from = fmt::format("{}:{}", sheet.file, sheet.lines[r]);
      if (column) level.cells.push_back(sheet.columns[c][r]);
      if (key) level.set.push_back(fmt::format("{}={}", head, sheet.columns[c][r]));
      if (!column && std::isfinite(measured[r])) level.measured.push_back({head, measured[r], measured[r]});
    }
  }
  for (std::size_t c = 0; c < sheet.names.size(); ++c)
    for (std::size_t other = 0; other < c; ++other)
      if (same_quantity(sheet.names[c], sheet.names[other]))
        t.fail("file", fmt::format("'{}' and '{}' are one quantity", sheet.names[other], sheet.names[c]));
  if (out.levels.empty()) t.fail("file", "holds no row");
  if (out.columns.empty()) t.fail("file", "no head is a key of the case, as delivery.club_speed_mps is");
  return out;
}

/// A value of an axis, as it stands in TOML.
DesignLevel axis_level(const std::vector<std::string>& keys, const std::string& toml, const std::string& from = {}) {
  DesignLevel l{.cells = {without_quotes(toml)}, .from = from};
  for (const std::string& key : keys) l.set.push_back(key + "=" + toml);
  return l;
}

DesignFactor grid_factor(const post::FaceGrid& grid, const std::string& from) {
  DesignFactor out{.kind = FactorKind::grid, .columns = {"delivery.impact_toe_mm", "delivery.impact_high_mm"}};
  for (std::size_t p = 0; p < grid.size(); ++p) {
    DesignLevel level{.from = from};
    for (std::size_t c = 0; c < 2; ++c) {
      const double mm = 1e3 * (c == 0 ? grid.toe_at(p) : grid.high_at(p));
      level.cells.push_back(fmt::format("{:.6g}", mm));
      level.set.push_back(fmt::format("{}={}", out.columns[c], mm));
    }
    out.levels.push_back(std::move(level));
  }
  return out;
}

}  // namespace

std::vector<MeasuredRange> read_measured(Table t) {
  std::vector<MeasuredRange> out;
  for (const std::string& key : t.keys()) {
    const Key declared{key, "measured: a number, or the lowest and the highest", "a quantity with its unit"};
    const auto [low, high] = t.number_or_range(declared);
    for (const MeasuredRange& m : out)
      if (same_quantity(m.name, key)) t.fail(key, fmt::format("and '{}' are one quantity", m.name));
    out.push_back({key, low, high});
  }
  return out;
}

std::size_t Design::size() const {
  std::size_t n = 1;
  for (const DesignFactor& f : factors_) n *= f.levels.size();
  return n;
}

void Design::add(DesignFactor factor, const Table& at, std::string_view key) {
  if (factor.levels.empty()) return;
  if (size() > kMostPoints / factor.levels.size())
    at.fail(key, fmt::format("with these values the design has more than {} points", kMostPoints));
  factors_.push_back(std::move(factor));
}

void Design::add(const post::FaceGrid& grid, const Table& at) {
  grid_ = grid;
  add(grid_factor(grid, at.place_of("grid")), at, "grid");
}

std::vector<std::string> Design::leave_out_rows(const std::function<bool(const DesignLevel&)>& absent) {
  std::vector<std::string> out;
  const auto rows = std::ranges::find(factors_, FactorKind::rows, &DesignFactor::kind);
  if (rows == factors_.end()) return out;
  std::vector<DesignLevel> present;
  for (const DesignLevel& l : rows->levels)
    if (absent(l)) out.push_back(l.cells.front());
    else present.push_back(l);
  if (present.empty()) return {};
  rows->levels = std::move(present);
  return out;
}

const DesignLevel& Design::level(std::size_t factor, std::size_t point) const {
  std::size_t block = 1;
  for (std::size_t f = factor + 1; f < factors_.size(); ++f) block *= factors_[f].levels.size();
  return factors_[factor].levels[point / block % factors_[factor].levels.size()];
}

bool Design::has(FactorKind kind) const {
  return std::ranges::find(factors_, kind, &DesignFactor::kind) != factors_.end();
}

std::string Design::varied(const std::string& key, const std::vector<std::string>& variants) const {
  for (const DesignFactor& f : factors_)
    for (const DesignLevel& l : f.levels) {
      if (f.kind == FactorKind::variants && !variants.empty() &&
          std::ranges::find(variants, l.cells.front()) == variants.end())
        continue;
      for (const std::string& s : l.set)
        for (const std::string& set : keys_of(s))
          if (same_quantity(key, set)) return set;
    }
  return "";
}

void Design::check_varied_once(const Table& root, const std::vector<std::string>& stated) const {
  const auto refuse = [&](const std::string& key, const std::string& how) {
    root.fail("", fmt::format("'{}' is varied by this study{}", key, how));
  };
  std::vector<std::set<std::string>> keys;
  for (const DesignFactor& f : factors_) keys.push_back(keys_of_levels(f));
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    const bool first = factors_[f].kind == FactorKind::variants || factors_[f].kind == FactorKind::rows;
    for (const std::string& key : keys[f]) {
      for (const std::string& s : stated) {
        // A table that comes before an axis may hold its key, in the same unit: the axis replaces that.
        const std::string own = key_of(s);
        const auto lost = [&](const std::string& other) {
          return (other == own || other != key) && replaces(key, other);
        };
        if (first ? replaces(own, key) : std::ranges::any_of(keys_of(s), lost))
          refuse(key, fmt::format(", and set to one value by `--set` or the study's `set` ({})", own));
      }
      for (std::size_t g = f + 1; g < factors_.size(); ++g)  // set later
        for (const std::string& other : keys[g])
          if (replaces(other, key) || element_of(other, key)) refuse(key, fmt::format(" twice, as '{}' too", other));
    }
  }
}

std::vector<std::string> Design::columns() const {
  std::vector<std::string> out;
  for (const DesignFactor& f : factors_) out.insert(out.end(), f.columns.begin(), f.columns.end());
  return out;
}

std::vector<std::string> Design::cells(std::size_t point) const {
  std::vector<std::string> out;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    const auto& cells = level(f, point).cells;
    out.insert(out.end(), cells.begin(), cells.end());
  }
  return out;
}

std::pair<std::size_t, std::size_t> Design::place(std::size_t column) const {
  std::size_t f = 0;
  while (column >= factors_[f].columns.size()) column -= factors_[f++].columns.size();
  return {f, column};
}

std::vector<double> Design::numbers(std::size_t column) const {
  const auto [f, c] = place(column);
  std::vector<double> out;
  for (std::size_t p = 0; p < size(); ++p) {
    const auto x = post::number(level(f, p).cells[c]);
    if (!x) return {};
    out.push_back(*x);
  }
  return out;
}

std::vector<std::string> Design::levels(std::size_t column) const {
  const auto [f, c] = place(column);
  std::vector<std::string> out;
  std::set<std::string_view> taken;
  for (const DesignLevel& l : factors_[f].levels)
    if (taken.insert(l.cells[c]).second) out.push_back(l.cells[c]);
  return out;
}

std::vector<std::string> Design::set(std::size_t point, const std::vector<std::string>& between) const {
  std::vector<std::string> first, last;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    auto& to = factors_[f].kind == FactorKind::variants || factors_[f].kind == FactorKind::rows ? first : last;
    const auto& set = level(f, point).set;
    to.insert(to.end(), set.begin(), set.end());
  }
  first.insert(first.end(), between.begin(), between.end());
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

std::vector<std::string> Design::set_with(std::size_t point, std::size_t column, std::size_t other) const {
  const auto [f, c] = place(column);
  if (factors_[f].drawn.empty()) return {};
  const auto& keys = factors_[f].drawn[c].keys;
  std::vector<std::string> out = set(point, {});
  for (std::string& s : out)
    for (const std::string& there : level(f, other).set)
      if (key_of(s) == key_of(there) && std::ranges::find(keys, key_of(s)) != keys.end()) s = there;
  return out;
}

std::string Design::refused(std::size_t point, const std::string& why) const {
  std::string row;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    const DesignLevel& l = level(f, point);
    if (factors_[f].kind == FactorKind::rows) row = l.from;
    for (const std::string& s : l.set) {
      const std::string set = fmt::format("--set {}: ", s);
      if (!why.starts_with(set)) continue;
      std::string from = l.from;
      for (const DrawnColumn& c : factors_[f].drawn)
        if (std::ranges::find(c.keys, key_of(s)) != c.keys.end()) from = c.from;
      return fmt::format("{}: {}", from, why.substr(set.size()));
    }
  }
  if (!row.empty()) return fmt::format("{}: {}", row, why);
  const std::string where = said(point);
  return where.empty() ? why : fmt::format("{} (at {})", why, where);
}

std::vector<MeasuredRange> Design::measured(std::size_t point) const {
  std::vector<MeasuredRange> out;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    const auto& own = level(f, point).measured;
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

std::string said_cell(const std::string& column, const std::string& cell, int digits) {
  if (column == "variant" || column == "row") return cell;
  const SplitName split = split_unit(column);
  const std::string name = post::label(column);
  const auto number = post::number(cell);
  return fmt::format("{} {}{}", name.substr(0, name.find(" [")),
                     number ? fmt::format("{:.{}g}", *number, digits) : cell,
                     split.unit ? " " + post::symbol(split.unit->suffix) : "");
}

std::string Design::said(std::size_t point, std::optional<FactorKind> but) const {
  std::string text;
  const auto heads = columns(), own = cells(point);
  const auto row = std::size_t(std::ranges::find(heads, "row") - heads.begin());
  const bool named = row < heads.size() && levels(row).size() == factors_[place(row).first].levels.size();
  for (std::size_t c = 0; c < heads.size(); ++c) {
    if (factors_[place(c).first].kind == but || levels(c).size() < 2 || (named && c != row && tied(c, row)))
      continue;  // a row's own name says all of it
    text += (text.empty() ? "" : ", ") + said_cell(heads[c], own[c]);
  }
  return text;
}

Design read_design(Table root) {
  Design out;
  out.add(read_variants(root), root, "variant");
  if (auto rows = root.optional_table("rows")) out.add(read_rows(*rows), root, "rows");
  if (root.has("grid")) out.add(read_face_grid(root), root);

  auto sample = root.optional_table("sample");
  const auto points = sample ? std::size_t(sample->integer({"points", "of the sample"}, 1, long(kMostPoints))) : 0;
  std::mt19937_64 random(sample ? std::uint64_t(sample->integer({"seed", "of the sample"}, 0, 1L << 62)) : 0);
  const bool latin = !sample || sample->choice({"method",
                                                "a value in each of as many strata as there are points, or "
                                                "values drawn without regard to one another"},
                                               {"latin-hypercube", "random"}, "latin-hypercube") == "latin-hypercube";
  DesignFactor sampled{.kind = FactorKind::sample};
  sampled.levels.resize(points);
  const auto draw = [&](const std::string& name, const std::vector<std::string>& keys,
                        const solvers::Distribution& spread, const std::string& from) {
    const std::vector<double> drawn = solvers::drawn(spread, points, latin, random);
    sampled.columns.push_back(name);
    sampled.drawn.push_back({keys, spread, from});
    for (std::size_t i = 0; i < points; ++i) {
      DesignLevel l = axis_level(keys, fmt::format("{}", drawn[i]));
      sampled.levels[i].cells.push_back(l.cells.front());
      sampled.levels[i].set.insert(sampled.levels[i].set.end(), l.set.begin(), l.set.end());
    }
  };
  std::vector<DesignFactor> axes;
  std::vector<std::pair<std::string, Table>> swept;
  std::vector<std::string> names, others = out.columns();  // of the axes; of what else is a column
  others.insert(others.end(), kOwnColumns.begin(), kOwnColumns.end());
  std::vector<std::pair<Table, std::string>> twice;  // values: told once the design is no larger than it may be
  for (Table t : root.tables("axis")) {
    std::vector<std::string> keys;
    if (t.has("keys")) keys = t.texts({"keys", "of the case, all set to the axis' value"});
    else keys = {t.text({"key", "of the case, with its unit"})};
    if (keys.empty()) t.fail("keys", "name at least one key");
    t.decided_by("key");
    const std::string name = t.text({"name", "of the axis in tables and figures"}, keys.front());
    for (const std::string& key : keys) {
      for (const auto& [other, table] : swept)
        if (same_quantity(key, other))
          t.fail(t.has("keys") ? "keys" : "key", fmt::format("'{}' is an axis already", other));
      swept.emplace_back(key, t);
    }
    const bool other = t.has("name") && std::ranges::find(others, name) != others.end();
    if (other || std::ranges::find(names, name) != names.end())
      t.fail("name", fmt::format("'{}' is another column of points.csv: give this axis a name of its own", name));
    names.push_back(name);
    const auto level = [&](const std::string& toml) {
      return axis_level(keys, toml, t.place_of(t.has("range") ? "range" : "values"));
    };
    DesignFactor axis{.kind = FactorKind::axis, .columns = {name}};
    if (t.has("mean")) {
      if (!sample) t.fail("mean", "a [sample] draws from a normal distribution");
      const double mean = t.number({"mean", "of a normal distribution from which the [sample] draws"});
      const double sd = t.number({"sd", "standard deviation of that distribution"}, Range::positive());
      draw(name, keys, {.kind = solvers::Distribution::Kind::normal, .mean = mean, .sd = sd}, t.place_of("mean"));
      continue;
    }
    if (!t.has("range")) {
      std::set<std::string> once;
      for (const std::string& x : t.scalars({"values", "of the key, each crossed with all other axes"})) {
        if (!once.insert(x).second) twice.emplace_back(t, x);
        axis.levels.push_back(level(x));
      }
      axes.push_back(std::move(axis));
      continue;
    }
    const auto range = t.numbers({"range", "lowest and highest value"}, 2);
    if (range[0] == range[1]) t.fail("range", "both ends are the same: state the value in its own table");
    if (!sample || t.has("count")) {
      const long count = t.integer({"count",
                                    "of values from one end of the range to the other, crossed with all other axes; "
                                    "without it the [sample] draws them"},
                                   2, long(kMostPoints));
      const bool even = t.choice({"spacing", "of the values: by equal steps, or by equal factors"},
                                 {"linear", "logarithmic"}, "linear") == "linear";
      if (!even && !(range[0] * range[1] > 0)) t.fail("range", "equal factors do not lead through zero");
      for (long i = 0; i < count; ++i) {
        const double share = double(i) / double(count - 1);
        axis.levels.push_back(level(fmt::format("{:.12g}", even ? range[0] + (range[1] - range[0]) * share
                                                                : range[0] * std::pow(range[1] / range[0], share))));
      }
      axes.push_back(std::move(axis));
      continue;
    }
    draw(name, keys, {.low = range[0], .high = range[1]}, t.place_of("range"));
  }
  if (sample && sampled.columns.empty()) sample->fail("", "no [[axis]] has a range, or a mean and sd, to draw from");
  if (sample) out.add(std::move(sampled), root, "sample");
  for (std::size_t a = 0; a < axes.size(); ++a) out.add(std::move(axes[a]), root, "axis");
  if (!twice.empty()) twice.front().first.fail("values", fmt::format("{} is there twice", twice.front().second));
  if (out.factors().empty())
    root.fail("axis", "a study varies something: name an [[axis]], a [[variant]], [rows], [grid] or [sample]");
  return out;
}

}  // namespace hosel::app
