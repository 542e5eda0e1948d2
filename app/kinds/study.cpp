#include "app/kinds/kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "app/cases.hpp"
#include "app/check_memory.hpp"
#include "app/library.hpp"
#include "app/of_file.hpp"
#include "app/read_blow.hpp"
#include "app/solution_doubts.hpp"
#include "app/stored_launch.hpp"
#include "app/study/answer.hpp"
#include "app/study/compare.hpp"
#include "app/study/design.hpp"
#include "app/study/draw.hpp"
#include "app/study/effects.hpp"
#include "app/study/face.hpp"
#include "app/study/history.hpp"
#include "app/study/landing.hpp"
#include "app/study/optimum.hpp"
#include "app/study/parts.hpp"
#include "app/study/population.hpp"
#include "app/study/regression.hpp"
#include "app/study/sliders.hpp"
#include "app/study/solve.hpp"
#include "app/study/statement.hpp"
#include "app/study/table.hpp"
#include "app/sweep.hpp"
#include "post/file.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

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

/// "; it has ...": names that end as the wanted one does, else how many there are.
std::string nearest_ending(const std::string& wanted, const std::vector<std::string>& names) {
  std::vector<std::string> alike;
  for (const std::string& n : names)
    if (n.substr(n.rfind('.') + 1) == wanted.substr(wanted.rfind('.') + 1)) alike.push_back(n);
  return alike.empty() ? fmt::format("; it has {} others, in summary.json of the case's own run", names.size())
                       : fmt::format("; it has {}", fmt::join(alike, ", "));
}

/// The studies that are being read, outermost first, and their points: one that studies itself would never end.
thread_local std::vector<fs::path> open_studies;
thread_local std::size_t points_read = 0;

struct Nesting {
  Nesting(Table& root, const fs::path& own) {
    const fs::path here = fs::weakly_canonical(own);
    if (std::ranges::find(open_studies, here) != open_studies.end())
      root.fail("case", "this study names itself, directly or by way of another: it would never end");
    if (open_studies.empty()) points_read = 0;
    open_studies.push_back(here);
  }
  ~Nesting() { open_studies.pop_back(); }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
};

/// Of launches: each has a table, a figure and a path of its own.
constexpr std::size_t kMostBudgets = 60;

class StudyJob final : public PointJob {
 public:
  explicit StudyJob(CaseFile& file) {
    const BlowsBeside beside;
    Table root = file.root();
    const Nesting nesting(root, file.file());
    title_ = root.text({"title", "of tables, pages and figures"}, "");
    table_.models = {""};
    if (root.has("case")) read_case(file, root);
    else read_blows(file, root);
    table_.design = read_design(root);
    const auto columns = table_.design.columns();
    if (budgets_ && table_.design.size() > kMostBudgets)
      root.fail("flight", fmt::format("launch_error and beside tell of each launch: of {} at most", kMostBudgets));
    if (!studied_) read_solved(root);
    check_columns(root);
    check_varied_once(root);
    if (!studied_ && root.has("motion"))
      left_out_ = table_.design.leave_out_rows([&](const DesignLevel& l) {
        CaseFile one(*blow_, with_own(l.set));
        const StudyBlow asked = read_study_blow(one.root(), of_face_);
        return asked.swung && !asked.swung->motion.present;
      });
    regression_ = read_regression(root);
    if (auto t = root.optional_table("measured")) table_.measured = read_measured(*t);
    check_measured(root);
    reference_ = read_compare(root, table_);
    parts_ = read_parts(root, table_);
    const bool referred = reference_ && (reference_->model || reference_->variant);
    if (auto t = root.optional_table("equivalent_mass")) {
      if (!maps_face() || !referred)
        t->fail("", "compares maps: it needs a [grid] and a [compare] with model or variant");
      extra_mass_ = t->quantity({"extra",
                                 "head mass added to the reference: its ball speed tells what extra mass each map is "
                                 "worth"},
                                "g", {1e-5, 0.1});
    }
    std::vector<std::string> figures;
    if (maps_face() && referred) figures = face_figure_names(extra_mass_ > 0);
    statements_ = read_study_statements(root, columns, table_.outputs, figures, reference_.has_value());
    figures_ = read_study_figures(root, table_, reference_.has_value());
    landing_ = read_landing(root, table_);
    populations_ = read_populations(root, table_);
    optimum_ = read_optimum(root, table_);
    if (optimum_ && (conditions_.matched_launch || conditions_.bounce_speed))
      root.fail("optimum", "is confirmed by one point more: without matched_launch and keep_bounce");
    if (optimum_ && !solves_.empty()) root.fail("optimum", "is sought without a [[solve]]");
    draw_ = root.flag({"figures", "draw pictures; a study of many studies may do without"}, true);
    if (file.read_for_keys_alone()) return;
    // What a case refuses is an error before anything is computed.
    for (std::size_t d = 0; d < table_.design.size(); ++d) {
      if (++points_read > kMostPoints)
        root.fail("case", fmt::format("with the studies inside it, this one has more than {} points", kMostPoints));
      try {
        read_point(root, d);
      } catch (const InputError& e) { throw InputError(table_.design.refused(d, e.what())); }
    }
  }

