#include "loop/shots/slow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "golf/dense.hpp"
#include "golf/parallel.hpp"
#include "loop/shots/features.hpp"
#include "loop/shots/inputs.hpp"
#include "loop/shots/problem.hpp"
#include "loop/shots/run.hpp"
#include "loop/shots/spread.hpp"
#include "solvers/errors.hpp"

namespace hosel::loop {
namespace {

constexpr int kRuns = 120, kRunsPerQuantity = 15;  // without effects, and for each quantity that effects change
constexpr int kRounds = 6;                         // of asking where the decision hangs
constexpr double kSmallDoubt = 3;                  // of deviance: an error that moves it by less decides nothing
constexpr std::size_t kTogether = 40;              // shots that show the doubt of a fit, and that are asked for it
constexpr double kSurprise = 2;                    // chi-squared per output up to which its error was told truly

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
  Inputs in = make_inputs(c.shots, c.blow, c.head_mass_declared, c.input_noise, c.loft_unknown);
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
      for (Eigen::Index k = 0; k < slope.size(); ++k) {
        const double h = 1e-4;
        slope[k] = (get(Surrogate::shifted(l, s, h * Vec6::Unit(k)), *output) - get(l, *output)) / h / c.si;
      }
      variance += slope.dot(surrogate.error(s) * slope) / double(shots.size());
    }
    text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", c.name, std::sqrt(variance));
  }
  return text;
}

std::function<void(int)> told(const ShotCase& c, const char* what, std::size_t of) {
  return [&c, what, of](int done) {
    if (c.told) c.told(what, double(done) / double(of));
  };
}

bool same_question(const Shot& a, const Shot& b) {
  return std::ranges::all_of(features(), [&](const Feature& f) {
    const double x = f.get(a), y = f.get(b);
    return x == y || std::abs(x - y) < kLastBits;
  });
}

/// Deviance of a fit whose parameters may still follow by a little, as it is told and with the surrogate's error there,
/// alike in neighbours as it is, in its favour.
struct Doubt {
  double alone = 0, favoured = 0;
  bool matters() const { return alone - favoured > kSmallDoubt; }
};

constexpr int kPlaces = 8;  // of an effect's range where it is looked at

/// Half the way from one of them to the next, in scales.
double way(const Parameter& q) { return (q.max - q.min) / (2 * kPlaces * q.scale); }

Doubt in_doubt(const ShotProblem& problem, const Fit& fit) {
  const std::vector<int>& all = problem.training();
  const std::vector<int> some = evenly(all, kTogether);
  const Eigen::VectorXd z = problem.model().whitened(some, fit.model, fit.p);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(z.size(), z.size());
  if (fit.size() > 0) {
    Eigen::MatrixXd J = problem.model().jacobian(some, fit.model, fit.p);
    const std::vector<const Parameter*> parameters = fit.model.parameters();
    for (Eigen::Index k = 0; k < J.cols(); ++k) J.col(k) *= way(*parameters[k]);
    covariance += J * J.transpose();
  }
  const auto deviance = [&] {
    return z.dot(dense::Cholesky(covariance).solve(z)) * double(all.size()) / double(some.size());
  };
  Doubt out;
  out.alone = deviance();
  covariance += problem.model().surrogate_errors(some, fit.model, fit.p.data());
  out.favoured = deviance();
  return out;
}

/// A single effect where its fit is, and, of one parameter, all over its range: a poor surrogate leads a fit astray.
std::vector<Fit> places(const Fit& fit, Eigen::Index parameters) {
  std::vector<Fit> out{fit};
  if (parameters != 1) return out;
  const Parameter& q = fit.model.forms.back()->parameters.front();
  for (int k = 0; k < kPlaces; ++k) {
    out.push_back(fit);
    out.back().p[fit.p.size() - 1] = q.min + (k + 0.5) / kPlaces * (q.max - q.min);
  }
  return out;
}

}  // namespace

Learnt learn(const ShotCase& c) {
  const SlowBase& slow = *c.slow;
  std::vector<Shot> shots = recorded(c);
  Surrogate coarse(slow.coarse, first_answer);
  ShotCase quick = without_holdout(c);
  quick.surrogate = &coarse;
  const std::vector<Parametrisation> effects = ShotProblem(quick, {}, std::set<int>{}, {}).forms();
  const int runs = slow.runs > 0 ? slow.runs : kRuns + kRunsPerQuantity * changed_quantities(shots, effects);
  try {
    coarse.learn(spread(shots, effects, runs, slow.seed), told(c, "surrogate", std::size_t(runs)));
    if (!slow.fine) return {std::move(shots), nullptr, std::move(coarse)};
    const auto first = std::make_shared<const Surrogate>(std::move(coarse));
    Surrogate fine(slow.fine, [first](const Shot& s) { return first->launch(s); });
    fine.learn(spread(shots, {}, slow.fine_runs, slow.seed + 1),
               told(c, "the case's own accuracy", std::size_t(slow.fine_runs)));
    return {std::move(shots), first, std::move(fine)};
  } catch (const std::invalid_argument& e) {
    throw DataError(fmt::format("{}: surrogate of {}: {}", c.shots.file, c.base, e.what()));
  }
}

