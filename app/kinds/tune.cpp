#include "app/kinds/kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "app/implausible.hpp"
#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "golf/parallel.hpp"
#include "golf/units.hpp"
#include "loop/shots/shots.hpp"
#include "models/checked_launch.hpp"
#include "models/club/loaded_shaft.hpp"
#include "models/parameters.hpp"
#include "models/registry.hpp"
#include "post/digits.hpp"
#include "post/figure.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"
#include "post/table.hpp"
#include "solvers/least_squares.hpp"
#include "solvers/random.hpp"

namespace hosel::app {
namespace {

/// A fitted quantity of launch or flight: its column, or made of spin rate and axis where the file has those.
struct TuneChannel {
  std::string name;  ///< with unit
  ShotChannel channel;
  double si, noise;    ///< noise in the unit of the name
  bool fitted = true;  ///< or only compared
};

struct Free {
  const models::NamedParameter* parameter;
  double start;
  solvers::Bounds bounds;

  /// "dynamic_loft_deg" for files.
  std::string column() const {
    return std::string(parameter->name) + (parameter->unit.empty() ? "" : fmt::format("_{}", parameter->unit));
  }
  double si() const { return parameter->unit.empty() ? 1 : split_unit(column()).unit->si; }  ///< of one of its unit
};

struct Keep {
  Table table;  ///< for errors
  std::string column, equals;
  double min, max;
};

/// Errors of one channel over one set of rows, at least one, model minus measured, in the channel's unit.
struct Errors {
  double mean = 0, sd = 0, absolute = 0;
  std::size_t count = 0;
};

Errors errors(const std::vector<double>& values) {
  Errors e;
  e.count = values.size();
  for (const double v : values) e.mean += v, e.absolute += std::abs(v);
  e.mean /= double(e.count);
  e.absolute /= double(e.count);
  for (const double v : values) e.sd += (v - e.mean) * (v - e.mean);
  e.sd = e.count > 1 ? std::sqrt(e.sd / double(e.count - 1)) : kNaN;
  return e;
}

nlohmann::json to_json(const Errors& e) {
  nlohmann::json j = {{"mean", e.mean}, {"mae", e.absolute}};
  if (e.count > 1) j["sd"] = e.sd;  // one row has no scatter
  return j;
}

class TuneJob final : public Job {
 public:
  explicit TuneJob(CaseFile& file) {
    Table root = file.root();
    model_ = root.choice({"model", "that is tuned (`hosel list`)"}, names_in(models::registry()));
    blow_.ball = read_optional_ball(root);
    blow_.club.head = read_head(root.table("head"), model_ != "rigid-planar");
    blow_.contact = read_contact(root, {model_});
    check_use(root, {}, {model_});
    if (auto shaft = root.optional_table("shaft")) blow_.club.shaft = read_shaft(*shaft);
    blow_.club.geometry = read_club_geometry(root, false);
    options_ = read_options(root, {model_}, blow_);
    const std::optional<FlightSetup> flight = read_optional_flight(root);
    flies_ = flight.has_value();

    Table data = root.table("data");
    shots_file_ = data.data_file({"shots", "CSV of the measured shots"});
    if (auto join = data.optional_table("join")) {
      join_file_ = join->data_file({"file", "CSV with further columns"});
      join_by_ = join->text({"by", "column that both files have"});
    }
    blow_.delivery.head_angular_velocity =
        data.vector({"head_angular_velocity", "of the head at first contact in every shot, global frame"}, "rad_per_s",
                    limits::spin, Vec3::Zero());
    Table noise = data.table("noise");
    for (const std::string& key : noise.keys()) {
      const SplitName split = split_unit(key);
      std::optional<ShotChannel> c = find_shot_channel(split.stem, flight, blow_.ball);
      if (!c || !split.unit || split.unit->dimension != split_unit(fmt::format("x_{}", c->unit)).unit->dimension)
        noise.fail(key, fmt::format("no launch quantity with a unit (known: {}; with a [flight] carry and the like)",
                                    post::channel_names()));
      channels_.push_back(
          {key, std::move(*c), split.unit->si,
           noise.number({key, "standard deviation of the measured channel", "<channel>"}, Range::positive())});
    }
    if (channels_.empty()) data.fail("noise", "name at least one launch quantity and its noise");
    for (const std::string& name :
         data.texts({"compared_only", "channels of [data.noise] that no parameter is fitted to"},
                    std::vector<std::string>{})) {
      const auto c = std::ranges::find(channels_, name, &TuneChannel::name);
      if (c == channels_.end()) data.fail("compared_only", fmt::format("[data.noise] has no '{}'", name));
      c->fitted = false;
    }
    for (std::size_t c = 0; c < channels_.size(); ++c)
      if (channels_[c].fitted) fitted_.push_back(c);
    if (fitted_.empty()) data.fail("compared_only", "leave at least one channel to be fitted");
    for (Table t : data.tables("keep")) {
      Keep k{t, t.text({"column", "a column of the shots"}),
             t.text({"equals", "text that a kept row has there, letter for letter; empty in a column of numbers: any"},
                    ""),
             t.number({"min", "smallest number that a kept row has there"}, {}, -INFINITY),
             t.number({"max", "largest number that a kept row has there"}, {}, INFINITY)};
      keep_.push_back(k);
    }
    rows_ = data.integer({"rows", "use so many rows, drawn at random; 0: all"}, 0, 100000000, 0);

    Table split = root.default_table("split");
    train_fraction_ = split.number({"train_fraction", "share of the rows that is fitted"}, {0.05, 1}, 0.6667);
    seed_ = unsigned(split.integer({"seed", "of the split and the starts"}, 0, 1L << 31, 1));

    const std::vector<std::string> parameters = names_in(models::parameters());
    for (Table t : root.tables("parameters")) {
      Free f{models::find_parameter(t.choice({"name", "the parameter that is tuned"}, parameters)), 0, {}};
      t.decided_by("name");
      const Range range{f.parameter->low, f.parameter->high};
      const std::string unit(f.parameter->unit);
      const double standard = f.parameter->get(options_, blow_);
      const auto read = [&](Key key, double otherwise) {
        return unit.empty() ? t.number(key, range, otherwise) : t.quantity(key, unit, range, otherwise);
      };
      f.bounds = {read({"min", "lower bound of the fit"}, range.min),
                  read({"max", "upper bound of the fit"}, range.max)};
      if (!(f.bounds.low < f.bounds.high)) t.fail("", "min must lie below max");
      const bool stated = unit.empty() ? t.has("start") : t.has_quantity("start");
      f.start = read({"start", "first guess of the first search; by default the case's own value"}, standard);
      if (!(f.start >= f.bounds.low && f.start <= f.bounds.high)) {
        const std::string bounds = fmt::format("the bounds of the fit ({:g} to {:g}{}{})", f.bounds.low / f.si(),
                                               f.bounds.high / f.si(), unit.empty() ? "" : " ", unit);
        if (stated) t.fail("start", fmt::format("{:g} lies outside {}", f.start / f.si(), bounds));
        t.fail("name", fmt::format("'{}' is {:g} in the case, outside {}: state a `start`", f.parameter->name,
                                   f.start / f.si(), bounds));
      }
      free_.push_back(f);
    }
    if (free_.empty()) root.fail("parameters", "name at least one [[parameters]]");

    Table search = root.default_table("search");
    search_.starts = int(search.integer({"starts", "of the search, the first at the defaults"}, 1, 1000, 4));
    search_.iterations = int(search.integer({"iterations", "of each search at most"}, 1, 10000, 60));
    search_.huber =
        search.number({"huber", "residual beyond which the loss is linear, in noise units; 0: least squares"},
                      Range::non_negative(), 0);
    search_.seed = seed_;
  }

