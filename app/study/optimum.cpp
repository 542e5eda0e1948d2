#include "app/study/optimum.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "app/study/formula.hpp"
#include "post/labels.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

FormulaNames called(const StudyTable& table) { return formula_names(table.design.columns(), table.outputs); }

std::vector<std::string> names_of(const StudyTable& table) {
  const FormulaNames of = called(table);
  std::vector<std::string> names = of.columns;
  names.insert(names.end(), of.outputs.begin(), of.outputs.end());
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

constexpr double kSpare = 2;  // standard deviations of the emulator by which a condition is met

/// In shares of what may be drawn: a whole range, or two standard deviations to either side.
std::pair<double, double> allowed(const DrawnColumn& column) {
  constexpr double two_sd = 0.02275;
  return column.spread.kind == solvers::Distribution::Kind::normal ? std::pair{two_sd, 1 - two_sd}
                                                                   : std::pair{0.0, 1.0};
}

struct Found {
  Eigen::VectorXd share, x;
  double expected = NAN;
};

/// Draws over the whole range, then ever closer to the best that is allowed.
std::optional<Found> seek(const StudyTable& table, const StudyEffects& effects, const StudyOptimum& optimum,
                          std::size_t model) {
  const std::size_t first = model * table.outputs.size();
  const StudyEmulator& of = *effects.emulators[first + optimum.output];
  const auto columns = table.design.columns();
  const FormulaNames names = called(table);
  const auto d = Eigen::Index(columns.size());
  Formula where(optimum.where.empty() ? "1" : optimum.where, names_of(table));
  std::mt19937_64 random(1965);
  constexpr int rounds = 10, draws = 2000;
  constexpr double closer = 0.5;
  std::optional<Found> best;
  for (int round = 0; round < rounds; ++round)
    for (int k = 0; k < draws; ++k) {
      Found tried{.share = Eigen::VectorXd(d), .x = {}};
      const double width = best ? std::pow(closer, round) : 1;
      for (Eigen::Index i = 0; i < d; ++i) {
        const auto [low, high] = allowed(of.columns()[std::size_t(i)]);
        const double middle = best ? best->share[i] : (low + high) / 2;
        tried.share[i] = std::clamp(middle + width * (high - low) * (solvers::uniform(random) - 0.5), low, high);
      }
      tried.x = of.at_shares(tried.share);
      tried.expected = of(tried.x);
      if (best && (optimum.largest ? tried.expected <= best->expected : tried.expected >= best->expected)) continue;
      if (!optimum.where.empty()) {
        for (std::size_t c = 0; c < columns.size(); ++c) where.set(names.columns[c], tried.x[Eigen::Index(c)]);
        bool met = true;
        for (const double sds : {-kSpare, kSpare}) {
          for (std::size_t o = 0; o < table.outputs.size(); ++o)
            if (const std::string& name = names.outputs[o]; where.uses(name)) {
              const StudyEmulator& e = *effects.emulators[first + o];
              where.set(name, e(tried.x) + sds * std::max(e.error(), e.expected_error(tried.x)));
            }
          met = met && where().value_or(false);
        }
        if (!met) continue;
      }
      best = std::move(tried);
    }
  return best;
}

}  // namespace

std::optional<StudyOptimum> read_optimum(Table root, const StudyTable& table) {
  auto t = root.optional_table("optimum");
  if (!t) return {};
  if (table.design.only_drawn().empty()) t->fail("", "an optimum is sought over a [sample] and nothing else beside it");
  StudyOptimum out;
  const std::string output = t->text({"output", "whose optimum is sought"});
  const auto at = std::ranges::find(table.outputs, output);
  if (at == table.outputs.end())
    t->fail("output", fmt::format("'{}' is no output of this study ({})", output, fmt::join(table.outputs, ", ")));
  out.output = std::size_t(at - table.outputs.begin());
  out.largest = t->choice({"seek", "of the output"}, {"largest", "least"}) == "largest";
  out.where = t->text({"where", "a formula of outputs and axes that is true at what is allowed"}, "");
  if (!out.where.empty()) check_condition(*t, "where", out.where, names_of(table));
  return out;
}

