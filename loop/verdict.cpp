#include "loop/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "golf/units.hpp"
#include "loop/beyond_doubt.hpp"
#include "loop/detectable.hpp"

namespace hosel::loop {
namespace {

/// Mean log predictive density per held-out value.
double score(const Problem& problem, const Fit& f) {
  const auto [values, log_whitening] = problem.density(Part::holdout);
  if (!(values > 0)) return kNaN;
  return (log_whitening - 0.5 * deviance(problem, Part::holdout, f)) / values - kLogRootTwoPi;
}

std::vector<Location> places(const Problem& problem, const Remainder& left) {
  std::vector<Location> told;
  for (const Remainder::Place& p : left.places)
    told.push_back(
        {problem.channel(p.channel).name, p.along,
         fmt::format("a remainder without a name, {:.3g} RMS and {:+.3g} at {:.4g}", p.size, p.largest, p.at)});
  return told;
}

/// A name that needs no remainder beside it says as much of the training rows as a remainder without it, each foretold
/// by the others; one that needs it says more, and pays for its parameters.
bool beats(const Fit& named, const Fit& base, const std::optional<Remainder>& left,
           const std::optional<Remainder>& bare, const Rules& rules) {
  if (!left || !bare) return true;
  if (left->places.empty()) return left->after < bare->after + rules.tie;
  return left->after + rules.parameter_cost * double(named.size() - base.size()) + rules.tie < bare->after;
}

/// What follows the inputs and no name takes up: `left` by the chosen effects; `bare` by the base, where that says as
/// much.
std::vector<Location> nameless(const Study& study, const std::optional<Remainder>& left,
                               const std::optional<Remainder>& bare) {
  const Selection& s = study.selection;
  if (left && left->fall() > study.rules.gain) return places(study.problem, *left);
  if (s.level > 0 && !beats(s.chosen, s.base, left, bare, study.rules)) return places(study.problem, *bare);
  return {};
}

/// Beside the chosen effects, or where there are none: one free function through one mechanism.
struct Rival {
  std::vector<Location> unexplained = {};  ///< it says more or as much, and is none of the effects
  const Candidate* lone = nullptr;         ///< it says as much as several effects, and is this one of them
  std::vector<std::string> same = {};      ///< every effect that such a function is
  std::string faint = {};                  ///< where no effect is chosen: it is likelier than none, not beyond doubt
};

/// `found`: the functions, the likeliest first.
Rival one_function(const Study& study, const std::vector<Mechanism>& found) {
  if (found.empty()) return {};
  const Selection& s = study.selection;
  const Mechanism& best = found.front();
  const double of_names = criterion(s.chosen, study.rules);
  const std::vector<std::string> names = s.chosen.model.effects(study.base.size());
  // Every further name must pay for itself, here as in the search, where the function is one name or one step.
  const double further = study.rules.further_gain * (double(names.size()) - 1);
  const bool known = best.step || !best.names.empty();
  const bool more = best.criterion + study.rules.tie < of_names,
             as_much = best.criterion < of_names + std::max(study.rules.tie, known ? further : 0);
  // A drift is slow and steady: where a function of the order that is not says as much, there need be none.
  const auto no_drift = std::ranges::find_if(
      found, [&](const Mechanism& m) { return m.along == "shot" && !std::ranges::count(m.names, "session-drift"); });
  const bool drift = names.size() == 1 && names.front() == "session-drift" && no_drift != found.end();
  const auto told = [](const Mechanism& m, std::string_view of_it) {
    return fmt::format("{}, acting through {}{}{}",
                       m.along == "constant" ? "one constant" : fmt::format("one function of {}", m.along), m.acts,
                       m.names.empty() ? "" : fmt::format(" ({})", fmt::join(m.names, " or ")), of_it);
  };
  if (names.empty() && !more)
    return {.faint = best.criterion + kMention < of_names ? told(best, ", is likelier than no effect, not beyond doubt")
                                                          : ""};
  if (!more && !drift && !as_much) return {};
  std::vector<std::string> same;
  for (const Mechanism& m : found) same.insert(same.end(), m.names.begin(), m.names.end());
  const auto is = [&](const std::string& e) { return std::ranges::count(same, e) > 0; };
  // A form of the library for a function of another form keeps its name, where no other function says as much.
  const Mechanism* says = drift && !more ? &*no_drift : &best;
  if (names.size() == 1 && !drift) {
    const auto other = std::ranges::find_if(found, [&](const Mechanism& m) {
      return m.criterion < of_names + study.rules.tie && !std::ranges::count(m.names, names.front());
    });
    if (other == found.end()) return {};
    says = &*other;
  }
  if (names.size() > 1 && !more)
    for (const Candidate& c : s.candidates)
      if (c.effects.size() == 1 && is(c.effects.front()) && std::ranges::count(names, c.effects.front()) &&
          !c.fit.at_bound)
        return {.lone = &c, .same = std::move(same)};
  Location place{study.problem.channel(says->channel).name, says->along, told(*says, "")};
  if (!names.empty()) {
    place.rival = true;
    place.detail += as_much ? fmt::format(", says as much as {}", fmt::join(names, " and "))
                            : ", says as much as one that is a drift";
  }
  return {.unexplained = {std::move(place)}};
}

/// Several names that all act through the normal restitution are one function of it, and so is what else acts through
/// it: which of them the data cannot say.
std::vector<std::string> through_one_restitution(const Study& study) {
  const auto through = [](const Parametrisation* f) {
    const EffectEntry* e = find_effect(f->effect);
    return e && e->function.through == OneFunction::Through::normal_restitution;
  };
  const auto& forms = study.selection.chosen.model.forms;
  if (study.selection.level < 2 ||
      !std::all_of(forms.begin() + std::ptrdiff_t(study.base.size()), forms.end(), through))
    return {};
  std::vector<std::string> tie;
  for (const Parametrisation* f : study.candidates)
    if (through(f) && !std::ranges::count(tie, f->effect)) tie.push_back(f->effect);
  return tie;
}

/// Ties of the effect that is the one function: with effects that are such a function too.
std::vector<std::vector<std::string>> ties_of(const Rival& one, const Selection& s) {
  std::vector<std::string> tie = one.lone->effects;
  for (const auto& of_set : s.ties)
    for (const std::string& e : of_set)
      if (std::ranges::count(one.same, e) && !std::ranges::count(tie, e)) tie.push_back(e);
  if (tie.size() < 2) return {};
  return std::vector<std::vector<std::string>>{tie};
}

/// The one of several chosen effects that alone takes off nearly as much as all of them; none: nullptr.
const Candidate* nearly_alone(const Selection& s, const Study& study) {
  const std::vector<std::string> names = s.chosen.model.effects(study.base.size());
  for (const Candidate& c : s.candidates)
    if (c.effects.size() == 1 && std::ranges::count(names, c.effects.front()) && !c.fit.at_bound &&
        s.base.deviance - c.fit.deviance > study.rules.stand_in * (s.base.deviance - s.chosen.deviance))
      return &c;
  return nullptr;
}

/// What may stand for the effects beyond the base: noise of an input, or errors that the shots of a group share.
std::vector<Location> by_errors(const Study& study, const Fit& f) {
  const std::vector<std::string> names = f.model.effects(study.base.size());
  std::vector<Location> told;
  for (const Attenuation& a : study.problem.attenuations(f))
    if (std::ranges::count(names, a.effect))
      told.push_back({"", a.column,
                      fmt::format("noise or slips in its records ({:.0f} % of their variance) would do the same as {}",
                                  100 * a.share, a.effect)});
  if (names.empty() || !told.empty()) return told;
  const std::optional<Clustered> left = study.problem.clustered(study.selection.base, f);
  const double least = study.rules.gain + study.rules.further_gain * (double(names.size()) - 1);
  if (left && !(left->fall > least))
    told.push_back({"", left->along,
                    fmt::format("its values share errors; beside these {} takes off {:.3g} squared noise units, less "
                                "than {:.3g}",
                                fmt::join(names, " and "), left->fall, least)});
  return told;
}

/// Returns the first verdict whose condition holds, in the order below.
Verdict judge(const Study& study, const std::vector<WrongColumn>& columns, const std::vector<Location>& without_name,
              const Rival& one, const std::vector<std::string>& restitution, std::vector<Location>& unexplained) {
  const Problem& problem = study.problem;
  const Selection& s = study.selection;
  if (!columns.empty()) {
    if (!problem.too_few()) unexplained = problem.places(s);
    for (const WrongColumn& c : columns) unexplained.push_back({"", c.column, c.text});
    return Verdict::unexplained;
  }
  if (problem.too_few()) return Verdict::insufficient;
  if (!s.clean) {
    unexplained = problem.places(s);
    return Verdict::unexplained;
  }
  const auto found = [&](std::vector<Location> places) { return !(unexplained = std::move(places)).empty(); };
  if (found(problem.shapes(s)) || found(without_name) || found(one.unexplained) ||
      found(by_errors(study, one.lone ? one.lone->fit : s.chosen)) ||
      (!s.at_every_shot.empty() && found({{"", "", s.at_every_shot}})))
    return Verdict::unexplained;
  if (s.structured && s.level == 0) return Verdict::insufficient;
  bool declared = false, refuted = false;
  for (int c = 0; c < problem.width(); ++c) {
    declared = declared || problem.channel(c).declared;
    refuted = refuted || problem.channel(c).refuted;
  }
  if (refuted) return Verdict::noise_contradicted;
  if (s.nameless) return Verdict::insufficient;
  // A function that is not beyond doubt is told where nothing else speaks against the base.
  if (!one.faint.empty()) {
    unexplained = problem.doubts(s);
    return unexplained.empty() ? Verdict::insufficient : Verdict::unexplained;
  }
  if (one.lone ? !ties_of(one, s).empty() : !s.ties.empty() || !restitution.empty()) return Verdict::ambiguous;
  unexplained = problem.doubts(s);
  if (s.level > 0 && s.chosen.at_bound)
    unexplained.push_back({"", "",
                           fmt::format("{} would explain it only with a size at the edge of what is plausible",
                                       fmt::join(s.adopted, " and "))});
  if (!unexplained.empty()) return Verdict::unexplained;
  if (declared && problem.heavy_tails(s)) return Verdict::noise_contradicted;
  return s.adopted.empty() ? Verdict::no_residual : Verdict::explained;
}

/// A mean that is off beside another regressor of its channel is a part of what follows that: it is told behind it.
void means_behind(std::vector<Location>& places) {
  for (auto mean = places.begin(); mean != places.end();) {
    const auto follows = std::find_if(mean + 1, places.end(), [&](const Location& l) {
      return l.channel == mean->channel && !l.regressor.empty() && l.regressor != mean->regressor;
    });
    if (mean->regressor == "constant" && follows != places.end()) std::rotate(mean, mean + 1, follows + 1);
    else ++mean;
  }
}

/// Before and after, per row and per channel.
void tell_errors(const Problem& problem, const Fit& base, const Fit& after, LoopResult& result) {
  const std::optional<Remainder>& left = result.remainder;
  const Eigen::MatrixXd rb = problem.residuals(base.model, base.p), ra = problem.residuals(after.model, after.p);
  for (const Problem::Row& row : problem.rows()) {
    UsedRow u{.row = row.row, .id = row.id, .holdout = row.holdout, .measured = {}, .before = {}, .after = {}};
    for (int c = 0; c < problem.width(); ++c) {
      u.measured.push_back(problem.measured()(row.index, c));
      u.before.push_back(rb(row.index, c));
      u.after.push_back(ra(row.index, c));
      u.with_remainder.push_back(ra(row.index, c) - (left ? left->value(row.index, c) : 0));
    }
    result.rows.push_back(std::move(u));
  }
  const auto expected = [&](int c) {
    double variance = 0, rows = 0;
    for (const Problem::Row& row : problem.rows())
      if (row.holdout && std::isfinite(ra(row.index, c))) variance += std::pow(problem.sigma(row.index, c), 2), ++rows;
    return std::sqrt(variance / rows);
  };
  for (int c = 0; c < problem.width(); ++c) {
    const Channel& ch = problem.channel(c);
    result.channels.push_back({.name = ch.name,
                               .noise = ch.noise,
                               .noise_source = !ch.trusted() ? "estimated"
                                               : ch.repeated ? "repeats"
                                                             : "declared",
                               .refuted = ch.refuted ? ch.declared : std::nullopt,
                               .scatter = problem.scatter(c, ra, after.size()).ratio,
                               .expected = expected(c),
                               .before = errors(result.rows, &UsedRow::before, std::size_t(c)),
                               .after = errors(result.rows, &UsedRow::after, std::size_t(c)),
                               .with_remainder = errors(result.rows, &UsedRow::with_remainder, std::size_t(c))});
  }
}

}  // namespace

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

Location place_of(const Problem& problem, const Finding& f) {
  return {problem.channel(f.channel).name, f.regressor, f.what()};
}

std::string ChannelResult::refutation() const {
  return fmt::format("{}: declared noise {:.4g}, the data's own scatter shows {:.4g}", name, *refuted, noise);
}

Errors errors(const std::vector<UsedRow>& rows, std::vector<double> UsedRow::*of, std::size_t channel) {
  Errors e;
  double train = 0, held = 0, bias = 0;
  for (const UsedRow& row : rows) {
    if (channel >= (row.*of).size() || !std::isfinite((row.*of)[channel])) continue;
    const double r = (row.*of)[channel];
    (row.holdout ? held : train) += r * r;
    ++(row.holdout ? e.holdout : e.train);
    if (row.holdout) bias += r;
  }
  e.train_rmse = e.train ? std::sqrt(train / e.train) : kNaN;
  e.holdout_rmse = e.holdout ? std::sqrt(held / e.holdout) : kNaN;
  e.holdout_bias = e.holdout ? bias / e.holdout : kNaN;
  return e;
}

void conclude(const Study& study, LoopResult& result) {
  const Problem& problem = study.problem;
  const Selection& s = result.selection = study.selection;
  result.flagged = problem.flags();
  for (int c = 0; c < problem.width(); ++c) result.channel_names.push_back(problem.channel(c).name);
  for (const Problem::Row& row : problem.rows()) ++(row.holdout ? result.holdout : result.train);
  result.used = result.train + result.holdout;
  std::optional<Remainder> left, bare;
  if (!problem.too_few()) {
    left = problem.remainder(s.chosen);
    bare = s.level > 0 ? problem.remainder(s.base) : left;
  }
  const std::vector<Location> without_name = nameless(study, left, bare);
  if (s.clean && !problem.too_few()) result.functions = problem.mechanisms(s, study.rules);
  Rival one = one_function(study, result.functions);
  for (Mechanism& m : result.functions) m.criterion -= criterion(s.chosen, study.rules);
  const std::vector<std::string> restitution = through_one_restitution(study);
  result.verdict = judge(study, result.columns, without_name, one, restitution, result.unexplained);
  if (result.verdict == Verdict::insufficient) result.faint = one.faint;
  if (result.verdict == Verdict::explained && !s.likelier.empty())
    result.notes.push_back(fmt::format("{} together are likelier than {} alone, not beyond doubt",
                                       fmt::join(s.likelier, " and "), fmt::join(s.adopted, " and ")));
  std::ranges::move(problem.notes(), std::back_inserter(result.notes));
  if (result.verdict == Verdict::noise_contradicted) result.tails = problem.heavy_tails(s).value_or("");
  else if (result.verdict == Verdict::no_residual)
    if (const auto tails = problem.heavy_tails(s)) result.notes.push_back(*tails);
  if (const auto reason = problem.too_few()) {
    result.notes.push_back(*reason);
    result.next = problem.next_experiment(result);
    return;
  }
  // Where the scatter is not the declared, one effect alone is told, and what was held out must come as much nearer as
  // a first effect asks for.
  const bool contradicted = result.verdict == Verdict::noise_contradicted;
  if (contradicted && s.level > 1) one.lone = nearly_alone(s, study);
  const auto foretells = [&] {
    if (s.level != 1 && !one.lone) return false;
    const Fit& told = one.lone ? one.lone->fit : s.chosen;
    return deviance(problem, Part::holdout, told) + study.rules.gain < deviance(problem, Part::holdout, s.base);
  };
  const bool named = result.verdict == Verdict::explained || result.verdict == Verdict::ambiguous ||
                     (contradicted && foretells());
  if (contradicted && !named && bare && bare->fall() > study.rules.gain) {  // then scatter is not all that is there
    result.verdict = Verdict::unexplained;
    result.unexplained = places(problem, *bare);
  }
  if (named) {
    result.ties = one.lone ? ties_of(one, s) : s.ties;
    if (!one.lone && !restitution.empty()) result.ties = {restitution};
    else if (!one.lone) result.adopted = s.adopted;
    else if (result.ties.empty()) result.adopted = one.lone->effects;
  }

  // What was selected on some of the training data is fitted to all of them.
  const bool some = problem.density(Part::select).values < problem.density(Part::train).values;
  const Fit& best = one.lone ? one.lone->fit : s.chosen;
  const Fit chosen = some ? fit(problem, Part::train, best.model, {best.p}, 1, true) : best;

  // The holdout is read here, once: what was chosen must not fail there.
  bool shown = s.level > 0 && named;
  if (shown && deviance(problem, Part::holdout, chosen) >
                   deviance(problem, Part::holdout, s.base) + study.rules.parameter_cost) {
    result.notes.push_back(fmt::format("{} explained the training data and not those held out: not adopted",
                                       fmt::join(chosen.model.effects(study.base.size()), " and ")));
    if (result.verdict != Verdict::noise_contradicted) result.verdict = Verdict::insufficient;
    result.adopted.clear();
    result.ties.clear();
    shown = false;
  }
  // Structure remains: what is beyond doubt is kept all the same.
  BeyondDoubt kept;
  if (result.verdict == Verdict::unexplained && s.level > 0 && (!s.clean || !without_name.empty())) {
    kept = beyond_doubt(study);
    if (kept.fit.size() > 0 && (!beats(kept.fit, s.base, problem.remainder(kept.fit), bare, study.rules) ||
                                !by_errors(study, kept.fit).empty()))
      kept = {};
  }
  const bool some_kept = !kept.adopted.empty() || !kept.ties.empty();
  if (some_kept) {
    result.adopted = kept.adopted;
    result.ties = kept.ties;
  }
  const Fit& after = shown ? chosen : some_kept ? kept.fit : s.base;
  result.remainder = &after == &s.base ? bare : problem.remainder(after);
  result.groups = problem.between_groups(after);
  tell_errors(problem, s.base, after, result);
  for (const ChannelResult& c : result.channels)
    if (c.refuted) result.notes.push_back(c.refutation());
  result.base_score = score(problem, s.base);
  for (std::size_t k = 0; k < std::min(s.candidates.size(), problem.effort().reported); ++k) {
    ScoredCandidate c{.candidate = s.candidates[k], .sd = {}};
    const Eigen::VectorXd variance = covariance(problem, Part::select, c.candidate.fit).diagonal();
    for (const double v : variance) c.sd.push_back(std::sqrt(v));
    c.holdout_score = score(problem, c.candidate.fit);
    result.candidates.push_back(std::move(c));
  }
  for (const std::string& e : s.silent)
    result.notes.push_back(fmt::format("{}: has no influence on these channels", e));
  result.minimum_detectable = minimum_detectable(problem, s.base, study.candidates, study.rules);
  result.likeness = likeness(problem, after, study.candidates);
  means_behind(result.unexplained);
  result.next = problem.next_experiment(result);
  result.selection.chosen = some_kept ? kept.fit : chosen;
  result.covariance = covariance(problem, Part::train, result.selection.chosen);
}

}  // namespace hosel::loop
