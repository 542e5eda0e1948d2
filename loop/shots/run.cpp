#include "loop/shots/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "golf/units.hpp"
#include "loop/shots/columns.hpp"
#include "loop/shots/offsets.hpp"
#include "loop/shots/problem.hpp"
#include "loop/shots/recurring.hpp"
#include "loop/shots/slow.hpp"
#include "loop/verdict.hpp"

namespace hosel::loop {
namespace {

std::vector<Input> recorded(const Shots& shots) {
  std::vector<Input> all;
  for (int k = 0; k < kInputs; ++k)
    if (shots.find_stem(stem(Input(k)))) all.push_back(Input(k));
  return all;
}

/// The case with that column as it should read, and what is told of it: names beside it are those of the rest.
std::pair<ShotCase, WrongColumn> set_right(const ShotCase& c, const InputOffset& off) {
  ShotCase right = c;
  Column& column = *right.shots.find(c.shots.find_stem(stem(off.input))->name);
  for (double& x : column.value) x += off.size;
  const auto unit = split_unit(column.name).unit;
  WrongColumn told{column.name, "offset",
                   fmt::format("{} reads {:.4g} {} too {} throughout{}", column.name, std::abs(off.size) / column.si,
                               unit ? unit->suffix : "", off.size < 0 ? "high" : "low",
                               off.beside.empty() ? "" : fmt::format(", beside {}", fmt::join(off.beside, " and ")))};
  return {std::move(right), std::move(told)};
}

/// A column computed from readings carries their noise, so that their residuals follow it whatever is true.
ShotCase without_computed(const ShotCase& given, const std::vector<DerivedColumn>& derived) {
  ShotCase c = given;
  const auto reading = [&](const std::string& name) {
    const Column* from = given.shots.find(name);
    return from && from->role == Role::output;
  };
  for (const DerivedColumn& d : derived)
    if (Column* column = c.shots.find(d.column); column && column->role == Role::other)
      if (std::ranges::any_of(d.from, reading)) column->role = Role::bookkeeping;
  return c;
}

/// `offset`: of a column that was set right; it is told where nothing else remains.
LoopResult pass(const ShotCase& given, const Columns& columns, const std::vector<DerivedColumn>& derived,
                const std::optional<std::set<int>>& held_rows, std::optional<Input> doubted = {},
                const std::optional<WrongColumn>& offset = {}) {
  const ShotCase c = without_computed(given, derived);
  ShotProblem problem(c, derived, held_rows, doubted);
  LoopResult result(c, c.shots.rows());
  result.derived = derived;
  result.unused = problem.unused();
  result.forms = problem.forms();
  const Study study(problem, result.forms, c.effects, c.rules, c.told);
  if (!offset && c.direct && !c.averages && !c.surrogate && !c.closing)
    if (const auto off = likelier_offset(problem, study, recorded(c.shots))) {
      const auto [right, told] = set_right(c, *off);
      // Where more is wrong, the offset is no more than the nearest thing to it.
      if (LoopResult all = pass(right, columns, derived, held_rows, doubted, told); !all.columns.empty()) return all;
    }
  if (!offset) {
    std::vector<Fit> rivals{study.selection.chosen, study.selection.richest};
    for (const Candidate& candidate : study.selection.candidates) rivals.push_back(candidate.fit);
    if (rivals.size() > 30) rivals.resize(30);
    result.columns = columns.contradicted(rivals, result.forms);
  }
  conclude(study, result);
  if (offset && (result.verdict == Verdict::explained || result.verdict == Verdict::ambiguous ||
                 result.verdict == Verdict::no_residual)) {
    result.columns = {*offset};
    result.verdict = Verdict::unexplained;
    result.unexplained.insert(result.unexplained.begin(), {"", offset->column, offset->text});
    result.notes.push_back(fmt::format("{}: taken as it should read for all that follows", offset->column));
    result.next = problem.next_experiment(result);
  }
  const Face& face = c.blow.club.head.face;
  if (std::ranges::count(result.adopted, "cg-shift") && std::isinf(face.bulge) && std::isinf(face.roll))
    result.notes.emplace_back(
        "cg-shift: on a flat face a recorded place of impact that is off by as much is the same blow, and no shot "
        "tells them apart: check where the middle of the face was taken to be");
  if (!problem.too_few()) {
    const bool shown = !result.adopted.empty() || !result.ties.empty();
    const Fit &before = result.selection.base, &after = shown ? result.selection.chosen : before;
    result.balance_before = balance(problem.model(), problem.training(), before.model, before.p.data());
    result.balance_after = balance(problem.model(), problem.training(), after.model, after.p.data());
    if (c.surrogate && !c.closing) ask_further(problem, c.rules, result);
    if (c.closing && !doubted) result.corrected = close(c, problem, before, after);
  }
  return result;
}

/// Flagged rows are no evidence, for a formula or of what a fold foretells. `of`: these alone.
Shots without_flagged(const Shots& shots, const LoopResult& r, const std::set<int>* of = nullptr) {
  Shots clean = shots;
  for (Column& c : clean.columns)
    for (const auto& f : r.flagged)
      if (c.numeric && std::size_t(f.row) < c.value.size() && (!of || of->contains(f.row))) c.value[f.row] = kNaN;
  return clean;
}

/// Of each channel of all rows its number in a fold, which may have fewer; -1: it has none.
std::vector<int> places_in(const LoopResult& fold, const LoopResult& whole) {
  std::vector<int> from;
  for (const ChannelResult& c : whole.channels) {
    const auto at = std::ranges::find(fold.channels, c.name, &ChannelResult::name);
    from.push_back(at == fold.channels.end() ? -1 : int(at - fold.channels.begin()));
  }
  return from;
}

/// What the folds adopted must not fail on the rows that they did not see: squares over the noise, each up to a cap.
bool fails_held_out(const LoopResult& r, double loss) {
  double more = 0;
  for (const UsedRow& row : r.rows)
    for (std::size_t c = 0; c < r.channels.size(); ++c) {
      const auto square = [&](double x) { return std::min(std::pow(x / r.channels[c].expected, 2), kMostSquare); };
      if (std::isfinite(row.before[c]) && std::isfinite(row.after[c]))
        more += square(row.after[c]) - square(row.before[c]);
    }
  return more > loss;
}

/// Every cluster is the holdout once; errors and residuals are pooled over the clusters. What is flagged there is what
/// the pass over all rows flagged: that the others do not foretell a row is no reason to leave it out.
void leave_one_out(const ShotCase& c, const Columns& columns, const std::vector<DerivedColumn>& derived,
                   LoopResult& whole) {
  const Groups g = groups(*c.shots.find(c.split.by));
  std::vector<UsedRow> pooled;
  std::vector<std::pair<double, double>> expected(whole.channels.size());  // sum of squares, their number
  for (std::size_t k = 0; k < g.name.size(); ++k) {
    std::set<int> held;
    for (std::size_t i = 0; i < g.of_row.size(); ++i)
      if (g.of_row[i] == int(k)) held.insert(int(i));
    ShotCase others = c;
    others.shots = without_flagged(c.shots, whole, &held);
    const LoopResult fold = pass(others, columns, derived, held);
    if (fold.channels.empty()) {  // it tested nothing and foretells nothing
      if (fold.holdout > 0)
        whole.notes.push_back(fmt::format("without {} '{}': too few others to foretell its {} rows", c.split.by,
                                          g.name[k], fold.holdout));
      continue;
    }
    const std::vector<int> from = places_in(fold, whole);
    const auto in_order = [&](const std::vector<double>& values) {
      std::vector<double> out;
      for (const int place : from) out.push_back(place < 0 ? kNaN : values[place]);
      return out;
    };
    for (const UsedRow& u : fold.rows)
      if (u.holdout)
        pooled.push_back({.row = u.row,
                          .id = u.id,
                          .holdout = true,
                          .measured = in_order(u.measured),
                          .before = in_order(u.before),
                          .after = in_order(u.after),
                          .with_remainder = in_order(u.with_remainder)});
    for (std::size_t j = 0; j < expected.size(); ++j) {
      const int at = from[j];
      if (at < 0 || !std::isfinite(fold.channels[at].expected)) continue;
      const ChannelResult& ch = fold.channels[at];
      expected[j].first += ch.before.holdout * std::pow(ch.expected, 2);
      expected[j].second += ch.before.holdout;
    }
    if (fold.corrected && whole.corrected)
      for (const UsedRow& r : fold.corrected->rows)
        whole.corrected->rows.push_back(
            {.id = r.id, .holdout = true, .before = in_order(r.before), .after = in_order(r.after)});
    if (fold.holdout > 0)
      whole.notes.push_back(
          fmt::format("without {} '{}': adopted {}{}", c.split.by, g.name[k],
                      fold.adopted.empty() ? "nothing" : fmt::format("{}", fmt::join(fold.adopted, ", ")),
                      fold.ties.empty() ? "" : fmt::format(", tied {}", fmt::join(fold.ties.front(), " or "))));
  }
  std::ranges::stable_sort(pooled, {}, &UsedRow::row);
  for (std::size_t k = 0; k < whole.channels.size(); ++k) {
    whole.channels[k].expected = std::sqrt(expected[k].first / expected[k].second);
    for (const auto& [of, into] : {std::pair{&UsedRow::before, &whole.channels[k].before},
                                   {&UsedRow::after, &whole.channels[k].after},
                                   {&UsedRow::with_remainder, &whole.channels[k].with_remainder}}) {
      const Errors held = errors(pooled, of, k);
      *into = {into->train_rmse, held.holdout_rmse, held.holdout_bias, into->train, held.holdout};
    }
  }
  whole.holdout = int(pooled.size());
  whole.rows = std::move(pooled);
  const bool named = whole.verdict == Verdict::explained || whole.verdict == Verdict::ambiguous;
  if (!named || !fails_held_out(whole, c.rules.parameter_cost)) return;
  whole.notes.push_back(fmt::format("{} explained all rows and not those that were left out in turn: not adopted",
                                    fmt::join(whole.selection.chosen.model.effects(c.effects.size()), " and ")));
  whole.verdict = Verdict::insufficient;
  whole.adopted.clear();
  whole.ties.clear();
  for (ChannelResult& ch : whole.channels) ch.after = ch.with_remainder = ch.before;
  for (UsedRow& u : whole.rows) u.after = u.with_remainder = u.before;
  whole.remainder.reset();
  whole.likeness = {};
  whole.balance_after = whole.balance_before;
  whole.selection.chosen = whole.selection.base;
  if (whole.corrected) {
    for (UsedRow& r : whole.corrected->rows) r.after = r.before;
    whole.corrected->shots.clear();
    whole.corrected->instrument.clear();
  }
  whole.next = ShotProblem(c, derived, std::set<int>{}, {}).next_experiment(whole);
}

/// Numbers that are no readings are left out of their columns; the other results of these shots are used.
ShotCase without_numbers(const ShotCase& given, const std::vector<Recurring>& found) {
  ShotCase c = given;
  for (const Recurring& r : found) {
    for (const int row : r.rows) c.shots.find(r.column)->value[row] = kNaN;
    c.notes.push_back(fmt::format("{}: {}: no readings, left out", r.column, r.reason));
  }
  return c;
}

/// Behind the flags of single rows: one finding each.
void tell(const std::vector<Recurring>& found, const Shots& shots, LoopResult& result) {
  int finding = 0;
  for (const Flag& f : result.flagged) finding = std::max(finding, f.finding);
  for (const Recurring& r : found) {
    ++finding;
    for (const int row : r.rows)
      result.flagged.push_back({row, shots.line[row], shots.id[row], r.column, r.reason, finding});
  }
}

}  // namespace

LoopResult run(const ShotCase& given) {
  if (given.slow) return run_slow(given);
  const std::vector<Recurring> found = given.averages ? std::vector<Recurring>{} : recurring(given.shots);
  const ShotCase c = without_numbers(given, found);
  if (c.shots.rows() > kMostShots)
    throw DataError(fmt::format("{}: {} rows; a loop takes at most {}: give it a sample", c.shots.file, c.shots.rows(),
                                kMostShots));
  // Columns and their formulas are those of the rows, whatever is a mean of them.
  ShotCase rows = c;
  rows.shots = as_read(c);
  rows.averages.reset();
  const Columns columns(rows);
  std::map<std::string, double> noise = c.noise;
  noise.insert(c.input_noise.begin(), c.input_noise.end());
  std::vector<DerivedColumn> derived = audit(rows.shots, c.blow.ball, noise);
  const std::optional<std::set<int>> held = c.split.leave_one_out ? std::optional(std::set<int>{}) : std::nullopt;
  LoopResult result = pass(c, columns, derived, held);
  if (!result.flagged.empty() && !c.averages) {
    // Bad rows can hide a formula: once they are known, look again.
    const std::vector<DerivedColumn> again = audit(without_flagged(c.shots, result), c.blow.ball, noise);
    const auto outputs = [](const std::vector<DerivedColumn>& d) {
      std::set<std::string> names;
      for (const DerivedColumn& x : d)
        if (!x.input && x.share == 1) names.insert(x.column);
      return names;
    };
    const bool refit = outputs(again) != outputs(derived);
    derived = again;
    if (refit) result = pass(c, columns, derived, held);
    result.derived = derived;
  }
  if (c.split.leave_one_out && !result.channels.empty()) leave_one_out(c, columns, derived, result);
  for (const DerivedColumn& d : derived) {
    if (!d.input && d.share == 1) continue;  // no channel to begin with
    std::vector<DerivedColumn> others = derived;
    for (DerivedColumn& x : others) x.share = x.column == d.column ? 1 : x.share;
    std::optional<Input> doubted;
    if (const Column* column = c.shots.find(d.column); column->role == Role::input) doubted = input_of(column->stem);
    if (d.input != doubted.has_value() || (c.loft_unknown && doubted == Input::dynamic_loft)) continue;
    if (!d.input && c.shots.find(d.column)->role != Role::output) continue;
    const LoopResult without = pass(c, columns, others, held, doubted);
    std::vector<std::string> names = without.adopted;
    for (const auto& tie : without.ties) names.push_back(fmt::format("{}", fmt::join(tie, " or ")));
    result.without.emplace_back(d.column, names);
    if (names.empty() && !without.unexplained.empty()) names.push_back(without.unexplained.front().detail);
    result.notes.push_back(
        fmt::format("{} is computed from {}{} and is no independent evidence; without it the verdict is {}{}", d.column,
                    fmt::join(d.from, ", "), d.share < 1 ? fmt::format(" on {:.0f} % of the rows", 100 * d.share) : "",
                    name(without.verdict), names.empty() ? "" : fmt::format(" ({})", fmt::join(names, ", "))));
  }
  tell(found, given.shots, result);
  return result;
}

}  // namespace hosel::loop
