#include "loop/select.hpp"

#include <algorithm>
#include <cmath>

namespace hosel::loop {
namespace {

bool has(const std::vector<std::string>& names, const std::string& name) { return std::ranges::count(names, name) > 0; }

/// Names common to all sets are beyond the tie. Each other name of the best set is tied with what stands for it where
/// the rest of that set is kept. False: some set is no choice of one name from each tie; its names are then in all of
/// them.
bool tell_ties(const std::vector<const Candidate*>& tied, Selection& out) {
  const std::vector<std::string>& best = tied.front()->effects;
  out.adopted = best;
  for (const Candidate* c : tied) std::erase_if(out.adopted, [&](const std::string& e) { return !has(c->effects, e); });
  if (tied.size() < 2) return true;
  std::vector<std::vector<std::string>> lists;  // one per name of the best set that is not common
  for (const std::string& e : best)
    if (!has(out.adopted, e)) lists.push_back({e});
  const auto add = [&](const Candidate& c, std::vector<std::string>& list) {
    for (const std::string& e : c.effects)
      if (!has(best, e) && !has(list, e)) list.push_back(e);
  };
  const auto replaced = [&](const Candidate& c) {
    std::vector<std::vector<std::string>*> of;
    for (auto& list : lists)
      if (!has(c.effects, list.front())) of.push_back(&list);
    return of;
  };
  for (const Candidate* c : tied)
    if (const auto of = replaced(*c); of.size() == 1) add(*c, *of.front());
  bool choices = true;
  for (const Candidate* c : tied) {
    const auto of = replaced(*c);
    if (of.size() < 2) continue;
    const auto in = [&](const std::string& e) {
      return has(best, e) || std::ranges::any_of(of, [&](const auto* list) { return has(*list, e); });
    };
    const bool from_each = std::ranges::all_of(
        of, [&](const auto* list) { return std::ranges::any_of(c->effects, [&](auto& e) { return has(*list, e); }); });
    if (from_each && std::ranges::all_of(c->effects, in)) continue;
    choices = false;
    for (auto* list : of) add(*c, *list);
  }
  // A list of one name is no tie: every rival set keeps that name, or the rivals are counted in another list.
  for (auto& list : lists)
    if (list.size() > 1) out.ties.push_back(list);
    else out.adopted.push_back(list.front());
  std::ranges::stable_sort(out.adopted, {}, order_of);
  return choices;
}

}  // namespace

Selection select(const Problem& problem, const std::vector<const Parametrisation*>& base,
                 const std::vector<const Parametrisation*>& forms, const Rules& rules, bool deep, const Told& told) {
  Selection s;
  Search search(problem, base, forms, rules, told);
  s.base = s.chosen = search.base;
  s.silent = search.silent;
  const auto fall = [&](const std::vector<Candidate>& from) {
    return from.empty() ? 0.0 : search.base.deviance - from.front().fit.deviance;
  };

  // Without an effect worth a name its residual is noise with the likeliest part taken out: near to noise is the base.
  const bool effect = fall(search.singles) > rules.gain;
  s.before =
      problem.structure(search.base, effect ? search.singles.front().fit : search.base, search.directions(), rules);
  // A signal that is none beside the scatter is noise declared too small, unless the inputs foretell that scatter.
  const auto signals = [&](const StructureMap& map, const Fit& f) {
    if (!(map.signal > rules.remaining_signal)) return false;
    if (map.beside > rules.remaining_signal) return true;
    const std::optional<Remainder> left = problem.remainder(f);
    return left && left->fall() > rules.gain * std::pow(map.signal / map.beside, 2);  // in units of that scatter
  };
  s.structured = s.before.p < rules.gate || signals(s.before, search.base) ||
                 search.threshold_gain() > 2 * rules.further_gain;
  const auto choose = [&](const Fit& f) {
    s.chosen = f;
    s.after = problem.structure(f, f, Eigen::MatrixXd(0, 0), rules);
    s.clean = !(s.after.p < rules.remaining || signals(s.after, f));
  };

  const std::vector<Candidate>* level = nullptr;
  if (effect && s.structured) {
    level = &search.singles;
    s.level = 1;
    choose(level->front().fit);
    const auto step = [&](const std::vector<Candidate>& more) {
      if (more.empty()) return;
      const double gain = level->front().criterion - more.front().criterion;
      if (gain > rules.further_gain || (!s.clean && gain > rules.further_share * rules.further_gain)) {
        level = &more;
        ++s.level;
        choose(more.front().fit);
      }
    };
    search.fit_pairs();
    step(search.pairs);
    // Two effects may stand for three that are as likely: these are looked at, clean or not.
    if (s.level == 2 && deep) {
      search.fit_triples();
      step(search.triples);
    }
  } else {
    if (s.structured && !search.singles.empty()) {
      // Two weak effects may pass together where neither does alone.
      search.fit_pairs();
      if (fall(search.pairs) > 2 * rules.gain) {
        level = &search.pairs;
        s.level = 2;
      }
    }
    choose(level ? level->front().fit : search.base);
  }

  if (level && s.clean) {
    // An effect that is a little rare in all its forms may be second for that, but is not out of the tie for it.
    const auto likelihood = [&](const Candidate& c) {
      double value = c.criterion;
      for (const std::string& e : c.effects) {
        double usual = kInfinity;
        for (const Parametrisation* f : forms)
          if (f->effect == e) usual = std::min(usual, f->complexity);
        if (usual <= rules.parameter_cost) value -= usual;
      }
      return value;
    };
    const Candidate& best = level->front();
    std::vector<const Candidate*> tied;
    const auto add = [&](const Candidate& c) {
      if (likelihood(c) <= likelihood(best) + rules.tie) tied.push_back(&c);
    };
    std::ranges::for_each(*level, add);
    // A larger set is another explanation where it does without one of these names; of two for one, if it is likelier.
    const auto holds = [](const Candidate& c, const Candidate& part) {
      return std::ranges::all_of(part.effects, [&](const std::string& e) { return has(c.effects, e); });
    };
    // With another tied set in it, it is that set and more.
    const std::vector<const Candidate*> as_large = tied;
    const auto more = [&](const Candidate& c) {
      return std::ranges::any_of(as_large, [&](const Candidate* t) { return holds(c, *t); });
    };
    for (const Candidate& c : search.triples)
      if (c.effects.size() > best.effects.size() && !more(c)) add(c);
    for (const Candidate& c : search.pairs) {
      if (s.level > 1 || c.fit.at_bound || !(c.criterion + rules.tie < best.criterion)) continue;
      if (!holds(c, best)) add(c);
      else if (s.likelier.empty()) s.likelier = c.effects;
    }
    // Many sets without a name in common that are no choices from few ties: the data do not name anything.
    const bool choices = tell_ties(tied, s);
    s.nameless = s.level > 1 && s.adopted.empty() && tied.size() > 4 && !choices;
  }
  s.richest = search.richest();
  for (auto* list : {&search.singles, &search.pairs, &search.triples})
    s.candidates.insert(s.candidates.end(), std::make_move_iterator(list->begin()),
                        std::make_move_iterator(list->end()));
  // Ranked as they are adopted: every further effect must pay for itself.
  std::ranges::stable_sort(s.candidates, {}, [&](const Candidate& c) {
    return c.criterion + rules.further_gain * double(c.effects.size());
  });
  return s;
}

}  // namespace hosel::loop
