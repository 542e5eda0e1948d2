#include "hosel/loop/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "hosel/loop/verdict.hpp"

namespace hosel::loop {

std::string_view name(Verdict v) {
  switch (v) {
    case Verdict::no_residual: return "no-residual";
    case Verdict::explained: return "explained";
    case Verdict::ambiguous: return "ambiguous";
    case Verdict::unexplained: return "unexplained";
    case Verdict::insufficient: return "insufficient";
    case Verdict::noise_contradicted: return "noise-contradicted";
  }
  return "";
}

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Rows flagged for what stands in this column: no evidence for or against a formula.
Shots without_flagged(const Shots& shots, const LoopResult& r) {
  Shots clean = shots;
  for (Column& c : clean.columns)
    for (const auto& f : r.flagged)
      if (c.numeric && std::size_t(f.row) < c.value.size()) c.value[std::size_t(f.row)] = kNaN;
  return clean;
}

/// Every cluster is the holdout once; errors and residuals are pooled over the clusters.
void leave_one_out(const LoopCase& c, const std::vector<DerivedColumn>& derived, LoopResult& whole) {
  const Groups g = groups(*c.shots.find(c.split.by));
  std::vector<UsedShot> pooled;
  std::vector<double> score_sum(whole.candidates.size(), 0.0);
  for (std::size_t k = 0; k < g.name.size(); ++k) {
    std::set<int> held;
    for (std::size_t i = 0; i < g.of_row.size(); ++i)
      if (g.of_row[i] == int(k)) held.insert(int(i));
    Study fold(c, derived, held);
    conclude(fold);
    for (const UsedShot& u : fold.result.shots)
      if (u.holdout) pooled.push_back(u);
    if (fold.result.holdout > 0)
      whole.notes.push_back(fmt::format(
          "without {} '{}': adopted {}{}", c.split.by, g.name[k],
          fold.result.adopted.empty() ? "nothing" : fmt::format("{}", fmt::join(fold.result.adopted, ", ")),
          fold.result.ties.empty() ? "" : fmt::format(", tied {}", fmt::join(fold.result.ties.front(), " or "))));
  }
  std::ranges::stable_sort(pooled, {}, &UsedShot::row);
  for (std::size_t ch = 0; ch < whole.channels.size(); ++ch) {
    const auto pool = [&](Errors& e, auto&& value) {
      double square = 0, sum = 0, n = 0;
      for (const UsedShot& u : pooled)
        if (ch < u.before.size() && std::isfinite(value(u))) {
          square += value(u) * value(u);
          sum += value(u);
          ++n;
        }
      e.holdout = int(n);
      e.holdout_rmse = n ? std::sqrt(square / n) : kNaN;
      e.holdout_bias = n ? sum / n : kNaN;
    };
    pool(whole.channels[ch].before, [&](const UsedShot& u) { return u.before[ch]; });
    pool(whole.channels[ch].after, [&](const UsedShot& u) { return u.after[ch]; });
  }
  whole.shots = pooled;
  whole.holdout = int(pooled.size());
}

}  // namespace

LoopResult run(const LoopCase& c) {
  if (c.shots.rows() > kMostShots)
    throw DataError(fmt::format("{}: {} rows; a loop takes at most {}: give it a sample", c.shots.file, c.shots.rows(),
                                kMostShots));
  std::vector<DerivedColumn> derived = audit(c.shots, c.blow.ball);
  const std::optional<std::set<int>> held = c.split.leave_one_out ? std::optional(std::set<int>{}) : std::nullopt;
  const auto pass = [&](std::optional<Input> doubted = {}) {
    auto study = std::make_unique<Study>(c, derived, held, doubted);
    conclude(*study);
    return std::move(study->result);
  };
  LoopResult result = pass();
  if (!result.flagged.empty()) {
    // Bad rows can hide a formula: once they are known, look again.
    const std::vector<DerivedColumn> again = audit(without_flagged(c.shots, result), c.blow.ball);
    const auto outputs = [](const std::vector<DerivedColumn>& d) {
      std::set<std::string> names;
      for (const DerivedColumn& x : d)
        if (!x.input) names.insert(x.column);
      return names;
    };
    const bool refit = outputs(again) != outputs(derived);
    derived = again;
    if (refit) result = pass();
    result.derived = derived;
  }
  if (c.split.leave_one_out && !result.channels.empty()) leave_one_out(c, derived, result);
  for (const DerivedColumn& d : derived) {
    if (!d.input) continue;
    for (int k = 0; k < kInputs; ++k) {
      const Column* column = c.shots.find_stem(stem(Input(k)));
      if (!column || column->name != d.column) continue;
      const LoopResult without = pass(Input(k));
      std::vector<std::string> names = without.adopted;
      for (const auto& tie : without.ties) names.push_back(fmt::format("{}", fmt::join(tie, " or ")));
      result.without.emplace_back(d.column, names);
      result.notes.push_back(
          fmt::format("{} is computed from {} and is no independent evidence; without it the verdict is {}{}", d.column,
                      fmt::join(d.from, ", "), name(without.verdict),
                      names.empty() ? "" : fmt::format(" ({})", fmt::join(names, ", "))));
    }
  }
  return result;
}

}  // namespace hosel::loop