  /// Without the measured shots that its sample is compared with, or the swing of a point, nothing is computed.
  std::size_t size() const override {
    return populations_.missing.empty() && motion_.empty() ? table_.design.size() * table_.models.size() : 0;
  }

  json compute(std::size_t point, const fs::path& scratch) const override {
    const std::size_t d = point / table_.models.size();
    if (!studied_) return compute_blow(d, point % table_.models.size());
    json result = compute_case(overrides(d), scratch);
    // An output that the case does not have is told before all points are computed.
    if (!result.contains("skipped"))
      for (const std::string& o : table_.outputs)
        if (!result.contains(o)) {
          std::vector<std::string> names;
          for (const auto& [name, value] : result.items())
            if (value.is_number()) names.push_back(name);
          throw InputError(fmt::format("outputs: point {} has no number '{}' in its summary{}", point, o,
                                       or_nearest(o, names, nearest_ending(o, names))));
        }
    return result;
  }

  void report(Output& out, const std::vector<json>& points) const override {
    if (!populations_.missing.empty()) return out.skip(populations_.missing);
    if (!motion_.empty()) return out.skip(motion_);
    if (off_face_ > 0)
      out.warn(fmt::format("{} of {} points are struck off the face. The first{}", off_face_, table_.design.size(),
                           first_off_face_));
    for (const std::string& row : left_out_) out.lack("left out, since its recording is not there: " + row);
    for (const json& p : points)
      if (p.contains("skipped")) return out.skip(p["skipped"].get<std::string>());
    tell_sets(out);
    tell_doubts(out, points);
    StudyTable table = table_;
    const bool named = !table.outputs.empty();
    table.fill(points);
    out.write("points.csv", table.csv(points));
    json summary = {{"points", points.size()}};
    summary["failed"] = std::ranges::count_if(points, [](const json& p) { return p.contains("error"); });
    std::vector<FaceLayer> layers;
    if (maps_face()) {
      layers = face_layers(table, points, reference_, [&](std::size_t d, std::size_t m) {
        std::vector<std::string> set = overrides(d);
        for (const StudySolve& s : solves_)
          if (const json& point = points[d * table.models.size() + m]; point.contains(s.name))
            set = with(std::move(set), s, point[s.name].get<double>(), false);
        return blow_with(set);
      });
      report_face(out, table, points, layers, extra_mass_, draw_, summary);
    }
    StudyEffects effects = named ? effects_of(table) : StudyEffects{};
    effects.of.resize(table.series.size());
    effects.emulators.resize(table.series.size());
    if (named) {
      tell_missing(out, table, points);
      find_idle(effects, table,
                [&](std::size_t column, std::size_t model) { return idle_alone(table, column, model, out); });
      tell_effects(out, table, effects, summary);
      const json between = sliders(table, effects);
      if (!between.is_null()) out.page().section("Between the points", "");
      out.page().sliders(
          "Answers by the emulator through the points, with the larger of its error there and at points left out. "
          "Line: along the parameter "
          "that was moved last, over the range of the answers.",
          between);
      if (const post::TextTable rows = table.rows(); rows.rows.size() > 1) out.show(rows, "Points");
    }
    if (budgets_) summary["launches"] = report_flights(out);
    if (landing_) {
      std::vector<bool> answered;
      for (const json& p : points) answered.push_back(!p.contains("error"));
      summary["landing"] = report_landing(out, table, effects, *landing_, answered, draw_, title_);
    }
    if (optimum_)
      summary["optimum"] =
          report_optimum(out, table, effects, *optimum_, [&](const std::vector<std::string>& set, std::size_t m) {
            return studied_ ? answers_of_case(set, out.directory() / "optimum") : answers_at(set, m);
          });
    if (!populations_.all.empty()) summary["populations"] = report_populations(out, table, populations_.all, draw_);
    std::vector<StudySeries> against;
    if (reference_) {
      against = references(table, *reference_);
      std::vector<bool> causes(table.outputs.size());
      for (std::size_t o = 0; o < outputs_.size(); ++o) causes[o] = outputs_[o].cause;
      summary["compare"] = compare(out, table, *reference_, against, causes);
    }
    if (regression_)
      if (json slopes = report_regression(out, *regression_); !slopes.is_null()) summary["regression"] = slopes;
    if (!parts_.all.empty()) summary["parts"] = report_parts(out, table, parts_, draw_);
    if (!statements_.empty()) summary["statements"] = judge(out, table, statements_, against, groups(table, layers));
    if (!statements_.empty() && reference_ && reference_->model)
      out.say(
          fmt::format("{} is what the others are compared with: the statements do not judge it.", reference_->name));
    if (named && draw_) draw_study(out, table, title_, figures_, effects, reference_, against);
    if (conditions_.histories) report_histories(out, table, points, draw_);
    out.page().answer("points", fmt::format("{}", points.size()),
                      fmt::format("{} without an answer", summary["failed"].get<int>()));
    out.write_summary(summary);
    out.tell(fmt::format("{}, {} without an answer; the table is {}", post::counted(points.size(), "point"),
                         summary["failed"].get<int>(), (out.directory() / "points.csv").string()));
  }

