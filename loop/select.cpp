#include "hosel/loop/select.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace hosel::loop {
namespace {

/// A form made linear about a point: whitened columns per unit of scale.
struct Linear {
  const Form* form;
  Eigen::VectorXd about;  // parameters of the form alone [SI]
  std::ptrdiff_t first = 0, count = 0;
};

int order_of(const std::string& effect) {
  int k = 0;
  for (const EffectEntry& e : effects()) {
    if (e.name == effect) return k;
    ++k;
  }
  return k;
}

class Search {
 public:
  Search(const Problem& problem, const std::vector<int>& rows, const std::vector<const Form*>& base,
         const std::vector<const Form*>& forms, const Loss& loss, const Rules& rules)
      : problem_(problem), rows_(rows), base_(base), forms_(forms), loss_(loss), rules_(rules) {
    Model m{base};
    base_fit = fit(problem, rows, m, starts(m), loss);
    z0 = whitened(problem, rows, m, base_fit.p);
    weights_of(z0);
  }

  Fit base_fit;
  Eigen::VectorXd z0, weight;
  std::vector<Candidate> singles, pairs, triples;
  std::vector<std::string> silent;

  void fit_singles() {
    std::vector<Candidate> all(forms_.size());
    std::vector<char> acts(forms_.size(), 0);
    tbb::parallel_for(std::size_t(0), forms_.size(), [&](std::size_t k) {
      Model m = with({forms_[k]});
      acts[k] = influences(m, int(base_fit.p.size()), *forms_[k]);
      if (acts[k]) all[k] = candidate(m, from_starts(m));
    });
    std::set<std::string> active, every;
    std::vector<Candidate> kept;
    for (std::size_t k = 0; k < forms_.size(); ++k) {
      every.insert(forms_[k]->effect);
      if (!acts[k]) continue;
      active.insert(forms_[k]->effect);
      kept.push_back(all[k]);
      form_fits_.push_back(all[k]);
    }
    for (const std::string& e : every)
      if (!active.contains(e)) silent.push_back(e);
    singles = best_of_each(std::move(kept));
    if (!singles.empty()) weights_of(whitened(problem_, rows_, singles.front().fit.model, singles.front().fit.p));
    linearise();
  }

  void fit_pairs() {
    struct Guess {
      double criterion;
      std::size_t a, b;
      Eigen::VectorXd p;
    };
    std::vector<Guess> guesses;
    for (std::size_t a = 0; a < linear_.size(); ++a)
      for (std::size_t b = a + 1; b < linear_.size(); ++b) {
        if (linear_[a].form->effect == linear_[b].form->effect) continue;
        Guess g{0, a, b, {}};
        g.criterion = predicted({a, b}, g.p);
        guesses.push_back(g);
      }
    std::ranges::stable_sort(guesses, {}, &Guess::criterion);
    // The most promising pairs, at most three forms of the same two effects, plus every partner of the best single.
    std::map<std::pair<std::string, std::string>, int> tried;
    std::vector<Guess> chosen;
    for (const Guess& g : guesses) {
      const auto key = std::minmax(linear_[g.a].form->effect, linear_[g.b].form->effect);
      int& count = tried[{key.first, key.second}];
      const bool partner = !singles.empty() &&
                           (key.first == singles[0].effects[0] || key.second == singles[0].effects[0]);
      if ((chosen.size() < 36 && count < 3) || (partner && count < 1)) {
        ++count;
        chosen.push_back(g);
      }
    }
    std::vector<Candidate> all(chosen.size());
    tbb::parallel_for(std::size_t(0), chosen.size(), [&](std::size_t k) {
      const Guess& g = chosen[k];
      Model m = with({linear_[g.a].form, linear_[g.b].form});
      Eigen::VectorXd from(base_fit.p.size() + g.p.size());
      from << base_fit.p, g.p;
      std::vector<Eigen::VectorXd> starting = {from};
      Eigen::VectorXd second(from.size());
      second << base_fit.p, single_optimum(linear_[g.a].form), single_optimum(linear_[g.b].form);
      starting.push_back(second);
      // A threshold: every start of it beside the other's optimum.
      bool threshold = false;
      std::ptrdiff_t at = base_fit.p.size();
      for (const Form* form : {linear_[g.a].form, linear_[g.b].form}) {
        const auto n = std::ptrdiff_t(form->parameters.size());
        for (const auto& s : form->starts) {
          starting.push_back(second);
          starting.back().segment(at, n) = Eigen::Map<const Eigen::VectorXd>(s.data(), n);
          threshold = true;
        }
        at += n;
      }
      all[k] = candidate(m, starting, threshold ? 2 : 1);
    });
    pairs = best_of_each(std::move(all));
  }

