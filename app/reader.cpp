#include "app/reader.hpp"

#include <fmt/format.h>
#include <utf8.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include "app/parse_toml.hpp"
#include "app/resolved.hpp"
#include "app/terminal.hpp"
#include "build_info.hpp"
#include "post/file.hpp"

namespace hosel::app {
namespace fs = std::filesystem;

namespace detail {

struct Document {
  fs::path directory, file;
  std::vector<std::string> overrides;
  std::shared_ptr<Inputs> inputs = std::make_shared<Inputs>();
  fs::path copies = kInputsFolder;  // folder below OUT for what this case names
  bool keys_alone = false;
  std::vector<Declared> declared;
  std::set<std::string> quantities;           // stems of those among them that have a unit
  std::set<std::string> looked_for;           // keys whose presence decided something, as the reference shows them
  std::shared_ptr<const toml::table> parsed;  // as it stands in the file: shared by all that differ by overrides alone
  toml::table root, resolved;
  toml::table defaults;                                       // of a resolved case, by dotted key
  std::set<const toml::node*> added;                          // tables of defaults alone, which stand in no case
  std::set<std::pair<const toml::table*, std::string>> kept;  // echoed for good: no defaults (Table::keep)
  std::map<const toml::node*, std::string> set;  // what `--set` put there: errors name it, not a line of the file
  std::map<const toml::table*, std::set<std::string, std::less<>>> known;  // keys asked for, per table
  std::map<const toml::table*, toml::table*> echo;                         // where each table is echoed
};
}  // namespace detail

namespace {

/// How the copy of a file is called that a case names so: as the file, behind a digest where the name has folders or is
/// that of the folder around (`case = ".."`), in which nothing may be written.
std::string copy_name(const std::string& named) {
  const fs::path path = named;
  return path.has_parent_path() || named == ".." || named == "."
             ? post::digest(named).substr(0, 8) + "-" + path.filename().string()
             : named;
}

/// Where below OUT the copy belongs; empty where none is wanted.
fs::path copy_of(const detail::Document& d, const std::string& named) {
  return d.copies.empty() ? fs::path() : d.copies / copy_name(named);
}

/// The copy beside a resolved case; empty where the case is another one or there is none.
fs::path copied(const detail::Document& d, const std::string& named) {
  const fs::path copy = d.directory / kInputsFolder / copy_name(named);
  return d.file.filename() == kResolvedCase && fs::exists(copy) ? copy : fs::path();
}

toml::table& as_table(void* node) { return *static_cast<toml::table*>(node); }

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

const Unit* find_unit(std::string_view suffix) {
  const auto all = all_units();
  const auto it = std::ranges::find(all, suffix, &Unit::suffix);
  return it == all.end() ? nullptr : &*it;
}

}  // namespace

std::string Range::allowed(std::optional<Unit> in) const {
  const double factor = in ? in->si : 1;
  const std::string_view unit = in ? in->suffix : "";
  const double lowest = std::numeric_limits<double>::lowest(), highest = std::numeric_limits<double>::max();
  const bool below = min > lowest, above = max < highest;
  const std::string space = unit.empty() ? "" : " ", more = also_infinite ? ", or inf" : "";
  if (below && above)
    return fmt::format("{}{:g} to {:g}{}{}{}", open_min ? "above " : "", min / factor, max / factor, space, unit, more);
  if (below) return fmt::format("{} {:g}{}{}{}", open_min ? "above" : "at least", min / factor, space, unit, more);
  if (above) return fmt::format("at most {:g}{}{}{}", max / factor, space, unit, more);
  return (max == highest ? "any finite number" : "any number but nan") + more;
}

namespace {

/// "an angle": the name of what a unit measures, with its article.
std::string with_article(Dimension dimension) {
  const std::string_view word = name(dimension);
  return fmt::format("{} {}", std::string_view("aeio").find(word.front()) == std::string_view::npos ? "a" : "an", word);
}

std::string offered(std::string_view stem, Dimension dimension) {
  std::string all;
  for (const Unit& u : all_units())
    if (u.dimension == dimension) all += fmt::format("{}{}_{}", all.empty() ? "" : ", ", stem, u.suffix);
  return all;
}

}  // namespace

bool Range::contains(double x) const {
  if (also_infinite && x == std::numeric_limits<double>::infinity()) return true;
  return !std::isnan(x) && (open_min ? x > min : x >= min) && x <= max;
}

std::string Range::sentence(std::optional<Unit> unit) const {
  return fmt::format("out of range (allowed: {}{}{})", allowed(unit), why.empty() ? "" : "; ", why);
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  constexpr std::size_t longest = 200;  // of a name: comparing takes the product of both lengths
  for (const std::string& c : candidates)
    if (word.size() > longest || c.size() > longest) continue;
    else if (const std::size_t d = edit_distance(word, c); d < least) {
      least = d;
      best = c;
    }
  return best;
}

std::string or_nearest(std::string_view word, const std::vector<std::string>& candidates, std::string_view otherwise) {
  const std::string near = nearest(word, candidates);
  return near.empty() ? std::string(otherwise) : fmt::format("; did you mean '{}'?", near);
}

fs::path data_directory() {
  if (const char* named = std::getenv("HOSEL_DATA")) return named;
  if (const fs::path beside = fs::path(HOSEL_SOURCE_DIR) / ".." / "shared" / "data"; fs::exists(beside))
    return beside.lexically_normal();
  return fs::path("..") / "shared" / "data";
}

namespace {

std::string dotted(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

/// The line of the file where a node of its copy stands; 0: it stands nowhere there.
unsigned line_of(const toml::node& wanted, const toml::node& copy, const toml::node& original) {
  if (&wanted == &copy) return original.source().begin.line;
  unsigned line = 0;
  if (const toml::table* of = copy.as_table(), *from = original.as_table(); of && from)
    for (auto&& [key, child] : *of)
      if (const toml::node* there = from->get(key.str()); there && !line) line = line_of(wanted, child, *there);
  if (const toml::array* of = copy.as_array(), *from = original.as_array(); of && from)
    for (std::size_t i = 0; i < std::min(of->size(), from->size()) && !line; ++i)
      line = line_of(wanted, *of->get(i), *from->get(i));
  return line;
}

/// Where a key stands: "case.toml:12", or the `--set` that put it there.
std::string place(const detail::Document& d, const toml::node& node) {
  if (const auto it = d.set.find(&node); it != d.set.end()) return "--set " + it->second;
  return fmt::format("{}:{}", d.file.string(), std::max(line_of(node, d.root, *d.parsed), 1u));
}

}  // namespace

Table::Table(std::shared_ptr<detail::Document> document, void* node, std::string path, std::string shown)
    : document_(std::move(document)), node_(node), path_(std::move(path)), shown_(std::move(shown)) {}

std::string Table::place_of(std::string_view key) const {
  const toml::table& t = as_table(node_);
  const toml::node* node = key.empty() ? nullptr : t.get(key);
  std::string name = key.empty() ? path_ : dotted(path_, key);
  if (!node && !key.empty())
    for (auto&& [stated, value] : t)  // a quantity, by its stem: as the case has it, with its unit
      if (const SplitName split = split_unit(stated.str()); split.unit && split.stem == key)
        node = &value, name = dotted(path_, stated.str());
  return fmt::format("{}{}{}", place(*document_, node ? *node : t), name.empty() ? "" : ": ", name);
}

void Table::fail(std::string_view key, std::string_view what) const {
  throw InputError(fmt::format("{}: {}", place_of(key), what));
}

namespace {

/// Common work of every typed read: mark as known, find, echo.
struct Access {
  detail::Document& document;
  toml::table& table;
  toml::node* find(std::string_view key) {
    document.known[&table].emplace(key);
    return table.get(key);
  }
  template <class T>
  void echo(std::string_view key, T&& value) {
    document.echo.at(&table)->insert_or_assign(key, std::forward<T>(value));
  }
};

/// The default as the reference says it.
template <class T>
std::optional<std::string> said(const std::optional<T>& standard, double unit = 1) {
  if (!standard) return {};
  if constexpr (std::is_arithmetic_v<T>) return fmt::format("{:g}", *standard / unit);
  std::string all;
  if constexpr (std::is_same_v<T, std::vector<double>>)
    for (const double x : *standard) all += fmt::format("{}{:g}", all.empty() ? "" : ", ", x / unit);
  return "[" + all + "]";
}

std::string list_of(std::size_t size) { return size ? fmt::format("list of {}", size) : "list of numbers"; }

toml::array as_list(const auto& values) {
  toml::array out;
  for (const auto& x : values) out.push_back(x);
  return out;
}

double read_number(const Table& t, std::string_view key, const toml::node& node) {
  const auto x = node.value<double>();
  if (!x || node.is_boolean()) t.fail(key, "expected a number");
  if (std::isnan(*x)) t.fail(key, "nan is not a value");
  return *x;
}

/// A list of `size` numbers (any where 0), each of which `check` may refuse.
std::vector<double> read_list(const Table& t, std::string_view key, const toml::node& node, std::size_t size,
                              const auto& check) {
  const toml::array* list = node.as_array();
  if (!list || (size && list->size() != size))
    t.fail(key, size ? fmt::format("expected a list of {} numbers", size) : std::string("expected a list of numbers"));
  std::vector<double> out;
  for (const toml::node& item : *list) {
    out.push_back(read_number(t, key, item));
    check(out.back());
  }
  return out;
}

/// Of a list as it stands, for the tests of its range.
std::size_t length_of(const toml::node* node, std::size_t size) {
  const toml::array* list = node ? node->as_array() : nullptr;
  return size ? size : list && !list->empty() ? list->size() : 1;
}

}  // namespace

bool Table::listed() const { return document_->keys_alone; }

void Table::declare(Key key, Declared what) {
  if (what.key.empty()) what.key = key.name;
  what.key = dotted(path_, what.key);
  what.shown = dotted(shown_, key.shown.empty() ? key.name : key.shown);
  if (!what.unit.empty()) what.shown += fmt::format("_{}", what.unit);
  what.meaning = key.meaning;
  what.decided_by = decided_by_;
  what.optional = !what.standard && document_->looked_for.contains(dotted(shown_, key.name));
  document_->declared.push_back(std::move(what));
}

bool Table::has(std::string_view key) const {
  if (listed()) document_->looked_for.insert(dotted(shown_, key));
  return as_table(node_).contains(key);
}

bool Table::set_by_command(std::string_view key) const {
  const toml::node* node = as_table(node_).get(key);
  return node && document_->set.contains(node);
}

namespace {

/// Whether a name may be this stem and a unit behind it.
bool may_be(std::string_view name, std::string_view stem) {
  return name.size() > stem.size() && name[stem.size()] == '_' && name.starts_with(stem);
}

}  // namespace

bool Table::has_quantity(std::string_view stem) const {
  if (listed()) document_->looked_for.insert(dotted(shown_, stem));
  document_->quantities.insert(dotted(shown_, stem));
  for (auto&& [key, value] : as_table(node_)) {
    if (!may_be(key.str(), stem)) continue;
    const SplitName split = split_unit(key.str());
    if (split.unit && split.stem == stem) return true;
  }
  return false;
}

namespace {

struct Found {
  std::string key;
  const Unit* unit;
  toml::node* node;  // nullptr: absent
};

std::string unknown_unit(std::string_view key, std::string_view stem, Dimension dimension) {
  return fmt::format("no unit '{}' is known, expected {} ({})", key.substr(stem.size() + 1), with_article(dimension),
                     offered(stem, dimension));
}

/// The one key of this stem, in whatever unit of the right dimension.
Found find_quantity(const Table& t, Access access, std::string_view stem, std::string_view preferred, bool required) {
  const Unit* unit = find_unit(preferred);
  if (!unit) throw std::logic_error(fmt::format("no unit '{}' for key '{}'", preferred, stem));
  std::vector<Found> found;
  const Unit* wrong = nullptr;
  std::string wrong_key;
  for (auto&& [key, node] : access.table) {
    if (key.str() == stem) {
      wrong_key = std::string(key.str());
      continue;
    }
    if (!may_be(key.str(), stem)) continue;
    const SplitName split = split_unit(key.str());
    if (!split.unit || split.stem != stem) continue;
    if (split.unit->dimension != unit->dimension) {
      wrong = find_unit(split.unit->suffix);
      wrong_key = std::string(key.str());
      continue;
    }
    found.push_back({std::string(key.str()), find_unit(split.unit->suffix), &node});
  }
  if (found.size() > 1) t.fail(found[1].key, fmt::format("given twice, also as '{}'", found[0].key));
  if (found.size() == 1) {
    access.find(found[0].key);
    return found[0];
  }
  if (!wrong_key.empty()) {
    const std::string all = offered(stem, unit->dimension);
    if (wrong)
      t.fail(wrong_key, fmt::format("unit '{}' is {}, expected {} ({})", wrong->suffix, with_article(wrong->dimension),
                                    with_article(unit->dimension), all));
    t.fail(wrong_key, fmt::format("has no unit, expected {} ({})", with_article(unit->dimension), all));
  }
  const std::string key = fmt::format("{}_{}", stem, preferred);
  if (required) {
    // A misspelt key is the likeliest reason for a missing one: name it and its line.
    for (auto&& [other, node] : access.table) {
      if (access.document.known[&access.table].contains(other.str())) continue;
      if (edit_distance(other.str(), key) <= std::max<std::size_t>(2, key.size() / 4))
        t.fail(other.str(), fmt::format("unknown key; did you mean '{}'?", key));
    }
    for (auto&& [other, node] : access.table)
      if (other.str().starts_with(fmt::format("{}_", stem)) && !split_unit(other.str()).unit &&
          !access.document.known[&access.table].contains(other.str()))
        t.fail(other.str(), unknown_unit(other.str(), stem, unit->dimension));
    t.fail("", fmt::format("'{}' is missing", key));
  }
  access.find(key);
  return {key, unit, nullptr};
}

/// A number as the resolved case has it: with it a default is the same when that case is read.
double as_echoed(double x) { return std::isfinite(x) ? std::stod(fmt::format("{:.15g}", x)) : x; }

}  // namespace

namespace {

/// A value as it is stated, in SI. An end of the range is itself in any unit: 350 g is 0.35 kg to the last digit.
double to_si(double x, const Unit& unit, const Range& range) {
  const double y = x * unit.si;
  for (const double end : {range.min, range.max})
    if (std::isfinite(end) && std::abs(y - end) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(end))
      return end;
  return y;
}

}  // namespace

double Table::quantity(Key key, std::string_view unit, Range si, std::optional<double> standard) {
  Access access{*document_, as_table(node_)};
  const Found f = find_quantity(*this, access, key.name, unit, !standard);
  if (listed())
    declare(key, {.key = f.key,
                  .type = "number",
                  .standard = said(standard, find_unit(unit)->si),
                  .unit = std::string(unit),
                  .range = si,
                  .si = f.unit->si});
  if (!f.node) {
    const double x = as_echoed(*standard / f.unit->si);
    access.echo(f.key, x);
    return x * f.unit->si;
  }
  const double x = read_number(*this, f.key, *f.node);
  const double in_si = to_si(x, *f.unit, si);
  if (!si.contains(in_si)) fail(f.key, fmt::format("{:g} is {}", x, si.sentence(*f.unit)));
  access.echo(f.key, x);
  return in_si;
}

std::vector<double> Table::quantities(Key key, std::string_view unit, std::size_t size, Range si,
                                      std::optional<std::vector<double>> standard) {
  Access access{*document_, as_table(node_)};
  const Found f = find_quantity(*this, access, key.name, unit, !standard);
  if (listed())
    declare(key, {.key = f.key,
                  .type = list_of(size),
                  .standard = said(standard, find_unit(unit)->si),
                  .unit = std::string(unit),
                  .range = si,
                  .si = f.unit->si,
                  .size = length_of(f.node, size)});
  std::vector<double> out;  // in the case's unit, as it is echoed
  if (f.node)
    out = read_list(*this, f.key, *f.node, size, [&](double x) {
      if (!si.contains(to_si(x, *f.unit, si))) fail(f.key, fmt::format("{:g} is {}", x, si.sentence(*f.unit)));
    });
  else
    for (const double x : *standard) out.push_back(as_echoed(x / f.unit->si));
  access.echo(f.key, as_list(out));
  for (double& x : out) x = to_si(x, *f.unit, si);
  return out;
}

Vec3 Table::vector(Key key, std::string_view unit, const std::optional<Vec3>& standard) {
  return vector(key, unit, Range::finite(), standard);
}

Vec3 Table::vector(Key key, std::string_view unit, Range si, std::optional<Vec3> standard) {
  std::optional<std::vector<double>> list;
  if (standard) list = std::vector<double>(standard->data(), standard->data() + 3);
  const auto x = quantities(key, unit, 3, si, list);
  return {x[0], x[1], x[2]};
}

Mat3 Table::matrix(Key key, std::string_view unit, std::optional<Mat3> standard) {
  Access access{*document_, as_table(node_)};
  const Found f = find_quantity(*this, access, key.name, unit, !standard);
  if (listed()) declare(key, {.key = f.key, .type = "3x3 matrix", .unit = std::string(unit), .si = f.unit->si});
  Mat3 out;
  if (!f.node) {
    out = *standard;
  } else {
    const toml::array* rows = f.node->as_array();
    if (!rows || rows->size() != 3) fail(f.key, "expected a 3x3 matrix as a list of three rows");
    for (std::size_t i = 0; i < 3; ++i) {
      const toml::array* row = rows->get(i)->as_array();
      if (!row || row->size() != 3) fail(f.key, "expected a 3x3 matrix as a list of three rows");
      for (std::size_t j = 0; j < 3; ++j) {
        const double x = read_number(*this, f.key, *row->get(j));
        if (!std::isfinite(x)) fail(f.key, "expected finite numbers");
        out(Eigen::Index(i), Eigen::Index(j)) = x * f.unit->si;
      }
    }
  }
  toml::array echoed;
  for (int i = 0; i < 3; ++i)
    echoed.push_back(toml::array{out(i, 0) / f.unit->si, out(i, 1) / f.unit->si, out(i, 2) / f.unit->si});
  access.echo(f.key, std::move(echoed));
  return out;
}

double Table::number(Key key, Range range, std::optional<double> standard) {
  Access access{*document_, as_table(node_)};
  const toml::node* node = access.find(key.name);
  if (listed()) declare(key, {.type = "number", .standard = said(standard), .range = range});
  if (!node && !standard) fail("", fmt::format("'{}' is missing (allowed: {})", key.name, range.allowed()));
  const double x = node ? read_number(*this, key.name, *node) : *standard;
  if (node && !range.contains(x)) fail(key.name, fmt::format("{:g} is {}", x, range.sentence()));
  access.echo(key.name, x);
  return x;
}

std::vector<double> Table::numbers(Key key, std::size_t size, Range range,
                                   std::optional<std::vector<double>> standard) {
  Access access{*document_, as_table(node_)};
  const toml::node* node = access.find(key.name);
  if (listed())
    declare(key, {.type = list_of(size), .standard = said(standard), .range = range, .size = length_of(node, size)});
  if (!node && !standard) fail("", fmt::format("'{}' is missing", key.name));
  const auto check = [&](double x) {
    if (!range.contains(x)) fail(key.name, fmt::format("{:g} is {}", x, range.sentence()));
  };
  const std::vector<double> out = node ? read_list(*this, key.name, *node, size, check) : *standard;
  access.echo(key.name, as_list(out));
  return out;
}

std::pair<double, double> Table::number_or_range(Key key) {
  const toml::node* node = as_table(node_).get(key.name);
  if (!node || !node->is_array()) {
    const double x = number(key);
    return {x, x};
  }
  const std::vector<double> x = numbers(key, 2);
  return {std::min(x[0], x[1]), std::max(x[0], x[1])};
}

long Table::integer(Key key, long min, long max, std::optional<long> standard) {
  Access access{*document_, as_table(node_)};
  const toml::node* node = access.find(key.name);
  if (listed())
    declare(key,
            {.type = "whole number", .standard = said(standard), .range = {double(min), double(max)}, .whole = true});
  if (!node && !standard) fail("", fmt::format("'{}' is missing (a whole number from {} to {})", key.name, min, max));
  long x = standard.value_or(0);
  if (node) {
    if (!node->is_integer()) fail(key.name, fmt::format("expected a whole number from {} to {}", min, max));
    x = long(node->as_integer()->get());
    if (x < min || x > max) fail(key.name, fmt::format("{} is out of range (allowed: {} to {})", x, min, max));
  }
  access.echo(key.name, std::int64_t(x));
  return x;
}

bool Table::flag(Key key, std::optional<bool> standard) {
  Access access{*document_, as_table(node_)};
  if (listed()) {
    std::optional<std::string> otherwise;
    if (standard) otherwise = *standard ? "true" : "false";
    declare(key, {.type = "true or false", .standard = otherwise});
  }
  const toml::node* node = access.find(key.name);
  if (!node && !standard) fail("", fmt::format("'{}' is missing (true or false)", key.name));
  if (node && !node->is_boolean()) fail(key.name, "expected true or false");
  const bool x = node ? node->as_boolean()->get() : *standard;
  access.echo(key.name, x);
  return x;
}

std::string Table::read_text(std::string_view key, const std::optional<std::string>& standard) {
  Access access{*document_, as_table(node_)};
  const toml::node* node = access.find(key);
  if (!node && !standard) fail("", fmt::format("'{}' is missing", key));
  if (node && !node->is_string()) fail(key, "expected a text in quotes");
  const std::string x = node ? node->as_string()->get() : *standard;
  access.echo(key, x);
  return x;
}

std::string Table::text(Key key, const std::optional<std::string>& standard) {
  if (listed()) declare(key, {.type = "text", .standard = standard});
  std::string x = printable(read_text(key.name, standard));
  std::ranges::replace(x, '\n', ' ');
  return x;
}

std::string Table::name(Key key, std::vector<std::string>& taken) {
  const std::string x = text(key);
  if (x.find_first_not_of(" \t\r\n") == std::string::npos) fail(key.name, "a name is wanted here");
  if (std::ranges::find(taken, x) != taken.end()) fail(key.name, fmt::format("'{}' is there twice", x));
  taken.push_back(x);
  return x;
}

std::string Table::choice(Key key, const std::vector<std::string>& allowed,
                          const std::optional<std::string>& standard) {
  if (listed()) declare(key, {.type = fmt::format("one of {}", fmt::join(allowed, ", ")), .standard = standard});
  const std::string x = read_text(key.name, standard);
  if (std::ranges::find(allowed, x) != allowed.end()) return x;
  const std::string all = fmt::format("{}", fmt::join(allowed, ", "));
  const std::string near = nearest(x, allowed);
  fail(key.name, near.empty() ? fmt::format("no '{}' (allowed: {})", x, all)
                              : fmt::format("no '{}'; did you mean '{}'? (allowed: {})", x, near, all));
}

std::vector<std::string> Table::texts(Key key, std::optional<std::vector<std::string>> standard) {
  if (listed()) {
    std::optional<std::string> otherwise;
    if (standard) otherwise = fmt::format("[{}]", fmt::join(*standard, ", "));
    declare(key, {.type = "list of texts", .standard = otherwise});
  }
  Access access{*document_, as_table(node_)};
  const toml::node* node = access.find(key.name);
  if (!node && !standard) fail("", fmt::format("'{}' is missing", key.name));
  std::vector<std::string> out;
  if (!node) {
    out = *standard;
  } else {
    const toml::array* list = node->as_array();
    if (!list) fail(key.name, "expected a list of texts");
    for (const toml::node& item : *list) {
      if (!item.is_string()) fail(key.name, "expected a list of texts");
      out.push_back(item.as_string()->get());
    }
  }
  access.echo(key.name, as_list(out));
  return out;
}

std::vector<std::string> Table::scalars(Key key) {
  if (listed()) declare(key, {.type = "list of values"});
  Access access{*document_, as_table(node_)};
  const toml::node* node = access.find(key.name);
  if (!node) fail("", fmt::format("'{}' is missing", key.name));
  const toml::array* list = node->as_array();
  if (!list || list->empty()) fail(key.name, "expected a list of values");
  std::vector<std::string> out;
  for (const toml::node& item : *list) {
    if (const auto* f = item.as_floating_point()) {
      out.push_back(fmt::format("{}", f->get()));
    } else if (item.is_integer() || item.is_string() || item.is_boolean()) {
      std::ostringstream text;
      text << toml::node_view<const toml::node>(item);
      out.push_back(text.str());
    } else {
      fail(key.name, "expected numbers, texts or flags");
    }
  }
  access.echo(key.name, toml::array(*list));
  return out;
}

fs::path Table::file(Key key) {
  if (listed()) declare(key, {.type = "file"});
  const std::string name = read_text(key.name, {});
  const fs::path copy = copied(*document_, name), path = copy.empty() ? document_->directory / name : copy;
  if (!fs::is_regular_file(path)) fail(key.name, fmt::format("no file '{}'", path.string()));
  document_->inputs->file(path, copy_name(name), copy_of(*document_, name));
  return path;
}

fs::path Table::data_file(Key key) {
  if (listed()) declare(key, {.type = "file"});
  return data_path(key.name, read_text(key.name, {}));
}

fs::path Table::data_path(std::string_view key, const std::string& name) {
  const fs::path copy = copied(*document_, name), own = copy.empty() ? document_->directory / name : copy,
                 home = data_directory();
  const auto found = [&](const fs::path& file) {
    if (fs::exists(file) && !fs::is_regular_file(file)) fail(key, fmt::format("'{}' is not a file", file.string()));
    return fs::exists(file);
  };
  const auto beside = [&](const fs::path& folder, const fs::path& wanted) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) names.push_back(entry.path().filename().string());
    const std::string near = nearest(wanted.string(), names);
    return near.empty() ? std::string() : fmt::format("; did you mean '{}'?", near);
  };
  fs::path file = own;
  if (!found(own)) {
    file = home / name;
    if (!found(file)) {
      // A name with a folder may be measured data that this machine has not got; any other is a mistake.
      const fs::path folder = *fs::path(name).begin();
      const bool measured = fs::path(name).is_relative() && folder != ".." && fs::path(name).has_parent_path();
      if (!measured || fs::exists(document_->directory / folder))
        fail(key, fmt::format("no file '{}'{}", own.string(), beside(own.parent_path(), own.filename())));
      if (fs::is_directory(home / folder))
        fail(key, fmt::format("no file '{}'{}", file.string(), beside(file.parent_path(), file.filename())));
      if (fs::is_directory(home)) {
        const std::string near = beside(home, folder);
        if (!near.empty()) fail(key, fmt::format("no folder '{}'{}", (home / folder).string(), near));
      }
    }
  }
  // A measured file is found again by HOSEL_DATA.
  document_->inputs->file(file, copy_name(name), file == own ? copy_of(*document_, name) : fs::path());
  return file;
}

