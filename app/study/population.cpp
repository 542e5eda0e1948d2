#include "app/study/population.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_sheet.hpp"
#include "app/study/compare.hpp"
#include "app/study/formula.hpp"
#include "post/digits.hpp"
#include "post/labels.hpp"
#include "solvers/robust_regression.hpp"

namespace hosel::app {
namespace {

constexpr std::array kShares = {0.05, 0.25, 0.5, 0.75, 0.95};
/// Fewer rows tell no tenth of a distribution.
constexpr std::size_t kLeastRows = 30;
/// More points are not told apart in a picture; the lines are of all.
constexpr std::size_t kMostMarks = 200;

/// Linear between the ordered values.
double quantile(const std::vector<double>& ordered, double share) {
  const double at = share * double(ordered.size() - 1);
  const auto below = std::min(std::size_t(at), ordered.size() - 2);
  return ordered[below] + (at - double(below)) * (ordered[below + 1] - ordered[below]);
}

/// One side of the comparison: the pairs that have both numbers.
class Side {
 public:
  Side(const std::vector<double>& x, const std::vector<double>& y) {
    for (std::size_t i = 0; i < y.size(); ++i)
      if (std::isfinite(x[i]) && std::isfinite(y[i])) x_.push_back(x[i]), y_.push_back(y[i]);
    ordered_ = y_;
    std::ranges::sort(ordered_);
  }
  bool enough() const { return y_.size() >= kLeastRows; }
  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }
  const std::vector<double>& ordered() const { return ordered_; }

  struct Line {
    double at, slope, slope_error, scatter, explained;
  };
  /// y over x about `middle`.
  Line line(double middle) const {
    const auto n = Eigen::Index(y_.size());
    Eigen::MatrixXd X(n, 2);
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      X.row(i) << 1, x_[std::size_t(i)] - middle;
      y[i] = y_[std::size_t(i)];
    }
    const solvers::RobustRegression fit = solvers::robust_regression(X, y);
    const Eigen::VectorXd dx = X.col(1).array() - X.col(1).mean(), dy = y.array() - y.mean();
    const double covariance = dx.dot(dy);
    return {fit.coefficients[0], fit.coefficients[1], std::sqrt(fit.covariance(1, 1)), fit.scale,
            covariance * covariance / (dx.squaredNorm() * dy.squaredNorm())};
  }

 private:
  std::vector<double> x_, y_, ordered_;
};

nlohmann::json to_json(const Side& side, const Side::Line& line) {
  nlohmann::json j = {{"shots", side.y().size()}};
  for (const double share : kShares) j[fmt::format("quantile_{:02.0f}", 100 * share)] = quantile(side.ordered(), share);
  j["at_median"] = line.at;
  j["slope"] = line.slope;
  j["slope_error"] = line.slope_error;
  j["scatter"] = line.scatter;
  j["explained"] = line.explained;
  return j;
}

post::Series distribution(const Side& side, const std::string& label) {
  post::Series s{.label = label};
  constexpr int steps = 100;
  for (int k = 0; k <= steps; ++k) {
    const double share = double(k) / steps;
    s.add(quantile(side.ordered(), share), 100 * share);
  }
  return s;
}

post::Series cloud(const Side& side, const std::string& label) {
  post::Series s{.label = label, .style = "points"};
  const std::size_t step = std::max<std::size_t>(1, side.y().size() / kMostMarks);
  for (std::size_t i = 0; i < side.y().size(); i += step) s.add(side.x()[i], side.y()[i]);
  return s;
}

/// Formulas over the columns of a sheet; a column is read when a formula uses it.
std::vector<double> evaluated(const Table& table, std::string_view key, const std::string& text,
                              const post::Sheet& sheet) {
  check_formula(table, key, text, sheet.names);
  Formula formula(text, sheet.names);
  std::vector<std::pair<std::string, std::vector<double>>> used;
  for (const std::string& name : sheet.names)
    if (formula.uses(name)) used.emplace_back(name, column_with_gaps(sheet, name));
  std::vector<double> out;
  for (std::size_t row = 0; row < sheet.rows(); ++row) {
    for (const auto& [name, values] : used) formula.set(name, values[row]);
    out.push_back(formula.value().value_or(NAN));
  }
  return out;
}

}  // namespace

