#include "app/kinds/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "app/cases.hpp"
#include "app/check_memory.hpp"
#include "app/sweep.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"
#include "post/file.hpp"
#include "post/labels.hpp"
#include "solvers/random.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

struct Parameter {
  std::string key;                  ///< dotted, of the other case
  std::vector<std::string> values;  ///< TOML text, one a level (grid) or one a point (sample)
};

/// Every number of a summary by its dotted name; what holds or not is 1 or 0.
void flatten(const json& j, const std::string& name, json& out) {
  if (j.is_object()) {
    for (const auto& [key, value] : j.items()) flatten(value, name.empty() ? key : name + "." + key, out);
  } else if (j.is_array()) {
    for (std::size_t i = 0; i < j.size(); ++i) flatten(j[i], fmt::format("{}.{}", name, i), out);
  } else if (j.is_number()) {
    out[name] = j;
  } else if (j.is_boolean()) {
    out[name] = j.get<bool>() ? 1 : 0;
  }
}

/// More points than this are a slip of the keys: each is read before anything is computed.
constexpr std::size_t kMostPoints = 100'000;

/// The sweeps that are being read, outermost first: a case that sweeps itself would never end.
class Nesting {
 public:
  Nesting(Table& root, const fs::path& own) : depth_(open().size()) {
    const fs::path here = fs::weakly_canonical(own);
    if (std::ranges::find(open(), here) != open().end())
      root.fail("case", "this sweep names itself, directly or by way of another: it would never end");
    if (depth_ == 0) counted() = 0;
    open().push_back(here);
  }
  /// A point of this sweep, or of one inside it.
  void count(Table& root) {
    if (++counted() > kMostPoints)
      root.fail("case", fmt::format("with the sweeps inside it, this one has more than {} points", kMostPoints));
  }
  ~Nesting() { open().resize(depth_); }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;

 private:
  static std::vector<fs::path>& open() {
    thread_local std::vector<fs::path> files;
    return files;
  }
  static std::size_t& counted() {
    thread_local std::size_t points = 0;
    return points;
  }
  std::size_t depth_;
};

class SweepJob final : public PointJob {
 public:
  explicit SweepJob(CaseFile& file) {
    const BlowsBeside beside;
    Table root = file.root();
    Nesting nesting(root, file.file());
    title_ = root.text({"title", "of tables, pages and figures"}, "");
    const std::string named = root.text({"case", "the case whose keys are swept: beside this one, or a shipped one"});
    const fs::path own = file.case_beside(named);
    case_ = own.empty() ? find_case(named) : own;
    set_ = root.texts({"set", "keys changed in every point, table.key=value"}, std::vector<std::string>{});
    record_ = root.texts({"record", "entries of the points' summaries that the table holds; empty: all"},
                         std::vector<std::string>{});
    keep_outputs_ = root.flag({"keep_outputs", "keep the directory of every point"}, false);
    auto sample = root.optional_table("sample");
    const auto points =
        sample ? std::size_t(sample->integer({"points", "of the Latin hypercube"}, 1, long(kMostPoints))) : 0;
    std::mt19937_64 random(sample ? std::uint64_t(sample->integer({"seed", "of the Latin hypercube"}, 0, 1L << 62))
                                  : 0);
    auto tables = root.tables("parameters");
    if (tables.empty()) root.fail("parameters", "name at least one [[parameters]] with its key");
    size_ = sample ? points : 1;
    for (Table t : tables) {
      Parameter p{t.text({"key", "of the swept case, with its unit"}), {}};
      for (const Parameter& other : parameters_)
        if (same_quantity(p.key, other.key)) t.fail("key", fmt::format("'{}' is swept already", other.key));
      if (sample) {
        const auto range = t.numbers({"range", "lowest and highest value in the hypercube"}, 2);
        for (const double x : solvers::latin_column(range[0], range[1], points, random))
          p.values.push_back(fmt::format("{}", x));
      } else {
        p.values = t.scalars({"values", "on the grid"});
        if (size_ > kMostPoints / p.values.size())
          t.fail("values", fmt::format("with these values the grid has more than {} points", kMostPoints));
        size_ *= p.values.size();
      }
      parameters_.push_back(std::move(p));
    }
    sampled_ = sample.has_value();
    // Every point is read now: a value that the case refuses is an error before anything is computed.
    swept_ = std::make_unique<CaseFile>(case_, file, own.empty() ? std::string() : named);
    for (std::size_t point = 0; point < size_; ++point) {
      nesting.count(root);
      CaseFile one(*swept_, overrides(point));
      read_job(one);
    }
  }