 private:
  /// One ball on one head that two sets of parameters answer for: the answers jump where the loft passes from one to
  /// the other.
  void tell_sets(Output& out) const {
    for (const auto& [struck, lofts] : lofts_of_sets_) {
      if (lofts.size() < 2) continue;
      std::vector<std::string> ranges;
      for (const auto& [set, of] : lofts)
        ranges.push_back(fmt::format("'{}' {:.3g} to {:.3g} deg", set, of.low, of.high));
      out.warn(fmt::format(
          "the loft chooses between {} sets of the parameters of the ball '{}', and answers jump from one to the next "
          "(spin loft: {}): ball.reduced names one for all points",
          lofts.size(), struck.ball, fmt::join(ranges, ", ")));
    }
  }

  /// What the points doubt of themselves: one sentence of a kind, with the worst of them.
  void tell_doubts(Output& out, const std::vector<json>& points) const {
    std::vector<WorstDoubt> kinds;
    for (std::size_t p = 0; p < points.size(); ++p)
      for (const json& d : points[p].value("doubts", json::array()))
        note_doubt(kinds, d["kind"], p, d["size"], d["sentence"]);
    for (const WorstDoubt& worst : kinds) {
      const std::string where = table_.design.said(worst.blow / table_.models.size());
      out.warn(fmt::format("{} of {} points: {}. The worst{}{}: {}", worst.count, points.size(), worst.kind,
                           where.empty() ? "" : ", ", where, worst.sentence));
    }
  }

  static void add_doubts(const std::vector<PointDoubt>& doubts, json& result) {
    for (const PointDoubt& d : doubts)
      result["doubts"].push_back({{"kind", d.kind}, {"size", d.size}, {"sentence", d.sentence}});
  }

  /// What points that answered do not have is in no mean, effect or map.
  void tell_missing(Output& out, const StudyTable& table, const std::vector<json>& points) const {
    for (const StudySeries& s : table.series) {
      std::size_t answered = 0, missing = 0;
      for (std::size_t d = 0; d < s.y.size(); ++d)
        if (!points[d * table.models.size() + s.model].contains("error") && sought(table.outputs[s.output], d)) {
          ++answered;
          missing += !std::isfinite(s.y[d]);
        }
      if (missing > 0 && missing < answered)
        out.warn(fmt::format("{}: {} of {} points have none", s.name, missing, answered));
      else if (missing > 0)
        out.say(fmt::format("{}: no point has it{}", s.name,
                            !turf_ && table.outputs[s.output].starts_with("total_")
                                ? "; a ball that rolls on needs [flight.turf]"
                                : ""));
    }
  }

  /// Of a column that a sample draws: whether a model answers as before where it alone is changed, at three points.
  std::optional<bool> idle_alone(const StudyTable& table, std::size_t column, std::size_t model, Output& out) const {
    if (!solves_.empty() || conditions_.matched_launch || conditions_.bounce_speed) return {};
    const auto x = table.design.numbers(column);
    std::size_t asked = 0;
    for (std::size_t d = 0; d < std::min<std::size_t>(table.design.size(), 10) && asked < 3; ++d) {
      const auto set = x.empty() ? std::vector<std::string>() : table.design.set_with(d, column, farthest_from(x, d));
      if (set.empty()) return {};
      std::vector<std::optional<double>> there;
      try {
        there = studied_ ? answers_of_case(set, out.directory() / "alone") : answers_at(set, model);
      } catch (const std::exception&) { continue; }  // no answer there: another point tells
      bool answered = false;
      for (std::size_t o = 0; o < there.size(); ++o) {
        const double y = table.at(model, o).y[d];
        if (std::isfinite(y) != there[o].has_value() || (there[o] && !same_answer(y, *there[o]))) return false;
        answered = answered || there[o];
      }
      asked += answered;
    }
    return asked == 3;
  }

  static std::size_t farthest_from(const std::vector<double>& x, std::size_t d) {
    return std::size_t(std::ranges::max_element(x, {}, [&](double other) { return std::abs(other - x[d]); }) -
                       x.begin());
  }

