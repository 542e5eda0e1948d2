#include "loop/search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "golf/dense.hpp"
#include "golf/parallel.hpp"
#include "loop/structure.hpp"

namespace hosel::loop {
namespace {

std::vector<Candidate> best_of_each(std::vector<Candidate> all) {
  std::ranges::stable_sort(all, {}, &Candidate::criterion);
  std::vector<Candidate> best;
  std::set<std::vector<std::string>> seen;
  for (Candidate& c : all)
    if (std::isfinite(c.criterion) && seen.insert(c.effects).second) best.push_back(std::move(c));
  return best;
}

Eigen::VectorXd joined(std::initializer_list<Eigen::VectorXd> parts) {
  Eigen::Index n = 0, at = 0;
  for (const Eigen::VectorXd& p : parts) n += p.size();
  Eigen::VectorXd all(n);
  for (const Eigen::VectorXd& p : parts) {
    all.segment(at, p.size()) = p;
    at += p.size();
  }
  return all;
}

}  // namespace

std::size_t order_of(const std::string& effect) {
  const auto all = effects();
  return std::size_t(std::ranges::find(all, effect, &EffectEntry::name) - all.begin());
}

Search::Search(const Problem& problem, const std::vector<const Parametrisation*>& base_forms,
               const std::vector<const Parametrisation*>& forms, const Rules& rules, Told told)
    : problem_(problem),
      base_forms_(base_forms.size()),
      rules_(rules),
      told_(std::move(told)),
      effort_(problem.effort()),
      loss_(problem.stages().back().loss) {
  const Model model{base_forms};
  base = fit(problem, Part::select, model, starts(model), effort_.starts);
  z0_ = whitened(problem, Part::select, model, base.p);
  if (!z0_.size()) return;
  weigh(base);

  std::vector<char> moves(forms.size(), 0);
  for_all(std::size_t(0), forms.size(), [&](std::size_t k) { moves[k] = acts(forms[k]); });
  std::set<std::string> active, every;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    every.insert(forms[k]->effect);
    if (!moves[k]) continue;
    active.insert(forms[k]->effect);
    of_form_.push_back({.fit = beside(base, forms[k])});
  }
  std::ranges::set_difference(every, active, std::back_inserter(silent));

  std::vector<Eigen::MatrixXd> columns(of_form_.size());
  for_all(std::size_t(0), of_form_.size(),
          [&](std::size_t k) { columns[k] = about_zero(*of_form_[k].fit.model.forms.back()); });
  const bool quiet = nothing_to_find(columns);
  told_for(told_, "single effects", of_form_.size(), [&](std::size_t k) {
    const Model& with = of_form_[k].fit.model;
    std::vector<Eigen::VectorXd> from;
    for (const Eigen::VectorXd& start : starts(Model{{with.forms.back()}})) {
      from.push_back(joined({base.p, start}));
      if (quiet) break;
    }
    of_form_[k] = candidate(fit(problem_, Part::select, with, from, effort_.starts, quiet));
  });
  singles = best_of_each(of_form_);
  if (!singles.empty()) weigh(singles.front().fit);
  linearise(std::move(columns));
}

/// Where a fit has early stages, far starts are dear: a waste where nothing is left and no form promises anything.
bool Search::nothing_to_find(const std::vector<Eigen::MatrixXd>& columns) const {
  if (!std::isfinite(problem_.stages().front().window)) return false;
  return problem_.structure(base, base, Eigen::MatrixXd(z0_.size(), 0), rules_).p > 0.01 &&
         std::ranges::all_of(columns, [&](const Eigen::MatrixXd& c) {
           return (orthonormal(c).transpose() * z0_).squaredNorm() < 0.6 * rules_.gain;
         });
}

/// The most promising of all pairs, at most three forms of the same two effects, plus one with every partner of the
/// best single effect.
std::vector<Search::Guess> Search::guesses() const {
  std::vector<Guess> all, chosen;
  for (std::size_t a = 0; effort_.pairs > 0 && a < linear_.size(); ++a)
    for (std::size_t b = a + 1; b < linear_.size(); ++b) {
      if (linear_[a].form->effect == linear_[b].form->effect) continue;
      Guess g{0, linear_[a].form, linear_[b].form, {}};
      g.criterion = promise({a, b}, g.p);
      all.push_back(std::move(g));
    }
  std::ranges::stable_sort(all, {}, &Guess::criterion);
  std::map<std::pair<std::string, std::string>, int> tried;
  for (Guess& g : all) {
    const auto key = std::minmax(g.a->effect, g.b->effect);
    int& count = tried[{key.first, key.second}];
    const std::string& best = singles.front().effects.front();
    const bool partner = key.first == best || key.second == best;
    if ((chosen.size() < effort_.pairs && count < 3) || (partner && count < 1)) {
      ++count;
      chosen.push_back(std::move(g));
    }
  }
  return chosen;
}