  void fit_triples() {
    std::vector<std::pair<Model, Eigen::VectorXd>> tries;
    std::set<std::vector<std::string>> seen;
    for (std::size_t k = 0; k < std::min<std::size_t>(pairs.size(), 4); ++k) {
      const Candidate& pair = pairs[k];
      std::vector<std::pair<double, const Form*>> ranked;
      const Eigen::VectorXd z = whitened(problem_, rows_, pair.fit.model, pair.fit.p);
      const Eigen::MatrixXd Q = orthonormal(weighted(whitened_jacobian(problem_, rows_, pair.fit.model, pair.fit.p)));
      const Eigen::VectorXd zw = weighted(z);
      for (const Linear& l : linear_) {
        if (std::ranges::count(pair.effects, l.form->effect)) continue;
        Eigen::MatrixXd A = columns_.middleCols(l.first, l.count);
        A -= Q * (Q.transpose() * A);
        const Eigen::MatrixXd basis = orthonormal(A);
        ranked.emplace_back(
            -(basis.transpose() * zw).squaredNorm() + rules_.parameter_cost * double(l.count) + l.form->rarity, l.form);
      }
      std::ranges::stable_sort(ranked, {}, [](const auto& r) { return r.first; });
      for (std::size_t j = 0; j < std::min<std::size_t>(ranked.size(), 6); ++j) {
        Model m = pair.fit.model;
        m.forms.push_back(ranked[j].second);
        std::vector<std::string> names;
        for (const Form* f : m.forms) names.push_back(f->effect + f->what);
        std::ranges::sort(names);
        if (!seen.insert(names).second) continue;
        Eigen::VectorXd from(pair.fit.p.size() + std::ptrdiff_t(ranked[j].second->parameters.size()));
        from << pair.fit.p, 0.5 * single_optimum(ranked[j].second);
        tries.emplace_back(m, from);
      }
    }
    std::vector<Candidate> all(tries.size());
    tbb::parallel_for(std::size_t(0), tries.size(), [&](std::size_t k) {
      Eigen::VectorXd zero = tries[k].second;
      zero.tail(std::ptrdiff_t(tries[k].first.forms.back()->parameters.size())).setZero();
      all[k] = candidate(tries[k].first, {tries[k].second, zero}, 1);
    });
    triples = best_of_each(std::move(all));
  }

  /// Fall of the deviance by the best threshold effect. It acts on few shots, which the map's weights take for bad
  /// ones; that a plausible threshold explains them is seen here only.
  double threshold_gain() const {
    double gain = 0;
    for (const Candidate& c : form_fits_)
      if (!c.fit.model.forms.back()->starts.empty()) gain = std::max(gain, base_fit.deviance - c.fit.deviance);
    return gain;
  }

  /// Whitened unit directions of the candidates, for the gate.
  Eigen::MatrixXd directions() const {
    Eigen::MatrixXd d(z0.size(), std::ptrdiff_t(form_fits_.size()));
    for (std::size_t k = 0; k < form_fits_.size(); ++k)
      d.col(std::ptrdiff_t(k)) = whitened(problem_, rows_, form_fits_[k].fit.model, form_fits_[k].fit.p) - z0;
    return d;
  }

 private:
  const Problem& problem_;
  const std::vector<int>& rows_;
  const std::vector<const Form*>& base_;
  const std::vector<const Form*>& forms_;
  const Loss loss_;
  const Rules& rules_;
  std::vector<Candidate> form_fits_;
  std::vector<Linear> linear_;
  Eigen::MatrixXd columns_, gram_;
  Eigen::VectorXd target_;