  /// Whether a point has this column: what is solved for is sought in some variants only.
  bool sought(const std::string& output, std::size_t d) const {
    const auto s = std::ranges::find(solves_, output, &StudySolve::name);
    return s == solves_.end() || s->variants.empty() ||
           std::ranges::find(s->variants, table_.design.cells(d).front()) != s->variants.end();
  }

  /// Whether the blows of a grid make maps.
  bool maps_face() const { return table_.design.grid() && !studied_; }

  /// Whose answers are judged together: a map's that has a reference, else all of a model's.
  std::vector<StudyGroup> groups(const StudyTable& table, const std::vector<FaceLayer>& layers) const {
    std::vector<StudyGroup> out;
    for (const FaceLayer& l : layers)
      if (l.reference) out.push_back({l.map.title, l.model, l.points, l.figures});
    if (!out.empty()) return out;
    std::vector<std::size_t> all(table.design.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    for (std::size_t m = 0; m < table.models.size(); ++m)
      if (!reference_ || reference_->model != m)
        out.push_back({table.models.size() > 1 ? table.models[m] : "", m, all});
    return out;
  }

  /// Another case answers: its keys are what the design sets, entries of its summary what is recorded.
  void read_case(CaseFile& file, Table root) {
    const std::string named = root.text({"case",
                                         "the case whose keys are varied: beside this one, or a shipped one; "
                                         "without it the study's own tables are the blow"});
    const fs::path own = file.case_beside(named);
    const fs::path found = own.empty() ? find_case(named) : own;
    set_ = root.texts({"set", "keys changed in every point, table.key=value"}, std::vector<std::string>{});
    table_.outputs = root.texts({"outputs", "entries of the points' summaries that the table holds; empty: all"},
                                std::vector<std::string>{});
    keep_outputs_ = root.flag({"keep_outputs", "keep the directory of every point"}, false);
    studied_ = std::make_unique<CaseFile>(found, file, own.empty() ? std::string() : named);
  }

  /// The study's own tables are the blow.
  void read_blows(CaseFile& file, Table root) {
    table_.outputs = root.texts({"outputs", "quantities of blow, launch and flight, each with its unit"});
    of_face_ = std::ranges::any_of(table_.outputs, asks_for_the_face);
    const StudyBlow base = read_study_blow(root, of_face_);
    const bool struck = !base.models.front().empty();
    flies_ = base.flight.has_value();
    budgets_ = flies_ && !(base.flight->errors.empty() && base.flight->others.empty());
    if (budgets_ && struck)
      root.fail("flight",
                "launch_error and beside tell of a stated launch: a study that has models says neither; an axis or a "
                "variant may be flight.law");
    blow_ = std::make_unique<CaseFile>(file, file.overrides());
    table_.models = base.models;
    if (table_.outputs.empty()) root.fail("outputs", "name at least one quantity, ball_speed_mps for example");
    for (const std::string& name : table_.outputs) {
      if (std::ranges::count(table_.outputs, name) > 1) root.fail("outputs", fmt::format("'{}' is there twice", name));
      outputs_.push_back(find_study_output(root, "outputs", name, flies_, struck));
      conditions_.followed = conditions_.followed || outputs_.back().followed;
    }
    if (!struck) return;
    conditions_.matched_launch =
        root.flag({"matched_launch", "turn the loft until the launch angle is the measured one"}, false);
    if (root.has_quantity("keep_bounce"))
      conditions_.bounce_speed = root.quantity(
          {"keep_bounce", "scale the ball's moduli until it bounces at this speed as the first point's does"}, "mps",
          {1, 100});
    if (conditions_.bounce_speed &&
        std::ranges::none_of(table_.models, [](const std::string& m) { return m.starts_with("fe-"); }))
      root.fail("keep_bounce_mps", "scales the moduli of the ball of finite elements: no model has one");
    conditions_.histories = root.flag(
        {"histories",
         "keep the forces over time: of the contact by volumetric and hertz-maw, at the hosel by finite elements"},
        false);
    for (const std::string& m : table_.models)
      if (conditions_.histories) check_histories(root, m);
    if (conditions_.histories && conditions_.matched_launch)
      root.fail("histories", "with matched_launch there is a blow at every loft of the search");
    if (conditions_.followed && conditions_.matched_launch)
      root.fail("outputs",
                "with matched_launch there is a blow at every loft of the search, and no one peak_stress or impulse");
  }

  /// The error budget of every stated launch, its paths by every law, and all launches in one picture.
  json report_flights(Output& out) const {
    json said = json::object();
    post::Table by_law;
    std::vector<post::NamedFlight> flights;
    FlightSetup first = *blow(0).flight;
    first.show_in(out);
    for (std::size_t d = 0; d < table_.design.size(); ++d) {
      const StudyBlow asked = blow(d);
      FlightSetup setup = *asked.flight;
      setup.unit = first.unit;  // of all in one table
      std::string name = table_.design.said(d);
      if (name.empty()) name = table_.design.cells(d).front();
      const Launch launch = asked.launch->in_place_of({});
      try {
        flights.push_back({name, setup.follow(launch, asked.blow.ball, 0.05)});
        said[name] = post::to_json(flights.back().shot);
        said[name]["budget"] = report_flight(out, setup, name, launch, asked.blow.ball, &by_law, draw_);
      } catch (const std::invalid_argument& e) { out.warn(fmt::format("{}: {}", name, e.what())); }
    }
    out.write("flights.csv", by_law.csv());
    if (draw_ && flights.size() > 1)
      out.draw(post::trajectory_figure(first.conditions.law.name, flights), "figures/flights");
    return said;
  }

  void read_solved(Table& root) {
    const bool varies = table_.design.has(DesignFactor::Kind::variants);
    solves_ = read_solves(root, varies ? table_.design.levels(0) : std::vector<std::string>{}, flies_);
    if (!of_face_ &&
        std::ranges::any_of(solves_, [](const StudySolve& x) { return asks_for_the_face(x.output.name); })) {
      of_face_ = true;
      read_study_blow(root, true);
    }
    if (!solves_.empty() && (conditions_.matched_launch || conditions_.bounce_speed))
      root.fail("solve", "one unknown after another: without matched_launch and keep_bounce");
    for (const StudySolve& s : solves_) {
      if (std::ranges::find(table_.outputs, s.name) != table_.outputs.end())
        root.fail("solve", fmt::format("'{}' is an output too: give what is found another name", s.name));
      table_.outputs.push_back(s.name);
    }
  }

  void check_columns(const Table& root) const {
    for (const std::string& column : table_.design.columns())
      if (std::ranges::find(table_.outputs, column) != table_.outputs.end())
        root.fail("outputs", fmt::format("'{}' is a column of the design too", column));
  }

  /// A key that the design, `set` or the command line, and a [[solve]] give would have the value of one of them.
  void check_varied_once(Table& root) const {
    table_.design.check_varied_once(root, studied_ ? set_ : blow_->overrides());
    const auto both = [](const StudySolve& a, const StudySolve& b) {  // in one variant
      return a.variants.empty() || b.variants.empty() || std::ranges::any_of(a.variants, [&](const std::string& v) {
               return std::ranges::count(b.variants, v) > 0;
             });
    };
    for (const StudySolve& s : solves_) {
      if (const std::string twice = table_.design.varied(s.key, s.variants); !twice.empty())
        root.fail("solve", fmt::format("'{}' is sought, and '{}' is varied", s.key, twice));
      for (const std::string& set : blow_->overrides())
        for (const std::string& key : keys_of(set))
          if ((key == key_of(set) || key != s.key) && same_quantity(s.key, key))  // in a table: it is replaced
            root.fail("solve", fmt::format("'{}' is sought, and set to one value ({})", s.key, key));
      for (const StudySolve& other : solves_)
        // A later [[solve]] of the same key goes on from what an earlier one found.
        if (s.key != other.key && same_quantity(s.key, other.key) && both(s, other))
          root.fail("solve", fmt::format("'{}' is sought twice, as '{}' too", s.key, other.key));
    }
  }

  /// What was measured of nothing that is answered would be compared with nothing.
  void check_measured(Table& root) const {
    if (table_.outputs.empty()) return;  // all of a summary: known at the end
    const auto check = [&](const MeasuredRange& m, std::string_view key) {
      if (conditions_.matched_launch && split_unit(m.name).stem == "launch_angle") return;
      for (std::size_t o = 0; o < table_.outputs.size(); ++o)
        if (table_.measures(m, o)) return;
      root.fail(key, fmt::format("'{}' is measured and no output of this study{}", m.name,
                                 or_nearest(m.name, table_.outputs, "; a key of the case has a dot")));
    };
    for (const MeasuredRange& m : table_.measured) check(m, "measured");
    for (const DesignFactor& f : table_.design.factors())
      for (const DesignLevel& l : f.levels)
        for (const MeasuredRange& m : l.measured) check(m, f.kind == DesignFactor::Kind::rows ? "rows" : "variant");
  }

  /// Every key that a study of blows has beside the blow itself.
  static void leave_study_keys(Table root) {
    for (const std::string& key : root.keys())
      if (key.starts_with("keep_bounce_")) root.leave({key});
    root.leave({"kind",    "title",      "outputs",    "matched_launch",  "histories", "axis",
                "variant", "rows",       "grid",       "sample",          "measured",  "compare",
                "part",    "parts_over", "parts_from", "equivalent_mass", "statement", "figure",
                "figures", "landing",    "population", "optimum",         "solve",     "regression"});
  }

  void read_point(Table& root, std::size_t d) {
    if (studied_) {
      CaseFile one(*studied_, overrides(d));
      read_job(one);
      return;
    }
    CaseFile one(*blow_, overrides(d));
    const StudyBlow asked = read_study_blow(one.root(), of_face_);
    check_shaft(one.root(), asked.blow, asked.models);
    if (asked.models.size() != table_.models.size())
      root.fail("models", "a point may not change how many models answer");
    if (const auto m = measured_launch_angle(d); m && conditions_.matched_launch)
      if (const auto unit = split_unit(m->name).unit; m->low != m->high || unit->dimension != Dimension::angle)
        root.fail("matched_launch",
                  fmt::format("'{}' is no angle, or a range: the loft is turned to one launch angle", m->name));
    if (conditions_.histories)
      for (const std::string& m : asked.models) check_histories(root, m);
    if (conditions_.matched_launch && !launch_angle(d))
      root.fail("matched_launch",
                fmt::format("needs a measured launch_angle of every point ({})", table_.design.said(d)));
    note_set(asked);
    turf_ = turf_ || (asked.flight && asked.flight->turf);
    if (asked.swung && !asked.swung->motion.present) motion_ = asked.swung->motion.file;
    if (asked.swung && conditions_.matched_launch) root.fail("matched_launch", "the swing says the loft");
    if (!asked.models.front().empty() && std::isfinite(asked.blow.club.head.mass))
      if (const std::string sentence =
              off_the_face(asked.blow, asked.options.plate ? &asked.options.plate->design().outline : nullptr);
          !sentence.empty() && off_face_++ == 0) {
        const std::string point = table_.design.said(d);
        first_off_face_ = fmt::format("{}{}: {}", point.empty() ? "" : ", ", point, sentence);
      }
    table_.asked.insert(table_.asked.end(), asked.models.begin(), asked.models.end());
    leave_study_keys(one.root());
    one.finish();
    for (const StudySolve& s : solves_)
      for (const double end : {s.low, s.high}) {
        CaseFile sought(*blow_, with(overrides(d), s, end, true));
        note_set(read_study_blow(sought.root(), of_face_));
        leave_study_keys(sought.root());
        sought.finish();
      }
  }

  /// Under matched_launch the loft that was found chooses, point by point.
  void note_set(const StudyBlow& asked) {
    if (!asked.sets || conditions_.matched_launch) return;
    if (std::ranges::none_of(asked.models, [&](const std::string& m) { return asked.sets->matter_to(m); })) return;
    const NamedContact* set = asked.sets->at(asked.blow);
    if (!set) return;
    const Head& head = asked.blow.club.head;
    const double loft = degrees(use_of(asked.blow).spin_loft.low);
    auto& lofts =
        lofts_of_sets_[{asked.sets->ball, asked.sets->face, head.mass, head.cg.x(), head.cg.y(), head.cg.z()}];
    const auto [at, fresh] = lofts.try_emplace(set->name, Interval{loft, loft});
    at->second = {std::min(at->second.low, loft), std::max(at->second.high, loft)};
  }

  /// A key that is sought, among overrides; `there`: with what holds meanwhile.
  static std::vector<std::string> with(std::vector<std::string> set, const StudySolve& s, double x, bool there) {
    if (there) set.insert(set.end(), s.set.begin(), s.set.end());
    set.push_back(fmt::format("{}={}", s.key, x));
    return set;
  }

  /// What a point sets, with every [[solve]] in it; what was found is recorded. The same problem of several points is
  /// solved once.
  std::vector<std::string> solved(std::size_t d, std::size_t model, json& result) const {
    std::vector<std::string> set = overrides(d);
    for (const StudySolve& s : solves_) {
      if (!sought(s.name, d)) continue;
      CaseFile problem(*blow_, with(set, s, s.low, true));
      read_study_blow(problem.root(), of_face_);
      const std::string key = fmt::format("{}\n{}\n{}", s.name, model, problem.resolved());
      std::optional<double> found;
      {
        const std::scoped_lock lock(mutex_);
        if (const auto known = solved_.find(key); known != solved_.end()) found = known->second;
      }
      if (!found) {
        found = solve(s, [&](double x) {
          const StudyBlow asked = blow_with(with(set, s, x, true));
          const auto y = s.output.value(answer(asked.models[model], asked, conditions_, {}, nullptr));
          return y ? std::optional(*y / s.output.si) : std::nullopt;
        });
        const std::scoped_lock lock(mutex_);
        solved_[key] = *found;
      }
      result[s.name] = *found;
      set = with(set, s, *found, false);
    }
    return set;
  }

  std::vector<std::string> overrides(std::size_t d) const {
    return table_.design.set(d, studied_ ? set_ : blow_->overrides());
  }

  std::optional<MeasuredRange> measured_launch_angle(std::size_t d) const {
    std::vector<MeasuredRange> all = table_.design.measured(d);
    all.insert(all.end(), table_.measured.begin(), table_.measured.end());
    for (const MeasuredRange& m : all)
      if (const SplitName s = split_unit(m.name); s.stem == "launch_angle" && s.unit) return m;
    return {};
  }

  std::optional<double> launch_angle(std::size_t d) const {
    const auto m = measured_launch_angle(d);
    return m ? std::optional(m->low * split_unit(m->name).unit->si) : std::nullopt;
  }

  static void check_histories(const Table& root, const std::string& model) {
    if (model != "volumetric" && model != "hertz-maw" && !model.starts_with("fe-"))
      root.fail("histories", "forces over time come from volumetric, hertz-maw and finite elements");
  }

  json compute_case(const std::vector<std::string>& set, const fs::path& scratch) const {
    // A killed process may have finished the point, but only what is in the store is sealed: computed again.
    fs::remove(scratch / "summary.json");
    CaseFile file(*studied_, set);
    const auto job = read_job(file);
    {
      Output out({.directory = scratch, .quiet = true, .inner = true, .durable = keep_outputs_}, file);
      job->run(out);
    }
    json result = json::object();
    const json said = json::parse(post::read_file(scratch / "summary.json"));
    flatten(said, "", result);
    if (said.contains("skipped")) result["skipped"] = said["skipped"];
    if (said.contains("doubts"))
      add_doubts({{"a doubt of the case's own", 0, said["doubts"].front().get<std::string>()}}, result);
    if (!keep_outputs_) fs::remove_all(scratch);
    return result;
  }

  StudyBlow blow(std::size_t d) const { return blow_with(overrides(d)); }

  StudyBlow blow_with(const std::vector<std::string>& set) const {
    CaseFile file(*blow_, set);
    StudyBlow out = read_study_blow(file.root(), of_face_);
    if (!out.swung) return out;
    if (out.face) out.blow.club.head.compliance = out.face;  // it turns with the club, and no model is to see it
    std::string key;  // a swing ends alike wherever on the face the ball is struck
    for (const std::string& s : set)
      if (!s.starts_with("delivery.impact_")) key += s + '\n';
    Swing* swing = nullptr;
    {
      const std::scoped_lock lock(mutex_);
      swing = &swings_[key];
    }
    std::call_once(swing->once,
                   [&] { swing->end = std::make_shared<const models::SwingEnd>(out.swung->swing(out.blow.club)); });
    out.end = swing->end;
    out.swung->begin(*out.end, out.blow, out.options.shaft_mount);
    if (out.face) out.face = std::exchange(out.blow.club.head.compliance, {});
    check_use(file.root(), use_of(out.blow), out.models);
    return out;
  }

  std::vector<std::string> with_own(std::vector<std::string> set) const {
    const auto& own = blow_->overrides();
    set.insert(set.begin(), own.begin(), own.end());
    return set;
  }

  /// The same, read once for the models that a thread asks one after another.
  std::shared_ptr<const StudyBlow> latest_blow(std::size_t d) const {
    auto& [point, latest] = latest_.local();
    if (!latest || point != d) latest = std::make_shared<const StudyBlow>(blow(d));
    point = d;
    return latest;
  }

  /// What a model answers to a blow beside those of the design.
  std::vector<std::optional<double>> answers_at(std::vector<std::string> set, std::size_t model) const {
    const StudyBlow asked = blow_with(with_own(std::move(set)));
    return numbers(answer(asked.models[model], asked, conditions_, {}, nullptr));
  }

  /// The same of a study of another case, run once more.
  std::vector<std::optional<double>> answers_of_case(std::vector<std::string> set, const fs::path& scratch) const {
    set.insert(set.begin(), set_.begin(), set_.end());
    const json said = compute_case(set, scratch);
    std::vector<std::optional<double>> out;
    for (const std::string& o : table_.outputs)
      out.push_back(said.contains(o) ? std::optional(said[o].get<double>()) : std::nullopt);
    return out;
  }

  /// In the outputs' units; nothing where the answer has none.
  std::vector<std::optional<double>> numbers(const StudyAnswer& a) const {
    std::vector<std::optional<double>> out;
    for (const StudyOutput& o : outputs_) {
      const auto x = o.value(a);
      out.push_back(x && std::isfinite(*x) ? std::optional(*x / o.si) : std::nullopt);
    }
    return out;
  }

  /// At the loft that gives the measured launch angle, with the ball's set of parameters that this loft chooses.
  StudyAnswer matched(std::size_t d, std::size_t model, const models::NormalImpactPoint* bounce) const {
    const auto read = latest_blow(d);
    const std::string& name = read->models[model];
    std::vector<std::string> set = overrides(d);
    std::map<std::string, StudyAnswer> found;
    const auto with = [&](const std::string& parameters) {
      const StudyBlow asked = parameters.empty() ? *read : blow_with(with_set(set, parameters));
      return found[parameters] = answer(name, asked, conditions_, launch_angle(d), bounce);
    };
    std::string chosen;
    if (read->sets && read->sets->matter_to(name)) {
      chosen = consistent_set(*read->sets, [&](const std::string& parameters) { return with(parameters).blow; });
      set.push_back(fmt::format("ball.reduced=\"{}\"", chosen));
    } else {
      with("");
    }
    StudyAnswer a = std::move(found.at(chosen));
    if (const std::string text = used_beyond(*blow_, set, a.blow, name); !text.empty())
      a.doubts.push_back({fmt::format("{}: the loft that was found lies beyond what was seen", name),
                          std::abs(a.blow.delivery.dynamic_loft), text});
    return a;
  }

  json compute_blow(std::size_t d, std::size_t model) const {
    json result = json::object();
    const auto read = solves_.empty() ? latest_blow(d)
                                      : std::make_shared<const StudyBlow>(blow_with(solved(d, model, result)));
    const StudyBlow& asked = *read;
    const models::NormalImpactPoint* bounce = nullptr;
    if (conditions_.bounce_speed && d > 0) {
      std::call_once(first_bounce_, [&] { bounce_ = wall_bounce(blow(0), *conditions_.bounce_speed); });
      bounce = &bounce_;
    }
    const StudyAnswer a = conditions_.matched_launch
                              ? matched(d, model, bounce)
                              : answer(asked.models[model], asked, conditions_, launch_angle(d), bounce);
    if (!budgets_) add_doubts(a.doubts, result);  // whose flights are told one by one
    const auto said = numbers(a);
    for (std::size_t o = 0; o < outputs_.size(); ++o)
      if (said[o]) result[outputs_[o].name] = *said[o];
    if (!a.history.empty()) result["history"] = stored(a.history);
    if (conditions_.histories && !a.hosel.times.empty()) result["hosel"] = stored(a.hosel);
    if (!maps_face()) return result;
    result["launch"] = stored(a.launch);
    const bool refers = reference_ && reference_->model.value_or(model) == model &&
                        counterpart(table_, *reference_, d) == d;
    if (extra_mass_ > 0 && refers) {
      StudyBlow heavier = asked;
      heavier.blow.club.head.mass += extra_mass_;
      StudyConditions plain = conditions_;
      plain.histories = false;
      result["heavier"] = stored(answer(asked.models[model], heavier, plain, launch_angle(d), bounce).launch);
    }
    return result;
  }

  std::string title_;
  StudyFiles files_;
  std::unique_ptr<CaseFile> studied_, blow_;  ///< as they were when the study was read; one of them
  std::vector<std::string> set_;
  bool keep_outputs_ = false;
  StudyConditions conditions_;
  StudyTable table_;
  std::vector<StudyOutput> outputs_;  ///< of a study of blows
  std::vector<StudySolve> solves_;
  bool flies_ = false;
  bool budgets_ = false;  ///< launches are stated, and [flight] says what else they and the law may be
  std::optional<StudyReference> reference_;
  StudyParts parts_;
  std::optional<StudyRegression> regression_;
  std::vector<StudyStatement> statements_;
  std::vector<StudyFigure> figures_;
  std::optional<StudyLanding> landing_;
  StudyPopulations populations_;
  std::optional<StudyOptimum> optimum_;
  double extra_mass_ = 0;  ///< of the reference's heavier head [kg]; 0: not asked
  bool draw_ = true;
  mutable tbb::enumerable_thread_specific<std::pair<std::size_t, std::shared_ptr<const StudyBlow>>> latest_;
  struct Swing {
    std::once_flag once;
    std::shared_ptr<const models::SwingEnd> end;
  };
  mutable std::mutex mutex_;                      ///< of the two maps
  mutable std::map<std::string, Swing> swings_;   ///< by what the design sets, place on the face apart
  mutable std::map<std::string, double> solved_;  ///< by the resolved case at the low end
  std::vector<std::string> left_out_;             ///< rows whose recorded swing is not there
  /// What the loft alone chooses a set of parameters for.
  struct Struck {
    std::string ball, face;  ///< of the library
    double mass, cg_x, cg_y, cg_z;
    auto operator<=>(const Struck&) const = default;
  };
  std::map<Struck, std::map<std::string, Interval>> lofts_of_sets_;  ///< by set; spin lofts [deg]
  std::size_t off_face_ = 0;                                         ///< points struck off the face
  std::string first_off_face_;
  bool turf_ = false;     ///< of a point
  bool of_face_ = false;  ///< an output asks for the club's own face
  fs::path motion_;       ///< a swing that is not there and cannot be left out
  mutable std::once_flag first_bounce_;
  mutable models::NormalImpactPoint bounce_;
};

}  // namespace

std::unique_ptr<Job> read_study(CaseFile& file) { return std::make_unique<StudyJob>(file); }

}  // namespace hosel::app