void Search::fit_pairs() {
  const std::vector<Guess> chosen = guesses();
  std::vector<Candidate> all(chosen.size());
  told_for(told_, "pairs of effects", chosen.size(), [&](std::size_t k) {
    const auto& [criterion, a, b, p] = chosen[k];
    const Eigen::VectorXd pa = optimum(a), pb = optimum(b);
    std::vector<Eigen::VectorXd> from = {joined({base.p, p}), joined({base.p, pa, pb})};
    // A threshold: every start of it beside the other's optimum.
    for (const auto& s : a->threshold ? a->starts : decltype(a->starts){})
      from.push_back(joined({base.p, as_vector(s), pb}));
    for (const auto& s : b->threshold ? b->starts : decltype(b->starts){})
      from.push_back(joined({base.p, pa, as_vector(s)}));
    // An effect with several optima: which of them the other asks for is not known before.
    const std::size_t before = from.size();
    for (const Eigen::VectorXd& other : other_optima(a)) from.push_back(joined({base.p, other, pb}));
    for (const Eigen::VectorXd& other : other_optima(b)) from.push_back(joined({base.p, pa, other}));
    const std::size_t followed = (a->threshold || b->threshold ? 2 : 1) + from.size() - before;
    all[k] = candidate(fit(problem_, Part::select, base.model.with(a).with(b), std::move(from), followed, true));
  });
  std::vector<Candidate> forms = of_form_;
  std::ranges::stable_sort(forms, {}, &Candidate::criterion);
  std::ranges::move(grown(forms, effort_.singles_grown), std::back_inserter(all));
  pairs = refined(std::move(all));
}

void Search::fit_triples() { triples = refined(grown(pairs, effort_.pairs_grown)); }

/// The first few sets with each of the forms that promise most beside them.
std::vector<Candidate> Search::grown(const std::vector<Candidate>& sets, std::size_t few) const {
  struct Plan {
    const Candidate* set;
    const Parametrisation* more;
  };
  std::vector<Plan> plans;
  std::set<std::vector<std::string>> seen;
  for (std::size_t k = 0; k < std::min(sets.size(), few); ++k) {
    const Fit& f = sets[k].fit;
    const Eigen::VectorXd z = weighted(whitened(problem_, Part::select, f.model, f.p));
    const Eigen::MatrixXd Q = orthonormal(weighted(problem_.jacobian(Part::select, f.model, f.p)));
    std::vector<std::pair<double, const Parametrisation*>> ranked(linear_.size());
    for_all(std::size_t(0), linear_.size(), [&](std::size_t j) {
      const Linear& l = linear_[j];
      Eigen::MatrixXd A = columns_.middleCols(l.first, l.count);
      if (effort_.pairs == 0) {  // far from linear: what it does here is not what it does beside the base
        const Fit here = beside(f, l.form);
        A = weighted(problem_.jacobian(Part::select, here.model, here.p).rightCols(l.count));
      }
      A -= Q * (Q.transpose() * A);
      const double fall = (orthonormal(A).transpose() * z).squaredNorm();
      ranked[j] = {-fall + rules_.parameter_cost * double(l.count) + l.form->complexity, l.form};
    });
    std::erase_if(ranked, [&](const auto& r) { return std::ranges::count(sets[k].effects, r.second->effect) > 0; });
    std::ranges::stable_sort(ranked, {}, [](const auto& r) { return r.first; });
    std::set<const Parametrisation*> once;  // a form is looked at in several places
    std::erase_if(ranked, [&](const auto& r) { return !once.insert(r.second).second; });
    for (std::size_t j = 0; j < std::min(ranked.size(), effort_.grown); ++j) {
      std::vector<std::string> names;
      for (const Parametrisation* form : f.model.with(ranked[j].second).forms)
        names.push_back(form->effect + form->what);
      std::ranges::sort(names);
      if (seen.insert(names).second) plans.push_back({&sets[k], ranked[j].second});
    }
  }
  std::vector<Candidate> all(plans.size());
  told_for(told_, "richer sets of effects", plans.size(), [&](std::size_t k) {
    const Fit zero = beside(plans[k].set->fit, plans[k].more);
    const Eigen::VectorXd half = joined({plans[k].set->fit.p, 0.5 * optimum(plans[k].more)});
    all[k] = candidate(fit(problem_, Part::select, zero.model, {half, zero.p}, 1, true));
  });
  return all;
}

