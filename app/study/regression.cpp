#include "app/study/regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/implausible.hpp"
#include "golf/quantities.hpp"
#include "loop/deviation.hpp"
#include "loop/shots/shots.hpp"
#include "post/digits.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"
#include "post/table.hpp"
#include "solvers/robust_regression.hpp"

namespace hosel::app {

namespace {

/// A quantity of the launch as a row records it, or as it follows from what the row records [SI]. A missing tilt,
/// sidespin or azimuth is no zero.
std::optional<double> quantity_of_row(const loop::Shots& shots, std::size_t row, std::string_view name) {
  const auto output = output_of(name);
  if (!output) return {};  // rifle spin: no monitor sees it
  const auto read = [&](hosel::Output o) { return loop::recorded(shots, row, o); };
  if (const auto x = read(*output)) return x;
  const auto rate = read(hosel::Output::spin_rate), tilt = read(hosel::Output::spin_axis),
             back = read(hosel::Output::backspin), side = read(hosel::Output::sidespin);
  const bool polar = rate && tilt, components = back && side;
  switch (*output) {
    case hosel::Output::backspin: return polar ? std::optional(*rate * std::cos(*tilt)) : std::nullopt;
    case hosel::Output::sidespin: return polar ? std::optional(*rate * std::sin(*tilt)) : std::nullopt;
    case hosel::Output::spin_rate: return components ? std::optional(std::hypot(*back, *side)) : std::nullopt;
    case hosel::Output::spin_axis: return components ? std::optional(std::atan2(*side, *back)) : std::nullopt;
    default: return {};
  }
}

}  // namespace

std::optional<StudyRegression> read_regression(Table root) {
  auto t = root.optional_table("regression");
  if (!t) return {};
  StudyRegression r;
  r.file = t->data_file({"shots", "CSV of the measured shots"});
  constexpr long kMost = 1L << 53;  // a time in microseconds too
  const long first = t->integer({"first_shot", "number of the first shot that is used"}, 0, kMost, 0L);
  const long last = t->integer({"last_shot", "number of the last"}, first, kMost, kMost);
  r.of = t->texts({"of", "measured quantities of the launch, each with its unit"});
  r.on = t->texts({"on", "inputs of the blow that they are regressed on, all at once, each with its unit"});
  const auto unit = [&](const char* key, const std::string& name, std::optional<Dimension> dimension) {
    const SplitName split = split_unit(name);
    if (!dimension || !split.unit || split.unit->dimension != *dimension)
      t->fail(key, fmt::format("'{}' is none, or has no unit of its own", name));
    return split.unit->si;
  };
  std::vector<double> of_unit, on_unit;
  for (const std::string& name : r.of) {
    const post::Channel* c = post::find_channel(split_unit(name).stem);
    of_unit.push_back(
        unit("of", name, c ? std::optional(split_unit(fmt::format("x_{}", c->unit)).unit->dimension) : std::nullopt));
  }
  for (const std::string& name : r.on) {
    const auto input = input_of(split_unit(name).stem);
    on_unit.push_back(unit("on", name, input ? std::optional(quantity(*input).dimension) : std::nullopt));
  }
  if (!std::filesystem::exists(r.file)) return r;
  loop::Shots shots;
  try {
    shots = loop::read_shots(post::read_csv(r.file));
  } catch (const DataError& e) { throw InputError(e.what()); }
  r.repeated = repeated_rows(shots);
  std::vector<const loop::Column*> needed;
  for (const std::string& name : r.on) needed.push_back(shots.find_stem(split_unit(name).stem));
  if (!std::ranges::all_of(needed, [](const loop::Column* c) { return c && c->numeric; }))
    t->fail("shots", "a column of `on` is not there or holds no numbers");
  r.x.resize(r.on.size());
  r.y.resize(r.of.size());
  std::vector<std::size_t> readable(r.of.size(), 0);  // rows
  for (std::size_t row = 0; row < shots.rows(); ++row) {
    const long number = std::strtol(shots.id[row].c_str(), nullptr, 10);
    if (number < first || number > last) continue;
    ++r.rows;
    std::vector<std::optional<double>> y;
    for (std::size_t q = 0; q < r.of.size(); ++q) {
      y.push_back(quantity_of_row(shots, row, split_unit(r.of[q]).stem));
      readable[q] += y.back().has_value();
    }
    if (!loop::seen_launch(shots, row) || !std::ranges::all_of(y, [](const auto& x) { return x.has_value(); }) ||
        !std::ranges::all_of(needed, [&](const auto* c) { return std::isfinite(c->value[row]); }))
      continue;
    for (std::size_t k = 0; k < r.on.size(); ++k) r.x[k].push_back(needed[k]->value[row] / on_unit[k]);
    for (std::size_t q = 0; q < r.of.size(); ++q) r.y[q].push_back(*y[q] / of_unit[q]);
  }
  for (std::size_t q = 0; q < r.of.size() && r.rows > 0; ++q)
    if (readable[q] == 0)
      t->fail("of", fmt::format("'{}': no row of {} records it, or what it follows from", r.of[q], r.file.string()));
  const std::size_t least = 4 * (1 + r.on.size());  // four for every unknown
  if (r.y.empty() || r.y.front().size() < least)
    t->fail("shots", fmt::format("a regression on {} inputs needs {} whole rows, and a quantity", r.on.size(), least));
  return r;
}

nlohmann::json report_regression(Output& out, const StudyRegression& r) {
  if (r.x.empty()) {
    out.lack(
        fmt::format("no regression: {} is not there; HOSEL_DATA names the folder of measured files", r.file.string()));
    return nullptr;
  }
  if (!r.repeated.empty()) out.lack(r.repeated);
  const std::size_t n = r.y.front().size();
  nlohmann::json json = {{"rows", n}, {"of_rows", r.rows}};
  Eigen::MatrixXd X = Eigen::MatrixXd::Ones(Eigen::Index(n), 1 + Eigen::Index(r.on.size()));
  for (std::size_t k = 0; k < r.on.size(); ++k) {
    const double centre = loop::median(r.x[k]);
    json["median"][r.on[k]] = centre;
    X.col(Eigen::Index(k) + 1) = Eigen::Map<const Eigen::VectorXd>(r.x[k].data(), X.rows()).array() - centre;
  }
  const double t = boost::math::quantile(boost::math::students_t(double(X.rows() - X.cols())), 0.975);
  post::Table slopes{{{"output"}, {"over"}, {"slope", "{:.6g}"}, {"half_width_95", "{:.4g}"}}};
  post::TextTable table{.rows = {{"measured slope over"}}, .first_width = 24, .least_width = 16, .even = false};
  for (const std::string& name : r.on) table.rows[0].push_back(post::label(name));
  for (std::size_t q = 0; q < r.of.size(); ++q) {
    const auto fit = solvers::robust_regression(X, Eigen::Map<const Eigen::VectorXd>(r.y[q].data(), X.rows()));
    auto& row = table.rows.emplace_back(std::vector{post::label(r.of[q])});
    nlohmann::json& j = json["slopes"][r.of[q]];
    for (std::size_t k = 0; k < r.on.size(); ++k) {
      const auto at = Eigen::Index(k) + 1;
      const double slope = fit.coefficients[at], half = t * std::sqrt(fit.covariance(at, at));
      j[r.on[k]] = {{"slope", slope}, {"half_width_95", half}};
      row.push_back(post::with_deviation(slope, half));
      slopes.add(r.of[q], r.on[k], slope, half);
    }
    j["scatter"] = fit.scale;
    j["rows_below_half_weight"] = (fit.weights.array() < 0.5).count();
  }
  out.tell(fmt::format("{} of {} measured rows are whole", n, r.rows));
  out.show(table, "Measured slopes, each at equal other inputs");
  out.write("regression.csv", slopes.csv());
  return json;
}

}  // namespace hosel::app