std::vector<fs::path> Table::data_files(Key key) {
  {
    Access access{*document_, as_table(node_)};
    const toml::node* node = access.find(key.name);
    if (!node || !node->is_array()) return {data_file(key)};
  }
  std::vector<fs::path> out;
  for (const std::string& name : texts(key)) out.push_back(data_path(key.name, name));
  if (out.empty()) fail(key.name, "expected at least one file");
  return out;
}

Table Table::table(Key key) {
  if (auto found = optional_table(key.name)) {
    if (!key.shown.empty()) found->shown_ = dotted(shown_, key.shown);
    return *found;
  }
  Access access{*document_, as_table(node_)};
  for (auto&& [other, node] : access.table)
    if (!access.document.known[&access.table].contains(other.str()) && node.is_table() &&
        edit_distance(other.str(), key.name) <= 2)
      fail(other.str(), fmt::format("unknown table; did you mean '[{}]'?", key.name));
  fail("", fmt::format("table '[{0}]' is missing: `hosel keys {0}` says what it holds", dotted(path_, key.name)));
}

std::optional<Table> Table::optional_table(std::string_view key) {
  Access access{*document_, as_table(node_)};
  toml::node* node = access.find(key);
  if (!node) return {};
  toml::table* child = node->as_table();
  if (!child) fail(key, "expected a table");
  toml::table& home = *document_->echo.at(&access.table);
  if (!home.contains(key)) {
    home.insert_or_assign(key, toml::table{});
    home.get(key)->as_table()->is_inline(child->is_inline());
    document_->echo[child] = home.get(key)->as_table();
    document_->known[child];
  }
  return Table(document_, child, dotted(path_, key), dotted(shown_, key));
}