/// The best of each set of effects; where a fit has early stages, the best few once more through these.
std::vector<Candidate> Search::refined(std::vector<Candidate> all) const {
  std::ranges::stable_sort(all, {}, &Candidate::criterion);
  if (std::isfinite(problem_.stages().front().window))
    for_all(std::size_t(0), std::min(all.size(), kLikeliest), [&](std::size_t k) {
      const Model& m = all[k].fit.model;
      std::vector<Eigen::VectorXd> from = {all[k].fit.p};
      // Each member at its own optimum, the others at zero.
      Eigen::Index at = base.size();
      for (std::size_t f = base_forms_; f < m.forms.size(); ++f) {
        const Eigen::VectorXd own = optimum(m.forms[f]);
        from.push_back(joined({base.p, Eigen::VectorXd::Zero(m.size() - base.size())}));
        from.back().segment(at, own.size()) = own;
        at += own.size();
      }
      const std::size_t every = from.size();
      Candidate again = candidate(fit(problem_, Part::select, m, std::move(from), every));
      if (again.criterion < all[k].criterion) all[k] = std::move(again);
    });
  return best_of_each(std::move(all));
}

double Search::threshold_gain() const {
  double gain = 0;
  for (const Candidate& c : of_form_)
    if (c.fit.model.forms.back()->threshold) gain = std::max(gain, base.deviance - c.fit.deviance);
  return gain;
}

Eigen::MatrixXd Search::directions() const {
  Eigen::MatrixXd d(z0_.size(), Eigen::Index(of_form_.size()));
  for (std::size_t k = 0; k < of_form_.size(); ++k)
    d.col(Eigen::Index(k)) = whitened(problem_, Part::select, of_form_[k].fit.model, of_form_[k].fit.p) - z0_;
  return d;
}

const Fit& Search::richest() const {
  const Fit* best = &base;
  for (const auto* list : {&singles, &pairs, &triples})
    for (const Candidate& c : *list)
      if (c.fit.deviance < best->deviance) best = &c.fit;
  return *best;
}

void Search::weigh(const Fit& f) {
  const Eigen::VectorXd z = whitened(problem_, Part::select, f.model, f.p);
  weight_.resize(z.size());
  for (Eigen::Index i = 0; i < z.size(); i += loss_.block)
    weight_.segment(i, loss_.block).setConstant(std::sqrt(loss_.weight(z.segment(i, loss_.block).squaredNorm())));
}

Eigen::MatrixXd Search::weighted(const Eigen::MatrixXd& a) const { return weight_.asDiagonal() * a; }

bool Search::acts(const Parametrisation* form) const {
  Fit probe = beside(base, form);
  const auto n = Eigen::Index(form->parameters.size());
  std::vector<Eigen::VectorXd> places;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Parameter& q = form->parameters[k];
    places.push_back(Eigen::VectorXd::Unit(n, k) * (q.max >= q.scale ? q.scale : -q.scale));
  }
  for (const auto& s : form->starts) places.push_back(as_vector(s));
  return std::ranges::any_of(places, [&](const Eigen::VectorXd& place) {
    probe.p.tail(n) = place;
    const Eigen::VectorXd z = whitened(problem_, Part::select, probe.model, probe.p);
    return z.size() && (z - z0_).cwiseAbs().maxCoeff() > 1e-4;
  });
}

const Fit& Search::of(const Parametrisation* form) const {
  return std::ranges::find(of_form_, form, [](const Candidate& c) { return c.fit.model.forms.back(); })->fit;
}

Eigen::VectorXd Search::optimum(const Parametrisation* form) const {
  return of(form).p.tail(Eigen::Index(form->parameters.size()));
}

