#include "hosel/loop/shots/slow.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "hosel/loop/shots/inputs.hpp"
#include "hosel/loop/shots/problem.hpp"
#include "hosel/loop/shots/run.hpp"
#include "hosel/loop/shots/spread.hpp"
#include "hosel/models/rigid_eccentric.hpp"
#include "hosel/solvers/errors.hpp"

namespace hosel::loop {
namespace {

constexpr int kRuns = 120, kRunsPerQuantity = 15;  // without effects, and for each quantity that effects change
constexpr int kRounds = 4;                         // of asking where the decision hangs
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kSurprise = 2;  // chi-squared per output up to which its error was told truly

const models::RigidEccentric& closed_form() {
  static const models::RigidEccentric model;
  return model;
}

/// It sticks and knows one law of restitution: what a slow base does otherwise is smooth beside it.
Launch first_answer(const Shot& s) {
  Blow blow = s.blow;
  blow.contact = {};
  return closed_form().launch(blow);
}

/// A pass that sees all rows and shows no holdout.
ShotCase without_holdout(const ShotCase& c) {
  ShotCase all = c;
  all.split = {.holdout_fraction = 0, .seed = c.split.seed, .by = {}, .leave_one_out = false};
  all.slow = nullptr;
  all.model = &closed_form();
  return all;
}

/// Shots as recorded, without the rows that no model of the closed form's family explains: those would stretch the box.
std::vector<Shot> recorded(const ShotCase& c) {
  ShotCase look = without_holdout(c);
  look.effects.clear();
  look.deformable = look.full_club = look.shaft_declared = false;
  look.blow.contact = {};
  std::set<int> flagged;
  for (const Flag& f : run(look).flagged) flagged.insert(f.row);
  std::map<std::string, double> noise;
  for (const auto& [header, value] : c.input_noise)
    if (const Column* column = c.shots.find(header)) noise[header] = value * column->si;
  Inputs in = make_inputs(c.shots, c.blow, c.head_mass_declared, noise, c.loft_unknown);
  std::vector<Shot> out;
  for (std::size_t i = 0; i < in.trials.size(); ++i)
    if (!flagged.contains(in.row_of[i])) out.push_back(std::move(in.trials[i]));
  if (out.empty()) throw DataError(fmt::format("{}: no row is fit to be asked about", c.shots.file));
  return out;
}

/// Root mean square of the surrogate's error in every output column of the data, over the shots.
std::string errors(const Surrogate& surrogate, const std::vector<Shot>& shots, const Shots& data) {
  std::string text;
  for (const Column& c : data.columns) {
    const std::optional<Output> output = c.role == Role::output ? output_of(c.stem) : std::nullopt;
    if (!output || of_flight(*output)) continue;
    double variance = 0;
    for (const Shot& s : shots) {
      const Launch l = surrogate.launch(s);
      Vec6 slope;
      for (int k = 0; k < 6; ++k) {
        const double h = 1e-4;
        slope[k] = (get(Surrogate::shifted(l, s, h * Vec6::Unit(k)), *output) - get(l, *output)) / h / c.si;
      }
      variance += slope.dot(surrogate.error(s) * slope) / double(shots.size());
    }
    text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", c.name, std::sqrt(variance));
  }
  return text;
}

/// At most so many, from all over.
std::vector<int> evenly(const std::vector<int>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<int> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(all[k * all.size() / most]);
  return some;
}

}  // namespace

LoopResult run_slow(const ShotCase& c) {
  const SlowBase& slow = *c.slow;
  const auto told = [&](const char* what, std::size_t of) {
    return [&c, what, of](int done) {
      if (c.told) c.told(what, double(done) / double(of));
    };
  };
  ShotCase quick = without_holdout(c);
  const std::vector<Shot> shots = recorded(c);
  Surrogate coarse(slow.coarse, first_answer, 3);
  Surrogate fine(
      slow.fine ? slow.fine : slow.coarse, [&](const Shot& s) { return coarse.launch(s); }, 2);
  quick.surrogate = &coarse;
  const std::vector<Parametrisation> effects = ShotProblem(quick, {}, std::set<int>{}, {}).forms();
  const int runs = slow.runs > 0 ? slow.runs : kRuns + kRunsPerQuantity * changed_quantities(shots, effects);
  Surrogate& exact = slow.fine ? fine : coarse;
  try {
    coarse.learn(spread(shots, effects, runs, slow.seed), told("surrogate", std::size_t(runs)));
    if (slow.fine) {
      fine.learn(spread(shots, {}, slow.fine_runs, slow.seed + 1),
                 told("the case's own accuracy", std::size_t(slow.fine_runs)));
      quick.surrogate = &fine;
    }
  } catch (const std::invalid_argument& e) {
    throw DataError(fmt::format("{}: surrogate of {}: {}", c.shots.file, c.base, e.what()));
  }

  // What was found is asked of the base itself; where that moves it, or was not foreseen, once more.
  const std::string spread_error = errors(*quick.surrogate, shots, c.shots);
  const int spread_points = exact.points();
  LoopResult result = run(quick);
  for (int round = 0; round < kRounds && !result.decisive.empty(); ++round) {
    const std::vector<std::string> adopted = result.adopted;
    const auto ties = result.ties;
    exact.learn(result.decisive, told("where the decision hangs", result.decisive.size()));
    result = run(quick);
    if (result.adopted == adopted && result.ties == ties && exact.surprise() < kSurprise) break;
  }

  ShotCase last = c;
  last.slow = nullptr;
  last.model = quick.model;
  last.surrogate = quick.surrogate;
  last.closing = slow.fine ? slow.fine : slow.coarse;
  last.checked = slow.checked;
  last.notes.push_back(fmt::format(
      "{} stands behind a sparse polynomial of {} of its answers over {} quantities of blow and effects ({} had none), "
      "its residuals interpolated{}; error of each predicted from the others: {}",
      c.base, coarse.points(), coarse.inputs(), coarse.failed(),
      slow.fine ? fmt::format(", corrected by {} at the case's own accuracy", fine.points()) : "", spread_error));
  if (exact.points() > spread_points)
    last.notes.push_back(fmt::format(
        "where the decision hangs {} was asked {} times more, after which the error is {}; the last of these answers "
        "were {:.2g} of the told errors away from what had been foretold (root mean square)",
        c.base, exact.points() - spread_points, errors(*quick.surrogate, shots, c.shots), std::sqrt(exact.surprise())));
  return run(last);
}

std::vector<Shot> decisive(const ShotProblem& problem, const LoopResult& result) {
  constexpr std::size_t rivals = 4, few = 8, many = 40;
  std::vector<Shot> out;
  const auto ask = [&](const Fit& fit, std::size_t most) {
    for (const int i : evenly(problem.training(), most))
      if (Shot s; problem.model().asked(i, fit.model, fit.p.data(), s)) out.push_back(std::move(s));
  };
  const Selection& found = result.selection;
  ask(found.chosen, many);
  ask(found.base, few);
  for (std::size_t k = 0; k < std::min(rivals, found.candidates.size()); ++k)
    if (found.candidates[k].fit.size() > 0) ask(found.candidates[k].fit, few);
  return out;
}

Corrected close(const ShotCase& c, const ShotProblem& problem, const Fit& before, const Fit& after) {
  Corrected out;
  const ShotModel& model = problem.model();
  for (const Parametrisation* f : after.model.forms)
    if (f->after || f->reading) out.instrument.push_back(f->effect);
  std::vector<int> held, trained;
  std::map<int, std::string> id;
  for (const Problem::Row& r : problem.rows()) {
    (r.holdout ? held : trained).push_back(r.index);
    id[r.index] = r.id;
  }
  const auto most = std::size_t(c.checked);
  for (const int i : evenly(held.empty() ? trained : held, most))
    if (Shot s; model.asked(i, after.model, after.p.data(), s)) {
      out.shots.push_back({id[i], std::move(s), model.seen(i)});
    }
  const std::vector<int> asked = evenly(held, most);
  out.rows.resize(asked.size());
  tbb::parallel_for(std::size_t(0), asked.size(), [&](std::size_t k) {
    const int i = asked[k];
    Corrected::Row& row = out.rows[k];
    row.id = id.at(i);
    for (const auto& [fit, into] : {std::pair{&before, &row.before}, {&after, &row.after}}) {
      into->assign(std::size_t(model.width()), kNone);
      if (fit == &after && after.size() == before.size()) {  // nothing was added
        row.after = row.before;
        continue;
      }
      try {
        std::vector<double> value(into->size());
        if (!model.predict_by(c.closing, i, fit->model, fit->p.data(), value.data())) continue;
        for (std::size_t j = 0; j < value.size(); ++j) (*into)[j] = value[j] - model.measured()(i, Eigen::Index(j));
      } catch (const std::invalid_argument&) {
      } catch (const solvers::NonConvergence&) {}
    }
    // Before and after are compared on the same shots.
    for (std::size_t j = 0; j < row.before.size(); ++j)
      if (!std::isfinite(row.before[j] + row.after[j])) row.before[j] = row.after[j] = kNone;
  });
  return out;
}

}  // namespace hosel::loop