Table Table::default_table(std::string_view key) {
  toml::table& t = as_table(node_);
  if (!t.contains(key)) {
    t.insert(key, toml::table{});
    document_->added.insert(t.get(key));
  }
  return *optional_table(key);
}

void Table::keep(std::string_view key) { document_->kept.emplace(&as_table(node_), key); }

void Table::tell(std::string_view text) {
  std::string lines = fmt::format("[{}] ", path_);
  for (const char c : text) lines += c == '\n' ? "\n  " : std::string(1, c);
  document_->inputs->tell(lines);
}

void Table::doubt(std::string_view text) { document_->inputs->doubt(fmt::format("[{}] {}", path_, text)); }

void Table::note_file(const fs::path& file) { document_->inputs->file(file, file.filename().string()); }

std::vector<Table> Table::tables(std::string_view key) {
  Access access{*document_, as_table(node_)};
  toml::node* node = access.find(key);
  std::vector<Table> out;
  if (!node) return out;
  toml::array* list = node->as_array();
  if (!list) fail(key, fmt::format("expected a list of tables [[{}]]", key));
  toml::table& home = *document_->echo.at(&access.table);
  const bool fresh = !home.contains(key);
  if (fresh) {
    toml::array echoed;
    for (std::size_t i = 0; i < list->size(); ++i) echoed.push_back(toml::table{});
    home.insert_or_assign(key, std::move(echoed));
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    toml::table* child = list->get(i)->as_table();
    if (!child) fail(key, fmt::format("expected a list of tables [[{}]]", key));
    if (fresh) {
      document_->echo[child] = home.get(key)->as_array()->get(i)->as_table();
      document_->known[child];
    }
    out.push_back(
        Table(document_, child, fmt::format("{}[{}]", dotted(path_, key), i + 1), dotted(shown_, key) + "[]"));
  }
  return out;
}