  std::size_t size() const override { return size_; }

  json compute(std::size_t point, const fs::path& scratch) const override {
    // A killed process may have finished the point, but only what is in the store is sealed: computed again.
    fs::remove(scratch / "summary.json");
    CaseFile file(*swept_, overrides(point));
    const auto job = read_job(file);
    {
      Output out({.directory = scratch, .quiet = true, .durable = keep_outputs_}, file);
      job->run(out);
    }
    json result = json::object();
    const json said = json::parse(post::read_file(scratch / "summary.json"));
    flatten(said, "", result);
    if (said.contains("skipped")) result["skipped"] = said["skipped"];
    if (!keep_outputs_) fs::remove_all(scratch);
    return result;
  }

  void report(Output& out, const std::vector<json>& points) const override {
    for (const json& p : points)
      if (p.contains("skipped")) return out.skip(p["skipped"].get<std::string>());
    std::vector<std::string> columns = record_;
    if (columns.empty()) {
      json all = json::object();
      for (const json& p : points)
        if (!p.contains("error")) all.update(p);
      for (const auto& [name, value] : all.items()) columns.push_back(name);
    }
    std::string csv = "point";
    for (const Parameter& p : parameters_) csv += "," + post::csv_cell(p.key);
    for (const std::string& c : columns) csv += "," + post::csv_cell(c);
    csv += ",error\n";
    json summary = {{"points", size_}, {"failed", 0}};
    for (std::size_t i = 0; i < points.size(); ++i) {
      csv += std::to_string(i);
      for (std::size_t p = 0; p < parameters_.size(); ++p) csv += "," + post::csv_cell(plain(value(p, i)));
      const bool failed = points[i].contains("error");
      for (const std::string& c : columns) {
        csv += ",";
        if (failed) continue;
        if (!points[i].contains(c))
          throw InputError(fmt::format("record: point {} has no number '{}' in its summary", i, c));
        csv += points[i][c].dump();
      }
      csv += "," + (failed ? post::csv_cell(points[i]["error"].get<std::string>()) : "") + "\n";
      if (failed) summary["failed"] = summary["failed"].get<int>() + 1;
    }
    out.write("sweep.csv", csv);
    for (const std::string& c : columns) {
      double low = INFINITY, high = -INFINITY, sum = 0;
      int count = 0;
      for (const json& p : points) {
        if (!p.contains(c)) continue;
        const double x = p[c].get<double>();
        low = std::min(low, x);
        high = std::max(high, x);
        sum += x;
        ++count;
      }
      if (count == 0) continue;
      summary["range"][c] = {low, high};
      summary["mean"][c] = sum / count;
    }
    if (!record_.empty()) {
      const std::vector<std::size_t> with = sampled_ ? tell_correlations(out, points, summary)
                                                     : std::vector<std::size_t>{};
      answer(out, summary, with);
      draw(out, points, with);
    }
    out.write_summary(summary);
    out.say(fmt::format("{} points, {} without an answer; the table is {}", size_, summary["failed"].get<int>(),
                        (out.directory() / "sweep.csv").string()));
  }

 private:
  /// The same key, or the same quantity in another unit.
  static bool same_quantity(const std::string& a, const std::string& b) {
    const SplitName x = split_unit(a), y = split_unit(b);
    return a == b || (x.unit && y.unit && x.stem == y.stem);
  }

  /// The first parameter changes slowest.
  const std::string& value(std::size_t parameter, std::size_t point) const {
    const auto& values = parameters_[parameter].values;
    if (sampled_) return values[point];
    std::size_t block = 1;
    for (std::size_t p = parameter + 1; p < parameters_.size(); ++p) block *= parameters_[p].values.size();
    return values[point / block % values.size()];
  }

  std::vector<std::string> overrides(std::size_t point) const {
    std::vector<std::string> out = set_;
    for (std::size_t p = 0; p < parameters_.size(); ++p) out.push_back(parameters_[p].key + "=" + value(p, point));
    return out;
  }

  /// A TOML text without its quotes.
  static std::string plain(const std::string& toml) {
    const bool quoted = toml.size() > 1 && toml.front() == toml.back() && (toml.front() == '"' || toml.front() == '\'');
    return quoted ? toml.substr(1, toml.size() - 2) : toml;
  }