  void run(Output& out) override {
    if (!std::filesystem::exists(shots_file_)) return out.skip(shots_file_);
    read_data(out);
    const auto residuals = [this](const Eigen::VectorXd& p, Eigen::VectorXd& r) { return whitened(train_, p, r); };
    const int width = int(fitted_.size());
    const int count = int(train_.size()) * width;
    if (count <= int(free_.size()))
      throw InputError(fmt::format("{}: {} training rows cannot settle {} parameters", shots_file_.string(),
                                   train_.size(), free_.size()));
    Eigen::VectorXd start(free_.size());
    std::vector<solvers::Bounds> bounds;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      start[Eigen::Index(i)] = free_[i].start;
      bounds.push_back(free_[i].bounds);
    }
    out.say(fmt::format("tuning {} of {} on {} ({} kept for the test), {}", post::counted(free_.size(), "parameter"),
                        model_, post::counted(train_.size(), "shot"), test_.size(),
                        post::counted(std::size_t(search_.starts), "start")));
    const solvers::LeastSquaresFit fit = solvers::least_squares(residuals, count, start, bounds, search_);
    const solvers::Identifiability known = solvers::identifiability(fit.jacobian, bounds);
    report(out, start, fit, known);
  }

 private:
  void read_data(Output& out) {
    loop::Shots shots;
    post::Sheet sheet;
    try {
      sheet = post::read_csv(shots_file_);
      shots = loop::read_shots(sheet, flies_);
      if (!join_by_.empty()) loop::join(shots, post::read_csv(join_file_), join_by_);
    } catch (const DataError& e) { throw InputError(e.what()); }
    for (const std::string& rows : implausible_rows(shots)) out.warn(rows);
    if (const std::string repeated = repeated_rows(shots); !repeated.empty()) out.lack(repeated);
    std::vector<std::pair<Input, const loop::Column*>> inputs;
    for (int i = 0; i < kInputs; ++i) {
      const auto input = static_cast<Input>(i);
      if (const loop::Column* c = shots.find_stem(stem(input)))
        if (input != Input::head_mass || !tuned("head_mass")) inputs.emplace_back(input, c);
    }
    tell_absent(out, shots);
    for (const TuneChannel& c : channels_) check_column(c, shots);
    const auto measured = [&](const TuneChannel& c, std::size_t row) {
      if (const loop::Column* column = shots.find_stem(c.channel.name)) return column->value[row];
      const loop::Column *rate = shots.find_stem("spin_rate"), *axis = shots.find_stem("spin_axis");
      if (rate && axis && c.channel.name == "backspin") return rate->value[row] * std::cos(axis->value[row]);
      if (rate && axis && c.channel.name == "sidespin") return rate->value[row] * std::sin(axis->value[row]);
      throw InputError(fmt::format("{}: no column for {}", shots_file_.string(), c.name));
    };
    const std::vector<Kept> keep = kept_by(shots, sheet);
    std::map<std::string, int> left_out;
    for (std::size_t row = 0; row < shots.rows(); ++row) {
      std::string why;
      for (const Kept& k : keep)
        if (why.empty() && !k.keeps(row))
          why = k.is_empty(row) ? "no " + k.column->name : k.column->name + " outside what the case keeps";
      Blow blow = blow_;
      for (const auto& [input, c] : inputs) {
        if (why.empty() && !std::isfinite(c->value[row])) why = fmt::format("no {}", c->name);
        set(blow, input, c->value[row]);
      }
      std::vector<double> values;
      for (const TuneChannel& c : channels_) {
        values.push_back(measured(c, row));
        if (why.empty() && !std::isfinite(values.back())) why = fmt::format("no {}", c.name);
      }
      if (!why.empty()) {
        ++left_out[why];
        continue;
      }
      blows_.push_back(blow);
      loaded_.push_back(loaded_start(blow));
      measured_.push_back(values);
      id_.push_back(shots.id[row]);
    }
    std::mt19937_64 random(seed_);
    std::vector<std::size_t> order = solvers::shuffled(blows_.size(), random);
    if (rows_ > 0 && std::size_t(rows_) < order.size()) {
      left_out["beyond the number of rows asked for"] = int(order.size()) - int(rows_);
      order.resize(std::size_t(rows_));
    }
    const auto cut = std::size_t(std::lround(train_fraction_ * double(order.size())));
    train_.assign(order.begin(), order.begin() + std::ptrdiff_t(cut));
    test_.assign(order.begin() + std::ptrdiff_t(cut), order.end());
    left_out_ = left_out;
    for (const auto& [why, n] : left_out) out.say(fmt::format("{} rows left out: {}", n, why));
  }