void Table::leave(std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) document_->known[&as_table(node_)].emplace(key);
}

std::vector<std::string> Table::keys() const {
  std::vector<std::string> out;
  for (auto&& [key, node] : as_table(node_)) out.emplace_back(key.str());
  return out;
}

namespace {

/// `cg_mm[2]`, `inertia_kg_m2[1][3]`: one value of a list that is there.
void override_element(detail::Document& document, toml::table& table, const std::string& key, const toml::table& parsed,
                      const std::string& text) {
  toml::node* node = table.get(key.substr(0, key.find('[')));
  toml::array* list = nullptr;
  std::size_t number = 0;
  std::size_t at = key.find('[');
  do {
    if (list) node = list->get(number - 1);
    list = node ? node->as_array() : nullptr;
    number = std::strtoul(key.c_str() + at + 1, nullptr, 10);
    if (!list || number < 1 || number > list->size())
      throw InputError(fmt::format("--set {}: there is no '{}'", text, key));
    at = key.find('[', at + 1);
  } while (at != std::string::npos);
  document.set.erase(list->get(number - 1));
  list->replace(list->cbegin() + static_cast<std::ptrdiff_t>(number - 1), *parsed.get("value"));
  document.set[list->get(number - 1)] = text;
}

/// What is to be set, as `value`: TOML, or else the text as it stands. A decimal number, of which a study sets
/// thousands, needs no parser.
toml::table parse_value(const std::string& value) {
  toml::table out;
  const std::size_t sign = value.starts_with('-'), whole = value.find_first_not_of("0123456789", sign) - sign;
  const bool decimal = !value.empty() && value.find_first_not_of("-.0123456789") == std::string::npos && whole > 0 &&
                       (whole == 1 || value[sign] != '0') && value.back() != '.';
  const char* const end = value.data() + value.size();
  double x = 0;
  if (decimal && value.find('.') != std::string::npos)
    if (const auto read = std::from_chars(value.data(), end, x); read.ec == std::errc() && read.ptr == end) {
      out.insert("value", x);
      return out;
    }
  try {
    return toml::parse("value = " + value);
  } catch (const toml::parse_error&) { out.insert("value", value); }
  return out;
}

void apply_override(detail::Document& document, const std::string& text) {
  if (!utf8::is_valid(text.begin(), text.end())) throw InputError("--set: the text is not UTF-8");
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(fmt::format("--set {}: expected key=value, e.g. --set delivery.club_speed_mps=45", text));
  const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
  limit_dots(text, fmt::format("--set {:.80}", key));
  const toml::table parsed = parse_value(value);
  toml::table* at = &document.root;
  std::stringstream parts(key);
  std::vector<std::string> path;
  for (std::string part; std::getline(parts, part, '.');) path.push_back(part);
  if (path.empty() || path.back().empty())
    throw InputError(fmt::format("--set {}: expected key=value, e.g. --set delivery.club_speed_mps=45", text));
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    // `layers[2]`: the second table of a list.
    const auto bracket = path[i].find('[');
    const std::string table = path[i].substr(0, bracket);
    if (!at->contains(table)) {
      at->insert(table, toml::table{});
      document.set[at->get(table)] = text;
    }
    toml::node* node = at->get(table);
    if (bracket != std::string::npos) {
      const std::size_t number = std::strtoul(path[i].c_str() + bracket + 1, nullptr, 10);
      toml::array* list = node->as_array();
      if (!list || number < 1 || number > list->size())
        throw InputError(fmt::format("--set {}: there is no '{}'", text, path[i]));
      node = list->get(number - 1);
    }
    at = node->as_table();
    if (!at) throw InputError(fmt::format("--set {}: '{}' is not a table", text, path[i]));
  }
  if (path.back().find('[') != std::string::npos) return override_element(document, *at, path.back(), parsed, text);
  // The same quantity in another unit is replaced, not doubled.
  const SplitName split = split_unit(path.back());
  if (split.unit) {
    std::string doubled;
    for (auto&& [other, node] : *at)
      if (may_be(other.str(), split.stem) && other.str() != path.back())
        if (const SplitName s = split_unit(other.str()); s.unit && s.stem == split.stem)
          doubled = std::string(other.str());
    if (!doubled.empty()) document.set.erase(at->get(doubled)), at->erase(doubled);
  }
  // Likewise what says the same another way: the layers of a ball and its name in the library.
  if (path.size() == 2 && path[0] == "ball")
    for (const auto& [one, other] : {std::pair{"layers", "model"}, {"model", "layers"}})
      if (path[1] == one) at->erase(other);
  // The digest is that of the entry which was named before.
  if (path.back() == "name" || path.back() == "model" || path.back() == "layers") at->erase("digest");
  if (const toml::node* old = at->get(path.back())) document.set.erase(old);
  at->insert_or_assign(path.back(), *parsed.get("value"));
  document.set[at->get(path.back())] = text;
}