nlohmann::json report_optimum(Output& out, const StudyTable& table, const StudyEffects& effects,
                              const StudyOptimum& optimum, const AnswersAt& answers) {
  nlohmann::json json = nlohmann::json::object();
  const auto columns = table.design.columns();
  const FormulaNames names = called(table);
  for (std::size_t model = 0; model < table.models.size(); ++model) {
    const std::size_t first = model * table.outputs.size();
    const std::string& name = table.models[model];
    const std::string whose = table.models.size() == 1 ? "" : name + ": ";
    std::string lacking;
    Formula where(optimum.where.empty() ? "1" : optimum.where, names_of(table));
    for (std::size_t o = 0; o < table.outputs.size(); ++o)
      if (!effects.emulators[first + o] && (o == optimum.output || where.uses(names.outputs[o])))
        lacking = table.outputs[o];
    auto& entry = name.empty() ? json : json[name];  // another case answers: it has no model's name
    if (!lacking.empty()) {
      entry = {{"sought", false}};
      out.warn(fmt::format("{}no optimum is sought: these points do not predict {} well enough; take more of them",
                           whose, lacking));
      continue;
    }
    const auto found = seek(table, effects, optimum, model);
    if (!found) {
      entry = {{"sought", true}, {"found", false}};
      out.warn(fmt::format("{}nowhere in the ranges is the condition of [optimum] met: {}", whose, optimum.where));
      continue;
    }
    std::vector<std::string> set;
    std::string place, edges;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double x = found->x[Eigen::Index(c)], share = found->share[Eigen::Index(c)];
      const DrawnColumn& drawn = effects.emulators[first + optimum.output]->columns()[c];
      for (const std::string& key : drawn.keys) set.push_back(fmt::format("{}={}", key, x));
      place += (place.empty() ? "" : ", ") + said_cell(columns[c], fmt::format("{:.4g}", x));
      entry["at"][columns[c]] = x;
      const auto [low, high] = allowed(drawn);
      constexpr double near = 0.002;
      if (share < low + near || share > high - near) edges += (edges.empty() ? "" : ", ") + columns[c];
    }
    const StudyEmulator& of = *effects.emulators[first + optimum.output];
    const std::string label = post::label(table.outputs[optimum.output]);
    const auto cut = label.find(" [");
    const std::string unit = cut == label.npos ? "" : " " + label.substr(cut + 2, label.size() - cut - 3);
    std::vector<std::optional<double>> confirmed(table.outputs.size());
    try {
      confirmed = answers(set, model);
    } catch (const solvers::NonConvergence& e) { out.warn(e.what()); } catch (const std::invalid_argument& e) {
      out.warn(e.what());
    }
    const auto& answer = confirmed[optimum.output];
    const double error = of.expected_error(found->x);
    entry["expected"] = found->expected;
    entry["expected_error"] = error;
    std::string said = fmt::format("{}{} {} is {:.5g}{}: {}. ", whose, optimum.largest ? "Largest" : "Least",
                                   label.substr(0, cut), answer.value_or(found->expected), unit, place);
    if (answer) {
      entry["confirmed"] = *answer;
      said += fmt::format(
          "The model answers {:.5g} there; the emulator expected {:.5g} with a standard deviation of {:.2g}.", *answer,
          found->expected, error);
      for (std::size_t c = 0; c < columns.size(); ++c) where.set(names.columns[c], found->x[Eigen::Index(c)]);
      for (std::size_t o = 0; o < table.outputs.size(); ++o) where.set(names.outputs[o], confirmed[o].value_or(NAN));
      const bool met = where().value_or(false);
      entry["condition_met"] = met;
      std::string others;
      for (std::size_t o = 0; o < table.outputs.size(); ++o)
        if (o != optimum.output && confirmed[o])
          others += (others.empty() ? "" : ", ") + said_cell(table.outputs[o], fmt::format("{:.4g}", *confirmed[o]));
      if (!others.empty()) said += fmt::format(" With it: {}.", others);
      if (!met) said += fmt::format(" But the model does not meet the condition there: {}.", optimum.where);
    } else {
      said += "The model gives no answer there: this is what the emulator expects.";
    }
    if (!edges.empty()) said += fmt::format(" It lies at an end of the range of {}.", edges);
    out.say(said);
    out.page().sentence(said);
  }
  return json;
}

}  // namespace hosel::app