  void weights_of(const Eigen::VectorXd& z) {
    const int m = problem_.width();
    weight.resize(std::ptrdiff_t(rows_.size()));
    for (std::ptrdiff_t i = 0; i < weight.size(); ++i) weight[i] = loss_.weight(z.segment(i * m, m).squaredNorm());
  }
  Eigen::MatrixXd weighted(Eigen::MatrixXd a) const {
    if (a.cols() == 0) return a;
    const int m = problem_.width();
    for (std::ptrdiff_t i = 0; i < weight.size(); ++i) a.middleRows(i * m, m) *= std::sqrt(weight[i]);
    return a;
  }

  Model with(std::vector<const Form*> more) const {
    Model m{base_};
    m.forms.insert(m.forms.end(), more.begin(), more.end());
    return m;
  }

  bool influences(const Model& m, int before, const Form& form) const {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(m.size());
    p.head(before) = base_fit.p;
    std::vector<Eigen::VectorXd> probes;
    for (std::size_t k = 0; k < form.parameters.size(); ++k) {
      Eigen::VectorXd q = Eigen::VectorXd::Zero(std::ptrdiff_t(form.parameters.size()));
      const Parameter& par = form.parameters[k];
      q[std::ptrdiff_t(k)] = par.max >= par.scale ? par.scale : -par.scale;
      probes.push_back(q);
    }
    for (const auto& s : form.starts)
      probes.push_back(Eigen::Map<const Eigen::VectorXd>(s.data(), std::ptrdiff_t(s.size())));
    for (const Eigen::VectorXd& q : probes) {
      p.tail(q.size()) = q;
      if ((whitened(problem_, rows_, m, p) - z0).cwiseAbs().maxCoeff() > 1e-4) return true;
    }
    return false;
  }

  std::vector<Eigen::VectorXd> from_starts(const Model& m) const {
    std::vector<Eigen::VectorXd> all = starts(m);
    for (Eigen::VectorXd& s : all) s.head(base_fit.p.size()) = base_fit.p;
    return all;
  }

  Candidate candidate(const Model& m, const std::vector<Eigen::VectorXd>& from, std::size_t most = 2) const {
    Candidate c;
    c.fit = fit(problem_, rows_, m, from, loss_, most);
    c.criterion = c.fit.deviance + rules_.parameter_cost * m.size();
    for (const Form* f : m.forms) c.criterion += f->rarity;
    for (std::size_t k = base_.size(); k < m.forms.size(); ++k) c.effects.push_back(m.forms[k]->effect);
    std::ranges::stable_sort(c.effects, {}, order_of);
    return c;
  }

  static std::vector<Candidate> best_of_each(std::vector<Candidate> all) {
    std::ranges::stable_sort(all, {}, &Candidate::criterion);
    std::vector<Candidate> best;
    std::set<std::vector<std::string>> seen;
    for (Candidate& c : all)
      if (seen.insert(c.effects).second) best.push_back(std::move(c));
    return best;
  }

  Eigen::VectorXd single_optimum(const Form* form) const {
    for (const Candidate& c : form_fits_)
      if (c.fit.model.forms.back() == form) return c.fit.p.tail(std::ptrdiff_t(form->parameters.size()));
    return Eigen::VectorXd::Zero(std::ptrdiff_t(form->parameters.size()));
  }

  void linearise() {
    std::vector<Eigen::MatrixXd> parts;
    std::ptrdiff_t total = 0;
    const double base_deviance = base_fit.deviance;
    for (const Candidate& c : form_fits_) {
      const Form* form = c.fit.model.forms.back();
      const auto n = std::ptrdiff_t(form->parameters.size());
      const auto add = [&](const Eigen::VectorXd& about, Eigen::MatrixXd J) {
        parts.push_back(weighted(std::move(J)));
        linear_.push_back({form, about, total, n});
        total += n;
      };
      const Model& m = c.fit.model;
      Eigen::VectorXd p(m.size());
      p.head(base_fit.p.size()) = base_fit.p;
      if (!form->starts.empty()) {
        // A threshold: its gradient vanishes at zero, so finite probes stand for it.
        for (const auto& s : form->starts) {
          p.tail(n) = Eigen::Map<const Eigen::VectorXd>(s.data(), n);
          add(p.tail(n), (whitened(problem_, rows_, m, p) - z0) / (p[p.size() - 1] / form->parameters.back().scale));
        }
      } else {
        p.tail(n).setZero();
        add(p.tail(n), whitened_jacobian(problem_, rows_, m, p).rightCols(n));
      }
      if (base_deviance - c.fit.deviance > 15) {
        add(c.fit.p.tail(n), whitened_jacobian(problem_, rows_, m, c.fit.p).rightCols(n));
      }
    }
    columns_.resize(z0.size(), total);
    for (std::size_t k = 0; k < parts.size(); ++k) columns_.middleCols(linear_[k].first, linear_[k].count) = parts[k];
    if (!base_.empty()) {
      const Eigen::MatrixXd Q = orthonormal(weighted(whitened_jacobian(problem_, rows_, base_fit.model, base_fit.p)));
      columns_ -= Q * (Q.transpose() * columns_);
    }
    gram_ = columns_.transpose() * columns_;
    target_ = -columns_.transpose() * weighted(z0);
  }

