#include "designs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

namespace examination {
namespace {

constexpr double wanted = 4.8;

/// A shot that the report asks for: named inputs, the rest as the session's mean.
Swing designed_swing(const Session& s, const Json& shot) {
  Swing mean;
  for (const Column& c : s.inputs) {
    double sum = 0;
    for (const Swing& w : s.swings) sum += w.*c.member;
    mean.*c.member = sum / s.shots();
  }
  const std::map<std::string, double> units{{"mps", 1}, {"kmh", 1 / 3.6}, {"mph", 0.44704}, {"deg", M_PI / 180},
                                            {"rad", 1}, {"mm", 1e-3},     {"m", 1}};
  for (const auto& [name, value] : shot.items()) {
    const auto cut = name.rfind('_');
    for (const Column& c : s.inputs)
      if (value.is_number() && c.header.substr(0, c.header.rfind('_')) == name.substr(0, cut))
        mean.*c.member = value.get<double>() * units.at(name.substr(cut + 1));
  }
  return mean;
}

/// Distance of the truth to the rival's family over the shots of a session.
double apart(const Set& set, const Form& rival, const Session& s) {
  Truth t = base_truth(s);
  set.hidden[0].apply(t, set.value[0]);
  std::vector<int> rows(static_cast<std::size_t>(s.shots()));
  std::iota(rows.begin(), rows.end(), 0);
  return fit(s, s.swings, {&rival}, predict(s, s.swings, t), whitening(s, s.swings), rows).distance;
}

void add(Session& s, const Swing& w) {
  s.swings.push_back(w);
  s.head_mass_kg.push_back(s.head_mass_kg[0]);
}

/// Shots at corners, on edges and inside the box, as many as the session had, and the same ones for every report.
bool box_parts(const Set& set, const Form& rival) {
  Session s = set.session;
  const std::vector<Swing>& known = set.session.swings;
  Random random(mix(set.seed, set.name));
  for (int k = 0, misses = 0; k < set.shots && misses < 100 * set.shots;) {
    Swing w = known.front();
    for (const Column& c : s.inputs) {
      const auto [low, high] = std::ranges::minmax(known, {}, [&](const Swing& x) { return x.*c.member; });
      const double u = random.uniform(), place = u < 0.4 ? -0.25 : u > 0.6 ? 1.25 : 0.5;
      w.*c.member = low.*c.member + place * (high.*c.member - low.*c.member);
    }
    Session one = set.session;
    one.swings = {w};
    one.head_mass_kg = {s.head_mass_kg[0]};
    try {
      Truth t = base_truth(one);
      set.hidden[0].apply(t, set.value[0]);
      (void)predict(one, one.swings, t);
      add(s, w);
      ++k;
    } catch (const std::domain_error&) {
      ++misses;  // such a blow misses the ball
    }
  }
  return apart(set, rival, s) >= wanted;
}

double shots_needed(const Set& set, const Form& rival, const Json& shots) {
  Session s = set.session;
  double last = std::pow(apart(set, rival, s), 2);
  int added = 0;
  while (added < 4000) {
    const int batch = std::max(static_cast<int>(shots.size()), added);
    for (int k = 0; k < batch; ++k)
      add(s, designed_swing(set.session, shots[static_cast<std::size_t>(k) % shots.size()]));
    const double now = std::pow(apart(set, rival, s), 2);
    if (now >= wanted * wanted) return added + batch * (wanted * wanted - last) / (now - last);
    last = now;
    added += batch;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

Answer judge_answer(const Set& set, const std::string& rival, const Json& next) {
  const auto& forms = natural_forms();
  const auto other = std::ranges::find(forms, rival, &Form::effect);
  if (other == forms.end()) throw std::invalid_argument("no natural form of " + rival);
  Answer a;
  a.ordinary = set.shots * (std::pow(wanted / apart(set, *other, set.session), 2) - 1);
  const bool asks = next.contains("shots") && !next["shots"].empty();
  a.designed = asks ? shots_needed(set, *other, next["shots"]) : std::numeric_limits<double>::infinity();
  a.sensor = next.contains("sensor") && next["sensor"].is_string() && !next["sensor"].get<std::string>().empty();
  a.separable = a.designed <= a.ordinary / 3 || box_parts(set, *other);
  return a;
}

}  // namespace examination