std::vector<Eigen::VectorXd> Search::other_optima(const Parametrisation* form) const {
  std::vector<Eigen::VectorXd> out;
  if (form->threshold) return out;  // its starts are all tried
  for (const Eigen::VectorXd& p : of(form).others) out.push_back(p.tail(Eigen::Index(form->parameters.size())));
  return out;
}

Candidate Search::candidate(Fit f) const {
  Candidate c{.effects = f.model.effects(base_forms_), .fit = std::move(f)};
  c.criterion = criterion(c.fit, rules_);
  std::ranges::stable_sort(c.effects, {}, order_of);
  return c;
}

/// A form's columns beside the base, per scale of its parameters. The gradient of a threshold vanishes at zero: finite
/// probes stand for it, one column each.
Eigen::MatrixXd Search::about_zero(const Parametrisation& form) const {
  Fit at = beside(base, &form);
  const auto n = Eigen::Index(form.parameters.size());
  if (!form.threshold) return problem_.jacobian(Part::select, at.model, at.p).rightCols(n);
  Eigen::MatrixXd probes = Eigen::MatrixXd::Zero(z0_.size(), Eigen::Index(form.starts.size()));
  for (Eigen::Index k = 0; k < probes.cols(); ++k) {
    at.p.tail(n) = as_vector(form.starts[k]);
    const Eigen::VectorXd z = whitened(problem_, Part::select, at.model, at.p);
    if (z.size()) probes.col(k) = (z - z0_) / (at.p[at.p.size() - 1] / form.parameters.back().scale);
  }
  return probes;
}

void Search::linearise(std::vector<Eigen::MatrixXd> about_zero) {
  std::vector<Eigen::MatrixXd> parts;
  Eigen::Index total = 0;
  for (std::size_t k = 0; k < of_form_.size(); ++k) {
    const Fit& f = of_form_[k].fit;
    const Parametrisation* form = f.model.forms.back();
    const auto n = Eigen::Index(form->parameters.size());
    const auto add = [&](const Eigen::MatrixXd& J) {
      for (Eigen::Index first = 0; first < J.cols(); first += n) {
        parts.push_back(weighted(J.middleCols(first, n)));
        linear_.push_back({form, total, n});
        total += n;
      }
    };
    add(about_zero[k]);
    if (effort_.pairs > 0 && base.deviance - f.deviance > rules_.further_gain)
      add(problem_.jacobian(Part::select, f.model, f.p).rightCols(n));
  }
  columns_.resize(z0_.size(), total);
  for (std::size_t k = 0; k < parts.size(); ++k) columns_.middleCols(linear_[k].first, linear_[k].count) = parts[k];
  if (base_forms_ > 0) {
    const Eigen::MatrixXd Q = orthonormal(weighted(problem_.jacobian(Part::select, base.model, base.p)));
    columns_ -= Q * (Q.transpose() * columns_);
  }
  gram_ = columns_.transpose() * columns_;
  target_ = -columns_.transpose() * weighted(z0_);
}

/// Criterion (up to a constant) of some linearised forms together, and their parameters [SI], kept in range.
double Search::promise(const std::vector<std::size_t>& which, Eigen::VectorXd& p) const {
  std::vector<Eigen::Index> at;
  for (const std::size_t k : which)
    for (Eigen::Index c = 0; c < linear_[k].count; ++c) at.push_back(linear_[k].first + c);
  Eigen::MatrixXd G = gram_(at, at);
  const Eigen::VectorXd b = target_(at);
  G.diagonal() *= 1 + 1e-9;
  G.diagonal().array() += 1e-9;
  Eigen::Index at_known = 0;
  for (const std::size_t w : which)
    for (const Parameter& par : linear_[w].form->parameters)
      G.diagonal()[at_known++] += std::pow(par.scale / par.known, 2);
  Eigen::VectorXd q = dense::Ldlt(G).solve(b);
  // Out of range: held at the edge. One pass is enough for a guess.
  p.resize(q.size());
  double cost = rules_.parameter_cost * double(q.size());
  Eigen::Index k = 0;
  for (const std::size_t w : which) {
    cost += linear_[w].form->complexity;
    for (const Parameter& par : linear_[w].form->parameters) {
      p[k] = std::clamp(q[k] * par.scale, par.min, par.max);
      q[k] = p[k] / par.scale;
      ++k;
    }
  }
  return q.dot(G * q) - 2 * q.dot(b) + cost;
}

}  // namespace hosel::loop
