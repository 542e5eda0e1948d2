#include "loop/shots/spread.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golf/first_contact.hpp"
#include "golf/quantities.hpp"
#include "loop/deviation.hpp"
#include "loop/shots/features.hpp"
#include "solvers/random.hpp"

namespace hosel::loop {
namespace {

struct Reach {
  double low = 0, high = 0;
  void widen(double x) {
    if (!std::isfinite(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// How far the parametrisations take every input and every feature from where a shot has them.
struct Reaches {
  std::vector<Reach> inputs, features;

  Reaches(const Shot& shot, const std::vector<Parametrisation>& effects)
      : inputs(std::size_t(kInputs)), features(loop::features().size()) {
    for (const Parametrisation& f : effects) {
      if (!f.before) continue;
      std::vector<double> p(f.parameters.size(), 0.0);
      for (std::size_t k = 0; k < p.size(); ++k)
        for (const double end : {f.parameters[k].min, f.parameters[k].max}) {
          p[k] = end;
          Shot there = shot;
          f.before(p, there);
          p[k] = 0;
          for (int i = 0; i < kInputs; ++i) inputs[i].widen(get(there.blow, Input(i)) - get(shot.blow, Input(i)));
          for (std::size_t i = 0; i < features.size(); ++i)
            if (const Feature& q = loop::features()[i]; q.set) features[i].widen(q.get(there) - q.get(shot));
        }
    }
  }
};

bool can_happen(const Blow& b) {
  if (!b.club.head.faults().empty()) return false;
  const FirstContact g = first_contact(b);
  return g.approach.dot(g.normal) > 0.2 * b.delivery.club_speed;
}

}  // namespace

int changed_quantities(const std::vector<Shot>& recorded, const std::vector<Parametrisation>& effects) {
  const Reaches reaches(recorded.front(), effects);
  return int(std::ranges::count_if(reaches.features, [](const Reach& r) { return r.low < 0 || r.high > 0; }));
}

std::vector<Shot> spread(const std::vector<Shot>& recorded, const std::vector<Parametrisation>& effects, int points,
                         unsigned long seed) {
  constexpr double share = 0.3;
  const auto n = std::size_t(points);
  std::mt19937_64 random(seed);
  const Reaches reaches(recorded.front(), effects);
  std::vector<std::vector<double>> inputs;
  for (int k = 0; k < kInputs; ++k) {
    const auto [low, high] = range_of(recorded, [&](const Shot& s) { return get(s.blow, Input(k)); });
    const double spare = 0.02 * (high - low);
    const Reach own = Input(k) == Input::head_mass ? Reach{} : reaches.inputs[k];
    inputs.push_back(solvers::latin_column(low - spare + 0.5 * own.low, high + spare + 0.5 * own.high, n, random));
  }
  const Shot& model = recorded.front();
  std::vector<Shot> out;
  for (std::size_t i = 0; i < n; ++i) {
    Shot plain = model;
    for (int k = 0; k < kInputs; ++k) set(plain.blow, Input(k), inputs[k][i]);
    for (int draws = 0;; ++draws) {
      if (draws == 100) throw std::invalid_argument("no blow near the recorded ones can happen");
      Shot s = plain;
      for (std::size_t k = 0; k < reaches.features.size(); ++k) {
        const Feature& q = features()[k];
        const Reach& r = reaches.features[k];
        if (!q.set || !(r.low < 0 || r.high > 0) || solvers::uniform(random) > share) continue;
        const double u = 2 * solvers::uniform(random) - 1;
        q.set(s, q.get(s) + u * u * (r.low < 0 && (u < 0 || !(r.high > 0)) ? r.low : r.high));
      }
      if (!can_happen(s.blow)) continue;
      out.push_back(std::move(s));
      break;
    }
  }
  return out;
}

}  // namespace hosel::loop