  /// Throws InputError where the column of a channel has no unit of the channel's, or holds a word.
  void check_column(const TuneChannel& c, const loop::Shots& shots) const {
    const loop::Column* column = shots.find_stem(c.channel.name);
    if (!column) return;
    const Dimension needed = split_unit(fmt::format("x_{}", c.channel.unit)).unit->dimension;
    const SplitName split = split_unit(column->name);
    if (!split.unit || split.unit->dimension != needed)
      throw InputError(
          fmt::format("{}:1: column '{}' needs a unit of {}", shots_file_.string(), column->name, name(needed)));
    for (std::size_t row = 0; row < column->text.size(); ++row)
      if (const std::string& cell = column->text[row]; !cell.empty() && !post::number(cell))
        throw InputError(fmt::format("{}:{}: column '{}': '{}' is not a number", shots_file_.string(), shots.line[row],
                                     column->name, cell));
  }

  /// Without speed and loft there is no blow; every other input that no column says is zero, or the head's own mass.
  void tell_absent(Output& out, const loop::Shots& shots) const {
    std::vector<std::string_view> zero;
    for (int i = 0; i < kInputs; ++i) {
      const auto input = static_cast<Input>(i);
      if (input == Input::head_mass || shots.find_stem(stem(input)) || tuned(stem(input))) continue;
      if (input == Input::club_speed || input == Input::dynamic_loft)
        throw InputError(fmt::format("{}: no column for {} with its unit: without it there is no blow to compute",
                                     shots_file_.string(), stem(input)));
      zero.push_back(stem(input));
    }
    if (!zero.empty())
      out.warn(fmt::format("{} has no column for {}: zero in every shot", shots_file_.filename().string(),
                           fmt::join(zero, ", ")));
  }