void find_unknown(const std::shared_ptr<detail::Document>& d, const toml::table& t, const std::string& path) {
  const auto& known = d->known.at(&t);
  for (auto&& [key, node] : t) {
    const std::string name = dotted(path, key.str());
    if (!known.contains(key.str())) {
      // The name of a quantity without its unit.
      for (const std::string& k : known)
        if (const SplitName split = split_unit(k); split.unit && split.stem == key.str())
          throw InputError(fmt::format("{}: {}: has no unit, expected {} ({})", place(*d, node), name,
                                       with_article(split.unit->dimension),
                                       offered(split.stem, split.unit->dimension)));
      if (d->quantities.contains(name))
        throw InputError(fmt::format("{0}: {1}: has no unit; `hosel keys` shows that of '{1}'", place(*d, node), name));
      const std::string near = nearest(key.str(), {known.begin(), known.end()});
      for (const std::string& k :
           near.empty() ? std::vector<std::string>{known.begin(), known.end()} : std::vector{near})
        if (const SplitName split = split_unit(k); split.unit && key.str().starts_with(split.stem + "_"))
          throw InputError(fmt::format("{}: {}: {}", place(*d, node), name,
                                       unknown_unit(key.str(), split.stem, split.unit->dimension)));
      // A quantity that may be left out is known by its stem alone.
      const std::string_view word = key.str();
      for (const std::string& asked : d->quantities) {
        const std::string stem = path.empty()                    ? asked
                                 : asked.starts_with(path + ".") ? asked.substr(path.size() + 1)
                                                                 : "";
        if (!stem.empty() && word.starts_with(stem + "_") && !split_unit(word).unit)
          throw InputError(fmt::format("{}: {}: no unit '{}' is known; `hosel keys` shows the unit of '{}'",
                                       place(*d, node), name, word.substr(stem.size() + 1), stem));
      }
      std::string all;
      for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
      throw InputError(fmt::format("{}: {}: unknown {}; {}", place(*d, node), name, node.is_table() ? "table" : "key",
                                   near.empty() ? "known here: " + all : "did you mean '" + near + "'?"));
    }
    if (const toml::table* child = node.as_table(); child && d->known.contains(child)) find_unknown(d, *child, name);
    if (const toml::array* list = node.as_array())
      for (const toml::node& item : *list)
        if (const toml::table* child = item.as_table(); child && d->known.contains(child))
          find_unknown(d, *child, name);
  }
}

