#include "loop/experiment.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

namespace hosel::loop {
namespace {

const Candidate* find(const Selection& s, std::vector<std::string> effects) {
  std::ranges::sort(effects);
  for (const Candidate& c : s.candidates) {
    auto names = c.effects;
    std::ranges::sort(names);
    if (names == effects) return &c;
  }
  return nullptr;
}

}  // namespace

NextExperiment design(const LoopCase& c, const Problem& problem, const std::vector<int>& rows, const Selection& selection,
                      const std::vector<Location>& unexplained, Verdict verdict) {
  NextExperiment next;
  if (verdict == Verdict::unexplained && !unexplained.empty()) {
    next.text = fmt::format("vary {} on purpose with everything else held, and repeat each setting: {} follows it in a way that no candidate explains",
                            unexplained.front().regressor, unexplained.front().channel);
    return next;
  }
  if (verdict != Verdict::ambiguous || selection.ties.empty()) {
    next.text = verdict == Verdict::insufficient
                    ? "more shots of the same kind: minimum_detectable says how large an effect these could have shown"
                    : "nothing is tied; shots at the edges of the recorded range would narrow the parameters most";
    if (verdict == Verdict::noise_contradicted) next.text = "replicates: ten shots at one setting, to find the instrument's own scatter";
    return next;
  }
  // Two rivals: the best set and the best set with another member of the first tie.
  const std::vector<std::string>& tie = selection.ties.front();
  std::vector<std::string> one = selection.adopted, two = selection.adopted;
  one.push_back(tie[0]);
  two.push_back(tie[1]);
  for (std::size_t k = 1; k < selection.ties.size(); ++k) {
    one.push_back(selection.ties[k][0]);
    two.push_back(selection.ties[k][0]);
  }
  const Candidate *a = find(selection, one), *b = find(selection, two);
  if (!a || !b) {
    for (const Candidate& k : selection.candidates)
      if (int(k.effects.size()) == selection.level) {
        if (!a) a = &k;
        else if (&k != a) {
          b = &k;
          break;
        }
      }
  }
  if (!a || !b || a == b) {
    next.text = "no design found";
    return next;
  }

  const int m = problem.width();
  // The box: what was recorded, a quarter wider on each side, within what a club can do.
  std::vector<int> free;
  std::vector<double> low, high;
  std::vector<const Column*> column;
  for (int k = 0; k < kInputs; ++k) {
    const Column* col = c.shots.find_stem(stem(Input(k)));
    if (!col || k == int(Input::head_mass)) continue;
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (const int i : rows) {
      const double x = get(problem.trial(i).blow, Input(k));
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
    double wide = 0.25 * (hi - lo);
    if (k == int(Input::impact_toe) || k == int(Input::impact_high)) wide = std::max(wide, 0.008);
    if (k == int(Input::club_speed)) wide = std::max(wide, 0.15 * hi);
    lo -= wide;
    hi += wide;
    if (k == int(Input::impact_toe) || k == int(Input::impact_high)) {
      lo = std::max(lo, -0.03);
      hi = std::min(hi, 0.03);
    }
    if (k == int(Input::dynamic_loft)) lo = std::max(lo, radians(5.0)), hi = std::min(std::max(hi, lo + radians(4.0)), radians(62.0));
    if (k == int(Input::club_speed)) lo = std::max(lo, 10.0);
    free.push_back(k);
    low.push_back(lo);
    high.push_back(hi);
    column.push_back(col);
  }
  // Candidate shots: corners and a fixed random sample of the box.
  std::mt19937_64 random(20240607);
  std::vector<Trial> sites;
  const Trial middle = problem.trial(rows[rows.size() / 2]);
  for (int s = 0; s < 384; ++s) {
    Trial t = middle;
    t.order = 0.5;
    for (std::size_t k = 0; k < free.size(); ++k) {
      double u = double(random() >> 11) * 0x1p-53;
      if (s % 2 == 0) u = u < 0.4 ? 0 : u > 0.6 ? 1 : 0.5;
      set(t.blow, Input(free[k]), low[k] + u * (high[k] - low[k]));
    }
    sites.push_back(t);
  }
  // Whitened difference of the rivals and derivatives by the second's parameters, which may follow the first.
  const auto parameters = b->fit.model.parameters();
  const auto nb = std::ptrdiff_t(parameters.size());
  Eigen::VectorXd noise(m);
  for (int ch = 0; ch < m; ++ch) {
    double sum = 0;
    for (const int i : rows) sum += problem.sigma(i, ch);
    noise[ch] = sum / double(rows.size());
  }
  struct Site {
    Eigen::VectorXd d;
    Eigen::MatrixXd J;
  };
  const auto look = [&](const Trial& t, int shot, Site& out) {
    Eigen::VectorXd fa(m), fb(m), up(m), down(m);
    if (!problem.predict(t, shot, a->fit.model, a->fit.p.data(), fa.data()) || !problem.predict(t, shot, b->fit.model, b->fit.p.data(), fb.data()))
      return false;
    out.d = (fa - fb).cwiseQuotient(noise);
    out.J.resize(m, nb);
    Eigen::VectorXd p = b->fit.p;
    for (std::ptrdiff_t k = 0; k < nb; ++k) {
      const double h = 1e-3 * parameters[std::size_t(k)]->scale, at = p[k];
      p[k] = at + h;
      const bool good = problem.predict(t, shot, b->fit.model, p.data(), up.data());
      p[k] = at - h;
      if (!good || !problem.predict(t, shot, b->fit.model, p.data(), down.data())) return false;
      p[k] = at;
      out.J.col(k) = (up - down).cwiseQuotient(noise) / 2e-3;
    }
    return true;
  };
  Eigen::MatrixXd G = 1e-6 * Eigen::MatrixXd::Identity(nb, nb);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(nb);
  double dd = 0;
  const auto add = [&](const Site& s) {
    G += s.J.transpose() * s.J;
    g += s.J.transpose() * s.d;
    dd += s.d.squaredNorm();
  };
  const auto separation = [&](const Eigen::MatrixXd& GG, const Eigen::VectorXd& gg, double ddd) {
    return std::max(0.0, ddd - gg.dot(GG.ldlt().solve(gg)));
  };
  for (const int i : rows) {
    Site s;
    if (look(problem.trial(i), i, s)) add(s);
  }
  next.separation_before = std::sqrt(separation(G, g, dd));
  std::vector<Site> possible;
  std::vector<std::size_t> at;
  for (std::size_t k = 0; k < sites.size(); ++k) {
    Site s;
    if (look(sites[k], -1, s)) {
      possible.push_back(s);
      at.push_back(k);
    }
  }
  // Wanted: a = 4.8 on training rows to come; aim a little higher, since the plan itself rests on fits.
  constexpr double wanted = 5.5 * 5.5;
  const int most = std::max(6, int(rows.size()) / 2);
  double now = separation(G, g, dd);
  std::vector<std::size_t> chosen;
  while (now < wanted && int(chosen.size()) < most && !possible.empty()) {
    double best = -1;
    std::size_t which = 0;
    for (std::size_t k = 0; k < possible.size(); ++k) {
      const Site& s = possible[k];
      const double value = separation(G + s.J.transpose() * s.J, g + s.J.transpose() * s.d, dd + s.d.squaredNorm());
      if (value > best) {
        best = value;
        which = k;
      }
    }
    add(possible[which]);
    chosen.push_back(at[which]);
    now = separation(G, g, dd);
  }
  next.separation_after = std::sqrt(now);
  for (const std::size_t k : chosen) {
    DesignedShot shot;
    for (std::size_t j = 0; j < free.size(); ++j)
      shot.inputs.emplace_back(column[j]->name, get(sites[k].blow, Input(free[j])) / column[j]->si);
    next.shots.push_back(shot);
  }
  const auto tied = fmt::format("{} and {}", fmt::join(a->effects, " + "), fmt::join(b->effects, " + "));
  if (now < 0.8 * wanted) {
    const EffectEntry *ea = find_effect(tie[0]), *eb = find_effect(tie[1]);
    std::string sensor = ea ? std::string(ea->sensor) : "";
    if (eb && eb->sensor != (ea ? ea->sensor : "")) sensor += (sensor.empty() ? "" : "; or ") + std::string(eb->sensor);
    next.sensor = sensor;
    next.text = fmt::format("no number of shots of this kind separates {} ({:.1f} noise units after {} designed shots, 4.8 are needed): measure {}",
                            tied, next.separation_after, chosen.size(), sensor);
    next.shots.clear();
  } else {
    next.text = fmt::format("{} shots at these inputs separate {}: {:.1f} noise units now, {:.1f} then (4.8 are needed)", chosen.size(), tied,
                            next.separation_before, next.separation_after);
  }
  return next;
}

}  // namespace hosel::loop