  /// A [[data.keep]] with its column.
  struct Kept {
    const Keep& by;
    const loop::Column* column;
    std::vector<std::string> cells;  ///< of each row, where the text counts

    bool is_empty(std::size_t row) const {
      return column->numeric ? !std::isfinite(column->native(row)) : cells[row].empty();
    }
    bool keeps(std::size_t row) const {
      if (!cells.empty() && cells[row] != by.equals) return false;
      return !column->numeric || (column->native(row) >= by.min && column->native(row) <= by.max);
    }
  };

  /// Throws InputError where a column cannot be chosen by what the case states.
  std::vector<Kept> kept_by(const loop::Shots& shots, const post::Sheet& sheet) const {
    std::map<std::size_t, std::size_t> row_at;  // by the line: rows of `shots` may stand in another order
    for (std::size_t i = 0; i < sheet.rows(); ++i) row_at[sheet.lines[i]] = i;
    std::vector<Kept> out;
    for (const Keep& k : keep_) {
      const loop::Column* c = shots.find(k.column);
      if (!c) throw InputError(fmt::format("{}: no column '{}'", shots_file_.string(), k.column));
      for (const auto& [key, bound, stated] :
           {std::tuple{"min", k.min, k.min > -INFINITY}, std::tuple{"max", k.max, k.max < INFINITY}})
        if (!c->numeric && stated)
          k.table.fail(key, fmt::format("{:g}: the column '{}' of {} holds words (allowed: equals)", bound, k.column,
                                        shots_file_.string()));
      Kept kept{k, c, {}};
      if (!c->numeric || !k.equals.empty()) {
        const auto at = std::ranges::find(sheet.names, k.column);
        if (at == sheet.names.end())
          k.table.fail("equals", fmt::format("'{}': the column '{}' is that of {} and has numbers (allowed: min, max)",
                                             k.equals, k.column, join_file_.string()));
        const auto& cells = sheet.columns[std::size_t(at - sheet.names.begin())];
        for (const std::size_t line : shots.line) kept.cells.push_back(cells[row_at.at(line)]);
      }
      out.push_back(std::move(kept));
    }
    return out;
  }

  /// Where the hands load the shaft: found once a shot, for the club as the case has it.
  std::optional<models::LoadedShaft> loaded_start(const Blow& blow) const {
    const models::ShaftMount& m = options_.shaft_mount;
    if (!m.load) return {};
    return models::loaded_by_grip(blow, *m.load, m.grip_point, m.elements, m.growth, m.shear);
  }

  bool tuned(std::string_view name) const {
    return std::ranges::any_of(free_, [&](const Free& f) { return f.parameter->name == name; });
  }

