#include "app/study/statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hosel::app {
namespace {

/// All that a statement may name.
std::vector<std::string> variables(const FormulaNames& names, const std::vector<std::string>& figures, bool compared) {
  std::vector<std::string> out = figures;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(out, name) == out.end()) out.push_back(name);
  };
  for (const std::string& c : names.columns) add(c);
  for (const std::string& name : names.outputs) {
    add(name);
    for (const char* of : {"mean", "least", "largest"}) add(fmt::format("{}.{}", of, name));
    if (compared)
      for (const char* of : {"reference", "difference"}) add(fmt::format("{}.{}", of, name));
  }
  return out;
}

}  // namespace

std::vector<StudyStatement> read_study_statements(Table root, const std::vector<std::string>& columns,
                                                  const std::vector<std::string>& outputs,
                                                  const std::vector<std::string>& figures, bool compared) {
  std::vector<StudyStatement> out;
  const FormulaNames called = formula_names(columns, outputs);
  const auto names = variables(called, figures, compared);
  for (Table t : root.tables("statement")) {
    StudyStatement s{.text = t.text({"text", "the statement, a sentence"}),
                     .holds = t.text({"holds", "a formula of outputs and axes that is true where the statement holds"}),
                     .where = t.text({"where", "a formula that is true at the points of which it speaks"}, ""),
                     .names = called,
                     .variables = names};
    for (const auto& [key, formula] : {std::pair{"holds", &s.holds}, {"where", &s.where}}) {
      if (formula->empty() && key == std::string_view("where")) continue;
      check_condition(t, key, *formula, names);
    }
    out.push_back(std::move(s));
  }
  return out;
}

nlohmann::json judge(Output& out, const StudyTable& table, const std::vector<StudyStatement>& statements,
                     const std::vector<StudySeries>& references, const std::vector<StudyGroup>& groups) {
  const auto columns = table.design.columns();
  std::vector<std::vector<double>> numbers;
  for (std::size_t c = 0; c < columns.size(); ++c) numbers.push_back(table.design.numbers(c));
  post::Table verdicts{{{"text", "{}", "statement"}}, {.margin = 2, .least_width = 10, .even = false}};
  const bool named = std::ranges::any_of(groups, [](const StudyGroup& g) { return !g.name.empty(); });
  if (named) verdicts.columns.push_back({"model", "{}", "model"});
  verdicts.columns.insert(
      verdicts.columns.end(),
      {{"verdict", "{}", "verdict"}, {"share", "{}", "holds in", "{:.1f} %", 100}, {"points", "{}", "points"}});
  for (const StudyStatement& s : statements)
    for (const StudyGroup& group : groups) {
      const std::size_t m = group.model;
      Formula holds(s.holds, s.variables), where(s.where.empty() ? "1" : s.where, s.variables);
      const auto set = [&](const std::string& name, double x) {
        holds.set(name, x);
        where.set(name, x);
      };
      for (const auto& [name, value] : group.figures) set(name, value);
      const auto over = [&](const std::vector<std::size_t>& points) {
        for (std::size_t o = 0; o < s.names.outputs.size(); ++o) {
          const std::string& name = s.names.outputs[o];
          StudySeries there;
          for (const std::size_t d : points) there.y.push_back(table.at(m, o).y[d]);
          const StudySeries::Spread all = there.spread();
          set("mean." + name, all.mean);
          set("least." + name, all.low);
          set("largest." + name, all.high);
        }
      };
      const auto at = [&](std::size_t d) {
        for (std::size_t c = 0; c < columns.size(); ++c)
          set(s.names.columns[c], numbers[c].empty() ? NAN : numbers[c][d]);
        for (std::size_t o = 0; o < s.names.outputs.size(); ++o) {
          const std::string& name = s.names.outputs[o];
          const double y = table.at(m, o).y[d];
          set(name, y);
          if (references.empty()) continue;
          const double r = references[m * table.outputs.size() + o].y[d];
          set("reference." + name, r);
          set("difference." + name, table.difference(o, y, r));
        }
      };
      over(group.points);
      std::vector<std::size_t> spoken_of;
      for (const std::size_t d : group.points) {
        at(d);
        if (where().value_or(false)) spoken_of.push_back(d);
      }
      over(spoken_of);
      std::size_t judged = 0, held = 0;
      for (const std::size_t d : spoken_of) {
        at(d);
        const auto true_here = holds();
        if (!true_here) continue;
        ++judged;
        held += *true_here;
      }
      const double share = judged ? double(held) / double(judged) : 0;
      const char* verdict = judged == 0     ? "not judged"
                            : share >= 0.95 ? "holds"
                            : share <= 0.05 ? "fails"
                                            : "undecided";
      verdicts.add(s.text);
      if (named) verdicts.more(group.name);
      verdicts.more(verdict, share, judged);
    }
  out.show(verdicts.shown(), "Statements");
  return verdicts.json();
}

}  // namespace hosel::app