  /// Criterion (up to a constant) of some linearised forms together, and their parameters [SI], kept in range.
  double predicted(std::vector<std::size_t> which, Eigen::VectorXd& p) const {
    std::vector<std::ptrdiff_t> at;
    for (const std::size_t k : which)
      for (std::ptrdiff_t c = 0; c < linear_[k].count; ++c) at.push_back(linear_[k].first + c);
    const auto n = std::ptrdiff_t(at.size());
    Eigen::MatrixXd G(n, n);
    Eigen::VectorXd b(n);
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      b[i] = target_[at[std::size_t(i)]];
      for (std::ptrdiff_t j = 0; j < n; ++j) G(i, j) = gram_(at[std::size_t(i)], at[std::size_t(j)]);
    }
    G.diagonal() *= 1 + 1e-9;
    G.diagonal().array() += 1e-9;
    Eigen::VectorXd q = G.ldlt().solve(b);
    // Out of range: hold at the edge. One pass is enough for a guess.
    p.resize(n);
    std::ptrdiff_t k = 0;
    for (const std::size_t w : which)
      for (const Parameter& par : linear_[w].form->parameters) {
        p[k] = std::clamp(q[k] * par.scale, par.min, par.max);
        q[k] = p[k] / par.scale;
        ++k;
      }
    double rarity = 0;
    for (const std::size_t w : which) rarity += linear_[w].form->rarity;
    return q.dot(G * q) - 2 * q.dot(b) + rules_.parameter_cost * double(n) + rarity;
  }
};

/// Names common to all sets are beyond the tie; what differs is tied.
void ties_of(const std::vector<const Candidate*>& tied, Selection& out) {
  std::vector<std::string> common = tied.front()->effects;
  for (const Candidate* c : tied)
    std::erase_if(common, [&](const std::string& e) { return !std::ranges::count(c->effects, e); });
  out.adopted = common;
  if (tied.size() < 2) return;
  std::vector<std::string> lead = tied.front()->effects;
  std::erase_if(lead, [&](const std::string& e) { return std::ranges::count(common, e) > 0; });
  std::vector<std::vector<std::string>> lists;
  for (const std::string& e : lead) lists.push_back({e});
  for (const Candidate* c : tied) {
    std::vector<std::string> rest = c->effects;
    std::erase_if(rest, [&](const std::string& e) { return std::ranges::count(common, e) > 0; });
    std::vector<std::string> fresh;
    for (const std::string& e : rest)
      if (!std::ranges::count(lead, e)) fresh.push_back(e);
    for (std::size_t k = 0; k < lead.size(); ++k) {
      if (std::ranges::count(rest, lead[k])) continue;  // this member of the best set is kept here
      for (const std::string& e : fresh)
        if (!std::ranges::count(lists[k], e)) lists[k].push_back(e);
    }
  }
  // A list of one name is no tie: every rival set keeps that name, or the rivals are counted in another list.
  for (auto& l : lists)
    if (l.size() > 1) out.ties.push_back(l);
    else out.adopted.push_back(l[0]);
  std::ranges::stable_sort(out.adopted, {}, order_of);
}

}  // namespace