  /// Channel values of the model [SI] on every row, NaN where the blow cannot happen.
  std::vector<std::vector<double>> predict(const std::vector<std::size_t>& rows, const Eigen::VectorXd& p) const {
    std::vector<std::vector<double>> out(rows.size(), std::vector<double>(channels_.size(), kNaN));
    const bool own_model = options_.shaft_mount.load.has_value();  // for each row: its swing loads its shaft
    for_all(tbb::blocked_range<std::size_t>(0, rows.size()), [&](const tbb::blocked_range<std::size_t>& range) {
      for (std::size_t from = range.begin(), to; from < range.end(); from = to) {
        to = own_model ? from + 1 : range.end();
        models::Options options = options_;
        options.shaft_mount.loaded = loaded_[rows[from]];
        std::vector<Blow> blows;
        std::vector<std::size_t> of;
        for (std::size_t i = from; i < to; ++i) {
          Blow blow = blows_[rows[i]];
          for (std::size_t k = 0; k < free_.size(); ++k) free_[k].parameter->set(options, blow, p[Eigen::Index(k)]);
          if (!blow.club.head.faults().empty() && model_ != "rigid-planar") continue;
          blows.push_back(std::move(blow));
          of.push_back(i);
        }
        try {
          const auto answers = models::checked_launches(*models::find(model_)->make(options), blows);
          for (std::size_t k = 0; k < of.size(); ++k) {
            if (answers[k].failure) continue;
            std::vector<double> values(channels_.size());
            for (std::size_t c = 0; c < values.size(); ++c) try {
                values[c] = channels_[c].channel.value(answers[k].launch);
              } catch (const std::invalid_argument&) { values[c] = kNaN; }  // its ball does not land
            out[of[k]] = std::move(values);
          }
        } catch (const std::exception&) {}
      }
    });
    return out;
  }

  double error(std::size_t row, std::size_t c, const std::vector<double>& model) const {  // channel's unit
    const double off = model[c] - measured_[row][c];
    return (channels_[c].channel.unit == "deg" ? std::remainder(off, 2 * kPi) : off) / channels_[c].si;
  }

  bool whitened(const std::vector<std::size_t>& rows, const Eigen::VectorXd& p, Eigen::VectorXd& r) const {
    bool good = true;
    const std::size_t width = fitted_.size();
    const std::vector<std::vector<double>> model = predict(rows, p);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < width; ++k) {
        const double e = error(rows[i], fitted_[k], model[i]) / channels_[fitted_[k]].noise;
        if (!std::isfinite(e)) good = false;
        r[Eigen::Index(i * width + k)] = e;
      }
    return good;
  }

  void report(Output& out, const Eigen::VectorXd& start, const solvers::LeastSquaresFit& fit,
              const solvers::Identifiability& known) const {
    nlohmann::json summary;
    const auto n = Eigen::Index(free_.size());
    // The scatter left over, in units of the declared noise: the parameters' spread grows by it.
    Eigen::VectorXd r(Eigen::Index(train_.size() * fitted_.size()));
    whitened(train_, fit.parameters, r);
    const double scatter = std::sqrt(r.squaredNorm() / double(std::max<Eigen::Index>(1, r.size() - n)));
    summary["scatter_over_declared_noise"] = scatter;
    summary["costs_of_the_starts"] = fit.costs;
    post::Table found{{{.heading = "parameter"},
                       {"parameter"},
                       {"unit"},
                       {"start", "{:.8g}", "start", "{:.6g}"},
                       {"tuned", "{:.8g}", "tuned", "{:.6g}"},
                       {"sd_by_noise", "{:.5g}", "sd (noise)", "{:.3g}"},
                       {"sd_by_scatter", "{:.5g}", "sd (scatter)", "{:.3g}"},
                       {"min", "{:.8g}"},
                       {"max", "{:.8g}"},
                       {}},
                      {.first_width = 28, .least_width = 14, .even = false}};
    const auto finite = [](double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(); };
    std::vector<std::string> at_bound;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Free& f = free_[std::size_t(i)];
      const double si = f.si(), value = fit.parameters[i] / si, sd = known.sd[i] / si;
      const bool edge = solvers::at_bounds(fit.parameters.segment(i, 1), {f.bounds}).front();
      found.add(f.column(), f.parameter->name, f.parameter->unit, start[i] / si, value, post::if_finite(sd),
                post::if_finite(sd * std::max(1.0, scatter)), f.bounds.low / si, f.bounds.high / si,
                edge ? "at its bound" : "");
      if (edge) at_bound.emplace_back(f.parameter->name);
      const SplitName split = split_unit(f.column());
      const post::Digits digits = post::digits(value, edge ? 0 : sd * std::max(1.0, scatter));
      out.page().answer(post::spoken(split.stem),
                        digits.value + (split.unit ? " " + post::symbol(split.unit->suffix) : ""),
                        edge                 ? "at its bound"
                        : !std::isfinite(sd) ? "the data do not show it"
                                             : fmt::format("± {} by the scatter", digits.deviation));
      summary["parameters"].push_back({{"name", f.column()},
                                       {"start", start[i] / si},
                                       {"value", value},
                                       {"sd", finite(sd)},
                                       {"sd_by_scatter", finite(sd * std::max(1.0, scatter))},
                                       {"at_bound", edge}});
    }
    out.tell("");
    out.show(found.shown(), "What was tuned");
    out.write("parameters.csv", found.csv());