  /// The parameter's value at every point, empty where one is not a number.
  std::vector<double> numbers(std::size_t parameter) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < size_; ++i) {
      char* end = nullptr;
      out.push_back(std::strtod(value(parameter, i).c_str(), &end));
      if (*end) return {};
    }
    return out;
  }

  /// A record in words. Which of several of one name is meant stands in the tables before it: "holds" of what?
  std::string spoken_entry(const std::string& record) const {
    const auto own = [](std::string entry) {
      if (entry.ends_with(".value")) entry.resize(entry.size() - 6);
      if (const auto at = entry.rfind("statements."); at != entry.npos && entry.ends_with(".holds"))
        return fmt::format("statement {} holds", 1 + std::atoi(entry.c_str() + at + 11));
      return post::label(entry);
    };
    std::string name = own(record);
    if (std::ranges::count(record_, name, own) == 1) return name;
    std::string tables = record.substr(0, std::min(record.find(".figures."), record.find(".statements.")));
    if (tables == record) tables = record.substr(0, record.rfind('.'));
    return fmt::format("{}: {}", post::spoken(tables), name);
  }

  void answer(Output& out, const json& summary, const std::vector<std::size_t>& with) const {
    RunPage& page = out.page();
    page.answer("points", fmt::format("{}", size_), fmt::format("{} without an answer", summary["failed"].get<int>()));
    post::TextTable table{{{"recorded", "lowest", "mean", "highest"}}};
    if (sampled_) table.rows[0].insert(table.rows[0].end(), {"goes most with", "r"});
    for (std::size_t c = 0; c < record_.size(); ++c) {
      if (!summary["range"].contains(record_[c])) continue;
      const auto text = [](const json& x) { return fmt::format("{:.4g}", x.get<double>()); };
      const json& range = summary["range"][record_[c]];
      auto& row = table.rows.emplace_back();
      row = {spoken_entry(record_[c]), text(range[0]), text(summary["mean"][record_[c]]), text(range[1])};
      if (!sampled_) continue;
      const std::string& key = parameters_[with[c]].key;
      const double r = summary["correlation"][record_[c]].value(key, 0.0);
      row.push_back(r != 0 ? post::label(key) : "-");
      row.push_back(r != 0 ? fmt::format("{:+.2f}", r) : "-");
    }
    page.answer(table);
  }

  /// What a sample says: each recorded number's spread, and the key with which it goes most (Pearson's r), whose
  /// parameter is returned.
  std::vector<std::size_t> tell_correlations(Output& out, const std::vector<json>& points, json& summary) const {
    std::vector<std::size_t> all;
    const auto correlation = [](const std::vector<double>& x, const std::vector<double>& y) {
      const double n = double(x.size()), mx = std::accumulate(x.begin(), x.end(), 0.0) / n,
                   my = std::accumulate(y.begin(), y.end(), 0.0) / n;
      double xy = 0, xx = 0, yy = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        xy += (x[i] - mx) * (y[i] - my);
        xx += (x[i] - mx) * (x[i] - mx);
        yy += (y[i] - my) * (y[i] - my);
      }
      return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0.0;
    };
    out.say(fmt::format("{:>10} {:>10} {:>10}  {}", "lowest", "mean", "highest", "recorded; goes most with (r)"));
    for (const std::string& c : record_) {
      all.push_back(0);
      if (!summary["range"].contains(c)) continue;
      double most = 0;
      std::string with;
      for (std::size_t p = 0; p < parameters_.size(); ++p) {
        const std::vector<double> values = numbers(p);
        std::vector<double> x, y;
        for (std::size_t i = 0; i < values.size(); ++i)
          if (points[i].contains(c)) x.push_back(values[i]), y.push_back(points[i][c].get<double>());
        if (x.empty()) continue;
        const double r = correlation(x, y);
        summary["correlation"][c][parameters_[p].key] = r;
        if (std::abs(r) > std::abs(most)) most = r, with = parameters_[p].key, all.back() = p;
      }
      out.say(fmt::format("{:>10.4g} {:>10.4g} {:>10.4g}  {}{}", summary["range"][c][0].get<double>(),
                          summary["mean"][c].get<double>(), summary["range"][c][1].get<double>(), c,
                          with.empty() ? "" : fmt::format("; {} ({:+.2f})", with, most)));
    }
    return all;
  }

  /// Of a sample each recorded number against the parameter with which it goes most; of a grid against the parameter of
  /// most values, a line for every choice of the others, or a map where a second one has many.
  void draw(Output& out, const std::vector<json>& points, const std::vector<std::size_t>& with) const {
    std::vector<std::vector<double>> values;
    for (std::size_t p = 0; p < parameters_.size(); ++p) values.push_back(numbers(p));
    std::size_t across = parameters_.size();
    for (std::size_t p = parameters_.size(); p-- > 0;)
      if (!values[p].empty() &&
          (across == parameters_.size() || parameters_[p].values.size() >= parameters_[across].values.size()))
        across = p;
    if (across == parameters_.size()) return;
    post::Figure figure{.title = title_, .columns = 2};
    for (std::size_t c = 0; c < record_.size(); ++c) {
      const std::string shown = spoken_entry(record_[c]);
      const std::size_t x = sampled_ ? with[c] : across;
      if (values[x].empty() || (sampled_ && still(points, record_[c]))) continue;
      if (!sampled_ && maps(values)) {
        figure.panels.push_back(map(points, values, record_[c]));
        continue;
      }
      post::Panel panel{.x_label = post::label(parameters_[x].key), .y_label = shown};
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (!points[i].contains(record_[c])) continue;
        const std::string name = sampled_ ? "" : others(x, i);
        auto line = std::ranges::find(panel.series, name, &post::Series::label);
        if (line == panel.series.end())
          line = panel.series.insert(line, {.label = name, .style = sampled_ ? "points" : "linespoints"});
        line->x.push_back(values[x][i]);
        line->y.push_back(points[i][record_[c]].get<double>());
      }
      figure.panels.push_back(std::move(panel));
    }
    out.draw(figure, "figures/sweep");
  }

  /// Whether a recorded number is the same at every point: its table says so, a picture of it would say no more.
  static bool still(const std::vector<json>& points, const std::string& record) {
    double low = INFINITY, high = -INFINITY;
    for (const json& p : points)
      if (p.contains(record))
        low = std::min(low, p[record].get<double>()), high = std::max(high, p[record].get<double>());
    return !(low < high);
  }

  /// The other parameters' values at a point, in words.
  std::string others(std::size_t but, std::size_t point) const {
    std::string text;
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      if (p == but || parameters_[p].values.size() == 1) continue;
      const SplitName split = split_unit(parameters_[p].key);
      const std::string name = post::label(parameters_[p].key);
      text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", name.substr(0, name.find(" [")),
                          plain(value(p, point)), split.unit ? " " + post::symbol(split.unit->suffix) : "");
    }
    return text;
  }

  /// More lines than eyes can part: two parameters alone, both numbers that rise.
  bool maps(const std::vector<std::vector<double>>& values) const {
    if (parameters_.size() != 2 || values[0].empty() || values[1].empty()) return false;
    const std::size_t columns = parameters_[0].values.size(), rows = parameters_[1].values.size();
    bool rising = std::min(columns, rows) > 8;
    for (std::size_t i = 1; i < columns; ++i) rising = rising && values[0][i * rows] > values[0][(i - 1) * rows];
    for (std::size_t j = 1; j < rows; ++j) rising = rising && values[1][j] > values[1][j - 1];
    return rising;
  }
  post::Panel map(const std::vector<json>& points, const std::vector<std::vector<double>>& values,
                  const std::string& record) const {
    const std::size_t columns = parameters_[0].values.size(), rows = parameters_[1].values.size();
    post::Panel panel{.title = spoken_entry(record),
                      .x_label = post::label(parameters_[0].key),
                      .y_label = post::label(parameters_[1].key)};
    for (std::size_t i = 0; i < columns; ++i) panel.map_x.push_back(values[0][i * rows]);
    for (std::size_t j = 0; j < rows; ++j) panel.map_y.push_back(values[1][j]);
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i < columns; ++i) {
        const json& p = points[i * rows + j];
        panel.map.push_back(p.contains(record) ? p[record].get<double>() : NAN);
      }
    return panel;
  }

  std::string title_;
  fs::path case_;
  std::unique_ptr<CaseFile> swept_;  ///< as it was when the sweep was read
  std::vector<std::string> set_, record_;
  bool keep_outputs_ = false, sampled_ = false;
  std::vector<Parameter> parameters_;
  std::size_t size_ = 0;
};

}  // namespace

std::unique_ptr<Job> read_sweep(CaseFile& file) { return std::make_unique<SweepJob>(file); }

}  // namespace hosel::app