Selection select(const Problem& problem, const std::vector<int>& rows, const std::vector<const Form*>& base,
                 const std::vector<const Form*>& candidates, const std::vector<Regressor>& regressors, const Loss& loss,
                 const std::vector<char>& declared, const Rules& rules, bool deep) {
  Selection s;
  s.regressors = regressors;
  Search search(problem, rows, base, candidates, loss, rules);
  search.fit_singles();
  s.base = s.chosen = search.base_fit;
  s.silent = search.silent;
  const int m = problem.width();
  const auto weights = [&](const Eigen::VectorXd& z) {
    Eigen::VectorXd w(std::ptrdiff_t(rows.size()));
    for (std::ptrdiff_t i = 0; i < w.size(); ++i) w[i] = loss.weight(z.segment(i * m, m).squaredNorm());
    return w;
  };
  const auto jacobian = [&](const Fit& f) { return whitened_jacobian(problem, rows, f.model, f.p); };

  // Without an effect worth a name its residual is noise with the likeliest part taken out: such flips find too much.
  const bool effect = !search.singles.empty() &&
                      search.base_fit.deviance - search.singles.front().fit.deviance > rules.gain;
  const Fit& near = effect ? search.singles.front().fit : search.base_fit;
  const Eigen::VectorXd scatter = whitened(problem, rows, near.model, near.p);
  s.before = structure(problem, rows, search.z0, scatter, weights(scatter), jacobian(search.base_fit), regressors,
                       search.directions(), {}, rules.flips, rules.seed);
  const auto strongest = [&](const StructureMap& map) {
    for (const Finding& f : map.findings)
      if (f.channel >= 0 ? declared[std::size_t(f.channel)] : std::ranges::all_of(declared, std::identity{}))
        return std::abs(f.signal);
    return 0.0;
  };
  s.structured = s.before.p < rules.gate || strongest(s.before) > rules.remaining_signal ||
                 search.threshold_gain() > rules.threshold_gain;

  const auto check = [&](const Fit& f) {
    const Eigen::VectorXd z = whitened(problem, rows, f.model, f.p);
    s.after = structure(problem, rows, z, z, weights(z), jacobian(f), regressors, Eigen::MatrixXd(z.size(), 0), {},
                        rules.flips, rules.seed);
    return !(s.after.p < rules.remaining || strongest(s.after) > rules.remaining_signal);
  };

  const std::vector<Candidate>* level = nullptr;
  if (effect && s.structured) {
    search.fit_pairs();
    level = &search.singles;
    s.level = 1;
    s.clean = check(search.singles.front().fit);
    const auto step = [&](const std::vector<Candidate>& more) {
      if (more.empty()) return;
      const double fall = level->front().criterion - more.front().criterion;
      if (fall > rules.further_gain || (!s.clean && fall > 0.7 * rules.further_gain)) {
        level = &more;
        ++s.level;
        s.clean = check(more.front().fit);
      }
    };
    step(search.pairs);
    if (s.level == 2 && !s.clean && deep) {
      search.fit_triples();
      step(search.triples);
    }
    s.chosen = level->front().fit;
  } else if (!search.singles.empty() && s.structured) {
    // Two weak effects may pass together where neither does alone.
    search.fit_pairs();
    if (!search.pairs.empty() && search.base_fit.deviance - search.pairs.front().fit.deviance > 2 * rules.gain) {
      level = &search.pairs;
      s.level = 2;
      s.chosen = search.pairs.front().fit;
    }
    s.clean = check(s.chosen);
  } else {
    s.clean = check(s.chosen);
  }

  if (level && s.clean) {
    // An effect that is a little rare in all its forms may be second for that, but is not out of the tie for it.
    const auto likelihood = [&](const Candidate& c) {
      double value = c.criterion;
      for (const std::string& e : c.effects) {
        double usual = std::numeric_limits<double>::infinity();
        for (const Form* f : candidates)
          if (f->effect == e) usual = std::min(usual, f->rarity);
        if (usual <= rules.parameter_cost) value -= usual;
      }
      return value;
    };
    std::vector<const Candidate*> tied;
    for (const Candidate& c : *level)
      if (likelihood(c) <= likelihood(level->front()) + rules.tie) tied.push_back(&c);
    ties_of(tied, s);
    // Many sets without a name in common: the data do not name anything.
    s.nameless = s.level > 1 && s.adopted.empty() && tied.size() > 4;
  }
  for (const auto* list : {&search.singles, &search.pairs, &search.triples})
    s.candidates.insert(s.candidates.end(), list->begin(), list->end());
  std::ranges::stable_sort(s.candidates, {}, &Candidate::criterion);
  return s;
}

}  // namespace hosel::loop