    post::Table correlation{{{"parameter"}}};
    for (const Free& f : free_) correlation.in_files({std::string(f.parameter->name)}, "{:.4f}");
    std::vector<std::string> tied;
    for (Eigen::Index i = 0; i < n; ++i) {
      correlation.add(free_[std::size_t(i)].parameter->name);
      for (Eigen::Index j = 0; j < n; ++j) {
        correlation.more(known.correlation(i, j));
        if (j > i && std::abs(known.correlation(i, j)) > 0.95)
          tied.push_back(fmt::format("{} and {} (correlation {:.3f})", free_[std::size_t(i)].parameter->name,
                                     free_[std::size_t(j)].parameter->name, known.correlation(i, j)));
      }
    }
    out.write("correlation.csv", correlation.csv());
    summary["condition"] = finite(known.condition);
    summary["inseparable"] = tied;
    summary["blind"] = nlohmann::json::array();
    out.say(fmt::format(
        "\ncondition number of the whitened, column-scaled Jacobian {:.3g}; scatter {:.2f} times the declared noise",
        known.condition, scatter));
    constexpr double told = 1.5;  // below it the noise may be declared too small
    if (scatter > told)
      out.warn(
          fmt::format("the tuned model misses the shots by {:.1f} times their declared noise: ± is the "
                      "scatter about it, and contains no error of the model",
                      scatter));
    if (!at_bound.empty())
      out.warn(fmt::format("at a bound, beyond which the shots ask: {}", fmt::join(at_bound, ", ")));
    for (const std::string& t : tied) {
      out.say("the data cannot separate " + t);
      out.page().doubt("the data cannot separate " + t);
    }
    for (const Eigen::VectorXd& v : known.blind) {
      std::string text;
      for (Eigen::Index i = 0; i < n; ++i)
        if (std::abs(v[i]) > 0.2)
          text += fmt::format("{}{:+.2f} {}", text.empty() ? "" : ", ", v[i], free_[std::size_t(i)].parameter->name);
      out.say("the data leave free inside the bounds: " + text + " (shares of the bounds' distance)");
      summary["blind"].push_back(text);
    }
    if (tied.empty() && known.blind.empty())
      out.say(fmt::format("no two parameters have a correlation above 0.95, and the data leave none free{}",
                          at_bound.empty() ? "" : fmt::format("; at a bound: {}", fmt::join(at_bound, ", "))));