/// All that a node says, to the last bit, for a digest: a study asks for it at every point.
void write_content(const toml::node& node, std::string& out) {
  const auto bits = [&](char type, const auto& x) {
    out += type;
    out.append(reinterpret_cast<const char*>(&x), sizeof x);
  };
  if (const auto* number = node.as_floating_point()) bits('f', number->get());
  else if (const auto* whole = node.as_integer()) bits('i', whole->get());
  else if (const auto* flag = node.as_boolean()) bits('b', flag->get());
  else if (const auto* text = node.as_string()) bits('s', text->get().size()), out += text->get();
  else if (const toml::array* list = node.as_array()) {
    bits('a', list->size());
    for (const toml::node& item : *list) write_content(item, out);
  } else if (const toml::table* table = node.as_table()) {
    bits('t', table->size());
    for (auto&& [key, child] : *table) {
      bits('k', key.str().size());
      out += key.str();
      write_content(child, out);
    }
  } else {
    throw std::logic_error("a case has no key that is read as a date");
  }
}

bool same(const toml::node& a, const toml::node& b) {
  std::string one, other;
  write_content(a, one);
  write_content(b, other);
  return one == other;
}

/// Takes out of a table what its case had left to defaults, unless somebody has changed it since or an override is of a
/// part of it.
void drop_defaults(const detail::Document& d, toml::table& table, const std::string& path) {
  for (auto it = table.begin(); it != table.end();) {
    const std::string name = dotted(path, it->first.str());
    if (toml::table* child = it->second.as_table()) drop_defaults(d, *child, name);
    if (toml::array* list = it->second.as_array())
      for (std::size_t i = 0; i < list->size(); ++i)
        if (toml::table* child = list->get(i)->as_table()) drop_defaults(d, *child, fmt::format("{}[{}]", name, i + 1));
    const toml::node* was = d.defaults.get(name);
    const bool drop = was && same(*was, it->second) && std::ranges::none_of(d.overrides, [&](const std::string& o) {
                        return o.starts_with(name + "[");
                      });
    it = drop ? table.erase(it) : std::next(it);
  }
}