LoopResult run_slow(const ShotCase& c) {
  Learnt learnt = learn(c);
  return run_slow(c, learnt);
}

LoopResult run_slow(const ShotCase& c, Learnt& learnt) {
  const SlowBase& slow = *c.slow;
  Surrogate& best = learnt.best;
  ShotCase quick = without_holdout(c);
  quick.surrogate = &best;
  const std::string first_error = errors(best, learnt.shots, c.shots);
  const int first_points = best.points();

  // What was found is asked of the base itself; where that moves it, or was not foreseen, once more.
  LoopResult result = run(quick);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Shot> asked = result.decisive;
    asked.insert(asked.end(), result.checks.begin(), result.checks.end());
    if (asked.empty()) break;
    best.learn(asked, told(c, "where the decision hangs", asked.size()));
    const bool foreseen = best.surprise() < kSurprise;
    if (foreseen && result.decisive.empty()) break;
    const std::vector<std::string> adopted = result.adopted;
    const auto ties = result.ties;
    result = run(quick);
    if (foreseen && result.decisive.empty() && result.adopted == adopted && result.ties == ties) break;
  }

  ShotCase last = c;
  last.slow = nullptr;
  last.model = quick.model;
  last.surrogate = quick.surrogate;
  last.closing = slow.fine ? slow.fine : slow.coarse;
  last.checked = slow.checked;
  const Surrogate& coarse = learnt.coarse ? *learnt.coarse : best;
  last.notes.push_back(fmt::format(
      "{} stands behind a Gaussian process of {} of its answers over {} quantities of blow and effects ({} had "
      "none){}; its error at the shots: {}",
      c.base, learnt.coarse ? coarse.points() : first_points, coarse.inputs(), coarse.failed(),
      learnt.coarse ? fmt::format(", corrected by {} at the case's own accuracy", best.points()) : "", first_error));
  if (best.points() > first_points)
    last.notes.push_back(fmt::format(
        "where the decision hangs {} was asked {} times more, after which the error is {}; {}", c.base,
        best.points() - first_points, errors(best, learnt.shots, c.shots),
        std::isfinite(best.surprise())
            ? fmt::format("the last of these answers were {:.2g} of the told errors away from what had been foretold "
                          "(root mean square)",
                          std::sqrt(best.surprise()))
            : "the last that was asked had no answer"));
  return run(last);
}

void ask_further(const ShotProblem& problem, const Rules& rules, LoopResult& result) {
  constexpr std::size_t likeliest = 4, few = 8;
  const Selection& found = result.selection;
  const auto ask = [&](const Fit& fit, std::size_t most, std::vector<Shot>& into) {
    for (const int i : evenly(problem.training(), most))
      if (Shot s; problem.model().asked(i, fit.model, fit.p.data(), s) &&
                  std::ranges::none_of(into, [&](const Shot& other) { return same_question(s, other); }))
        into.push_back(std::move(s));
  };
  if (in_doubt(problem, found.chosen).matters()) ask(found.chosen, kTogether, result.decisive);
  // A rival that the surrogate makes unlikely may be likely: the base and every single effect are asked about as far
  // as its error reaches.
  struct Rival {
    Fit fit;
    double cost, rank;
  };
  const double free = rules.parameter_cost * found.base.size();
  std::vector<Rival> all{{found.base, free, found.base.deviance + free}}, possible;
  for (std::size_t k = 0; k < found.candidates.size(); ++k) {
    const Candidate& c = found.candidates[k];
    if (c.fit.size() == 0 || (k >= likeliest && c.effects.size() > 1)) continue;
    const double cost = c.criterion - c.fit.deviance + rules.further_gain * double(c.effects.size());
    const bool single = c.effects.size() == 1 && c.fit.model.forms.back()->before;
    for (Fit& fit : places(c.fit, single ? c.fit.size() - found.base.size() : 0))
      all.push_back({std::move(fit), cost, c.fit.deviance + cost});
  }
  const double best = std::ranges::min(all, {}, &Rival::rank).rank;
  for (Rival& r : all) {
    const Doubt doubt = in_doubt(problem, r.fit);
    r.rank = doubt.favoured + known(r.fit) + r.cost;
    if (doubt.matters() && r.rank < best + rules.tie) possible.push_back(std::move(r));
  }
  std::ranges::sort(possible, {}, &Rival::rank);
  for (std::size_t k = 0; k < std::min(kLikeliest, possible.size()); ++k) ask(possible[k].fit, few, result.decisive);
  if (result.decisive.size() < few) ask(found.chosen, few, result.checks);
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
  for_all(std::size_t(0), asked.size(), [&](std::size_t k) {
    const int i = asked[k];
    UsedRow& row = out.rows[k];
    row = {.id = id.at(i), .holdout = true};
    for (const auto& [fit, into] : {std::pair{&before, &row.before}, {&after, &row.after}}) {
      into->assign(std::size_t(model.width()), kNaN);
      if (into == &row.after && after.size() == before.size()) {  // nothing was added
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
      if (!std::isfinite(row.before[j] + row.after[j])) row.before[j] = row.after[j] = kNaN;
  });
  return out;
}

}  // namespace hosel::loop