    // Errors before and after, on both sets.
    post::Figure figure{.title = fmt::format("{} tuned: model minus measured", model_), .columns = 3};
    post::Table residuals{{{"shot"}, {"set"}}};
    for (const TuneChannel& c : channels_)
      residuals.in_files({c.name + "__measured", c.name + "__before", c.name + "__after"}, "{:.8g}");
    post::Table table{{{"set", "{}", "set"},
                       {"channel", "{}", "channel"},
                       {"rows", "{}", "rows"},
                       {.heading = "before: mean +- sd"},
                       {.heading = "after: mean +- sd"},
                       {"before_mean", "{:.6g}"},
                       {"before_sd", "{:.6g}"},
                       {"before_mae", "{:.6g}", "MAE before", "{:.4g}"},
                       {"after_mean", "{:.6g}"},
                       {"after_sd", "{:.6g}"},
                       {"after_mae", "{:.6g}", "MAE after", "{:.4g}"}},
                      {.first_width = 6, .least_width = 6, .even = false}};
    for (const TuneChannel& c : channels_)
      figure.panels.push_back(
          {.x_label = "measured " + post::label(c.name),
           .y_label = fmt::format("model - measured [{}]", post::symbol(split_unit(c.name).unit->suffix))});
    for (const auto& [set, rows] : {std::pair{"train", &train_}, std::pair{"test", &test_}}) {
      std::vector<std::vector<double>> before(channels_.size()), after(channels_.size());
      const auto model_before = predict(*rows, start), model_after = predict(*rows, fit.parameters);
      int lost = 0;
      for (std::size_t i = 0; i < rows->size(); ++i) {
        const std::size_t row = (*rows)[i];
        residuals.add(id_[row], set);
        const auto answers = [](double x) { return std::isfinite(x); };
        const bool answered = std::ranges::all_of(model_before[i], answers) &&
                              std::ranges::all_of(model_after[i], answers);
        if (!answered) ++lost;
        for (std::size_t c = 0; c < channels_.size(); ++c) {
          if (answered)
            before[c].push_back(error(row, c, model_before[i])), after[c].push_back(error(row, c, model_after[i]));
          residuals.more(measured_[row][c] / channels_[c].si, model_before[i][c] / channels_[c].si,
                         model_after[i][c] / channels_[c].si);
        }
      }
      if (lost) out.say(fmt::format("{} {} rows have no answer from the model and are not counted below", lost, set));
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (after[c].empty()) continue;  // no rows, no errors
        const Errors b = errors(before[c]), a = errors(after[c]);
        table.add(set, channels_[c].name, a.count, fmt::format("{:.4g} +- {:.4g}", b.mean, b.sd),
                  fmt::format("{:.4g} +- {:.4g}", a.mean, a.sd), b.mean, b.sd, b.absolute, a.mean, a.sd, a.absolute);
        summary["errors"].push_back({{"set", set},
                                     {"channel", channels_[c].name},
                                     {"rows", a.count},
                                     {"before", to_json(b)},
                                     {"after", to_json(a)}});
        post::Series cloud{.label = fmt::format("{} {:.3g} +- {:.3g}", set, a.mean, a.sd), .style = "points"};
        for (std::size_t i = 0; i < rows->size(); ++i) {
          cloud.add(measured_[(*rows)[i]][c] / channels_[c].si, error((*rows)[i], c, model_after[i]));
        }
        figure.panels[c].series.push_back(cloud);
      }
    }
    out.tell("");
    out.show(table.shown(), "Model minus measured");
    out.write("errors.csv", table.csv());
    out.write("residuals.csv", residuals.csv());
    out.draw(figure, "errors");
    for (const auto& [why, k] : left_out_) summary["left_out"][why] = k;
    summary["rows"] = {{"train", train_.size()}, {"test", test_.size()}};
    summary["seed"] = seed_;
    out.write_summary(summary);
  }

  std::string model_, join_by_;
  Blow blow_;
  models::Options options_;
  std::filesystem::path shots_file_, join_file_;
  bool flies_ = false;
  std::vector<TuneChannel> channels_;
  std::vector<std::size_t> fitted_;  // of the channels
  std::vector<Keep> keep_;
  std::vector<Free> free_;
  solvers::LeastSquaresOptions search_;
  double train_fraction_ = 0;
  unsigned seed_ = 1;
  long rows_ = 0;

  std::vector<Blow> blows_;
  std::vector<std::optional<models::LoadedShaft>> loaded_;  // of each blow
  std::vector<std::vector<double>> measured_;               // SI
  std::vector<std::string> id_;
  std::vector<std::size_t> train_, test_;
  std::map<std::string, int> left_out_;
};

}  // namespace

std::unique_ptr<Job> read_tune(CaseFile& file) { return std::make_unique<TuneJob>(file); }

}  // namespace hosel::app