/// What a case left to defaults, by dotted key: a table that is there for its defaults alone is empty in the list.
void list_defaults(const detail::Document& d, const toml::table& echoed, const toml::table& stated,
                   const std::string& path, toml::table& list) {
  for (auto&& [key, value] : echoed) {
    const std::string name = dotted(path, key.str());
    const toml::node* const node = stated.get(key.str());
    const toml::node* const was = d.defaults.get(name);
    const bool as_before = was && !d.set.contains(node) && (was->is_table() || same(*was, value));
    if (!d.kept.contains({&stated, std::string(key.str())}) && (!node || d.added.contains(node) || as_before)) {
      if (value.is_table()) list.insert(name, toml::table{}), list.get(name)->as_table()->is_inline(true);
      else list.insert(name, value);
    }
    if (!node) continue;
    if (const toml::table* child = value.as_table(), *of = node->as_table(); child && of)
      list_defaults(d, *child, *of, name, list);
    if (const toml::array* items = value.as_array(), *of = node->as_array(); items && of)
      for (std::size_t i = 0; i < items->size(); ++i)
        if (const toml::table* child = items->get(i)->as_table(), *from = of->get(i)->as_table(); child && from)
          list_defaults(d, *child, *from, fmt::format("{}[{}]", name, i + 1), list);
  }
}

}  // namespace