StudyPopulations read_populations(Table root, const StudyTable& table) {
  StudyPopulations out;
  std::vector<std::string> taken;
  for (Table t : root.tables("population")) {
    StudyPopulation p{.name = t.name({"name", "of the population, in tables and figures"}, taken), .measured = {}};
    const auto file = t.data_file({"file", "CSV of measured shots, one a row"});
    const std::string where = t.text({"where", "a formula of the file's columns: rows where it is true count"}, "");
    const std::string given = t.text({"given", "column of the design of which all is seen as a function"});
    p.given = number_of(t, "given", "column", given, table.design.columns());
    if (table.design.numbers(p.given).empty())
      t.fail("given", fmt::format("the column '{}' of the design holds words: a column of numbers is needed", given));
    const std::string of_given =
        t.text({"given_measured", "a formula of the file's columns that is the same, in its unit"});
    Table measured = t.table("measured");
    std::vector<std::pair<std::string, std::string>> formulas;
    for (const std::string& key : measured.keys()) {
      p.measured.push_back({number_of(measured, key, "output", key, table.outputs), {}});
      formulas.emplace_back(key,
                            measured.text({key, "a formula of the file's columns in the output's unit", "<output>"}));
    }
    if (formulas.empty()) t.fail("measured", "name at least one output");
    if (!std::filesystem::exists(file)) {
      if (out.missing.empty()) out.missing = file;
      continue;
    }
    const post::Sheet sheet = read_sheet(file);
    const std::vector<double> counts = where.empty() ? std::vector<double>(sheet.rows(), 1.0)
                                                     : evaluated(t, "where", where, sheet);
    const auto kept = [&](const std::vector<double>& all) {
      std::vector<double> some;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (counts[i] != 0 && std::isfinite(counts[i])) some.push_back(all[i]);
      return some;
    };
    p.x = kept(evaluated(t, "given_measured", of_given, sheet));
    for (std::size_t k = 0; k < formulas.size(); ++k) {
      p.measured[k].y = kept(evaluated(measured, formulas[k].first, formulas[k].second, sheet));
      if (!Side(p.x, p.measured[k].y).enough())
        measured.fail(formulas[k].first, fmt::format("fewer than {} rows have it", kLeastRows));
    }
    out.all.push_back(std::move(p));
  }
  return out;
}

nlohmann::json report_populations(Output& out, const StudyTable& table, const std::vector<StudyPopulation>& all,
                                  bool draw) {
  nlohmann::json json = nlohmann::json::object();
  for (const StudyPopulation& p : all) {
    const std::string given = table.design.columns()[p.given];
    std::vector<double> seen = Side(p.x, p.x).ordered();
    const double middle = quantile(seen, 0.5);
    post::TextTable quantiles{.rows = {{p.name, "shots"}}, .first_width = 44},
        lines{.rows = {{fmt::format("at {}", said_cell(given, fmt::format("{:.4g}", middle))), "value", "slope",
                        "scatter", "explained"}},
              .first_width = 44};
    for (const double share : kShares) quantiles.rows[0].push_back(fmt::format("{:.0f} %", 100 * share));
    post::Figure figure{.title = p.name, .columns = 2, .panel_width = 520, .panel_height = 340};
    for (const StudyPopulation::Measured& m : p.measured) {
      const std::string& output = table.outputs[m.output];
      const std::string spoken = post::label(output);
      post::Panel functions{.x_label = spoken, .y_label = "shots below [%]"},
          over{.x_label = post::label(given), .y_label = spoken};
      const auto add = [&](const Side& side, const std::string& who, const char* key) {
        const Side::Line line = side.line(middle);
        std::vector<std::string> row = {fmt::format("{}, {}", spoken, who), fmt::format("{}", side.y().size())};
        for (const double share : kShares) row.push_back(fmt::format("{:.4g}", quantile(side.ordered(), share)));
        quantiles.rows.push_back(std::move(row));
        lines.rows.push_back({fmt::format("{}, {}", spoken, who), fmt::format("{:.4g}", line.at),
                              post::with_deviation(line.slope, line.slope_error), fmt::format("{:.3g}", line.scatter),
                              fmt::format("{:.0f} %", 100 * line.explained)});
        functions.series.push_back(distribution(side, who));
        over.series.push_back(cloud(side, who));
        json[p.name][output][key] = to_json(side, line);
      };
      add(Side(p.x, m.y), "measured", "measured");
      for (std::size_t model = 0; model < table.models.size(); ++model) {
        const Side side(table.design.numbers(p.given), table.at(model, m.output).y);
        const std::string who = table.models.size() > 1 ? table.models[model] : "computed";
        if (side.enough()) add(side, who, who.c_str());
        else out.lack(fmt::format("{}: {}: fewer than {} points have {}", p.name, who, kLeastRows, spoken));
      }
      figure.panels.push_back(std::move(functions));
      figure.panels.push_back(std::move(over));
    }
    out.show(quantiles, p.name + ": quantiles");
    out.tell("");
    out.show(lines, p.name + ": over " + post::label(given));
    out.tell("");
    if (draw) out.draw(figure, "figures/" + out.file_name(p.name));
  }
  return json;
}

}  // namespace hosel::app