CaseFile::CaseFile(const fs::path& where, const std::vector<std::string>& overrides)
    : document_(std::make_shared<detail::Document>()) {
  document_->overrides = overrides;
  open(where);
}

CaseFile::CaseFile(const fs::path& where, const CaseFile& by, const std::string& named)
    : document_(std::make_shared<detail::Document>()) {
  document_->inputs = by.document_->inputs;
  const fs::path folder = named.empty() ? fs::path() : by.document_->copies / copy_name(named);
  document_->copies = named.empty() ? fs::path() : folder / kInputsFolder;  // a shipped one is there again
  open(where);
  if (!named.empty()) document_->inputs->case_file(document_->file, folder / kResolvedCase);
}

fs::path CaseFile::case_beside(const std::string& named) const {
  const detail::Document& d = *document_;
  if (const fs::path copy = copied(d, named); !copy.empty()) return copy / kResolvedCase;
  const fs::path beside = d.directory / named;
  return fs::exists(beside) ? beside : fs::path();
}

void CaseFile::open(const fs::path& where) {
  detail::Document& d = *document_;
  d.file = fs::is_directory(where) ? where / "case.toml" : where;
  d.directory = d.file.parent_path();
  if (d.directory.empty()) d.directory = ".";
  if (!fs::is_regular_file(d.file)) throw InputError(fmt::format("{}: no such case file", d.file.string()));
  constexpr std::uintmax_t most = 1u << 20;
  if (fs::file_size(d.file) > most)
    throw InputError(
        fmt::format("{}: more than 1 MiB: this is no case; tables belong into files that it names", d.file.string()));
  d.parsed = std::make_shared<const toml::table>(parse_toml(post::read_file(d.file), d.file.string()));
  d.inputs->case_file(d.file);
  begin();
}

CaseFile::CaseFile(const CaseFile& read, const std::vector<std::string>& overrides)
    : document_(std::make_shared<detail::Document>()) {
  document_->file = read.document_->file;
  document_->directory = read.document_->directory;
  document_->parsed = read.document_->parsed;
  document_->inputs = read.document_->inputs;
  document_->copies = read.document_->copies;
  document_->overrides = overrides;
  begin();
}

void CaseFile::begin() {
  detail::Document& d = *document_;
  d.root = *d.parsed;
  if (toml::node* listed = d.root.get(kDefaultsTable)) {
    if (!listed->is_table())
      throw InputError(fmt::format("{}: {}: expected a table", place(d, *listed), kDefaultsTable));
    d.defaults = std::move(*listed->as_table());
    d.root.erase(kDefaultsTable);
  }
  // Another setting may decide other defaults.
  if (!d.overrides.empty() && !d.defaults.empty()) drop_defaults(d, d.root, "");
  for (const std::string& o : d.overrides) apply_override(d, o);
  d.echo[&d.root] = &d.resolved;
  d.known[&d.root];
}

Table CaseFile::root() { return Table(document_, &document_->root, "", ""); }
const fs::path& CaseFile::directory() const { return document_->directory; }
const fs::path& CaseFile::file() const { return document_->file; }
const std::vector<std::string>& CaseFile::overrides() const { return document_->overrides; }
void CaseFile::for_keys_alone() { document_->keys_alone = true; }
bool CaseFile::read_for_keys_alone() const { return document_->keys_alone; }
const std::vector<Declared>& CaseFile::declared() const { return document_->declared; }
const std::shared_ptr<Inputs>& CaseFile::inputs() const { return document_->inputs; }

void CaseFile::finish() {
  find_unknown(document_, document_->root, "");
  std::string content;
  write_content(document_->resolved, content);
  document_->inputs->resolved(content);
}

namespace {

/// TOML with every number outside a text in the fewest digits that give it back to the last bit: toml++ has six, which
/// are too few to run the case again, or seventeen, which nobody reads.
std::string with_short_numbers(const std::string& toml) {
  std::string out;
  char quote = 0;
  for (std::size_t i = 0; i < toml.size();) {
    const char c = toml[i];
    if (quote) {
      if (c == '\\' && quote == '"' && i + 1 < toml.size()) out += toml[i++];
      else if (c == quote) quote = 0;
      out += toml[i++];
      continue;
    }
    if (c == '"' || c == '\'') quote = c;
    const bool begins = std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+';
    const bool inside = !out.empty() && (std::isalnum(static_cast<unsigned char>(out.back())) || out.back() == '_' ||
                                         out.back() == '-' || out.back() == '.');
    if (!begins || inside) {
      out += c;
      ++i;
      continue;
    }
    const std::size_t end = std::min(toml.find_first_not_of("+-.0123456789eE", i), toml.size());
    const std::string number = toml.substr(i, end - i);
    char* stop = nullptr;
    const double x = std::strtod(number.c_str(), &stop);
    const bool real = number.find_first_of(".eE") != std::string::npos && *stop == 0 && std::isfinite(x);
    std::string text = real ? fmt::format("{}", x) : number;
    if (real && text.find_first_of(".e") == std::string::npos) text += ".0";
    out += text;
    i = end;
  }
  return out;
}

}  // namespace

std::string CaseFile::resolved() const {
  std::ostringstream out;
  out << toml::toml_formatter(document_->resolved, toml::format_flags{}) << '\n';
  toml::table defaults;
  list_defaults(*document_, document_->resolved, document_->root, "", defaults);
  if (!defaults.empty()) {
    out << "\n# Left to defaults: with another setting (--set) they are decided again, but for those changed above.\n";
    out << toml::toml_formatter(toml::table{{kDefaultsTable, defaults}}, toml::format_flags{}) << '\n';
  }
  return with_short_numbers(out.str());
}

}  // namespace hosel::app
