#include "hosel/loop/history/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "hosel/loop/median.hpp"

namespace hosel::loop {
namespace {

/// Scatter of a channel by third differences, which a smooth motion leaves small: a first idea of the noise.
double rough_noise(const std::vector<HistoryRecord>& records, int channel) {
  std::vector<double> size;
  for (const HistoryRecord& r : records)
    for (std::ptrdiff_t i = 3; i < r.measured.rows(); ++i) {
      const auto y = [&](std::ptrdiff_t k) { return r.measured(i - k, channel); };
      const double d = y(0) - 3 * y(1) + 3 * y(2) - y(3);
      if (std::isfinite(d)) size.push_back(std::abs(d));
    }
  return 1.4826 * median(size) / std::sqrt(20.0);
}

/// Whole records where there are enough and none needs its own start; else stretches of time, the first never.
void split(const HistoryCase& c, std::vector<HistoryRecord>& records) {
  std::mt19937_64 random(c.split.seed);
  const double fraction = c.split.holdout_fraction;
  for (HistoryRecord& r : records) r.train.assign(r.times.size(), 1);
  if (!(fraction > 0)) return;
  const auto group = std::max<std::size_t>(2, std::size_t(std::lround(1 / fraction)));
  if (!c.start_unknown && records.size() >= 3) {
    std::vector<std::size_t> order(records.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    const std::size_t held =
        std::clamp<std::size_t>(std::size_t(std::lround(fraction * double(records.size()))), 1, records.size() - 1);
    for (std::size_t k = 0; k < held; ++k) records[order[k]].train.assign(records[order[k]].times.size(), 0);
    return;
  }
  for (HistoryRecord& r : records) {
    const std::size_t n = r.times.size(), blocks = std::min<std::size_t>(3 * group, n / 8);
    for (std::size_t first = 0; first + 1 < blocks; first += group) {
      const std::size_t size = std::min(group, blocks - first);
      std::size_t block = first + random() % size;
      if (block == 0) block = 1;
      for (std::size_t i = n * block / blocks; i < n * (block + 1) / blocks; ++i) r.train[i] = 0;
    }
  }
}

/// What every set of effects within the tie has is beyond it; each other member of the best set is tied with what
/// stands in its place elsewhere.
void settle(const std::vector<const Candidate*>& tied, Selection& out) {
  const auto has = [](const Candidate* c, const std::string& e) { return std::ranges::count(c->effects, e) > 0; };
  const Candidate* best = tied.front();
  for (const std::string& e : best->effects) {
    std::vector<std::string> list = {e};
    for (const Candidate* c : tied)
      if (!has(c, e))
        for (const std::string& other : c->effects)
          if (!has(best, other) && !std::ranges::count(list, other)) list.push_back(other);
    if (list.size() > 1) out.ties.push_back(list);
    else out.adopted.push_back(e);
  }
}

bool is_clean(const std::vector<HistoryFinding>& f) {
  return f.empty() || f.front().p_adjusted > HistoryStudy::kRemaining;
}

}  // namespace

HistoryStudy::HistoryStudy(const HistoryCase& c) : history_case(c) {
  result.title = c.title;
  result.base = c.base;
  result.seed = c.split.seed;
  result.notes = c.notes;
  std::vector<HistoryRecord> records = c.records;
  std::vector<HistoryChannel> channels = c.setting.channels;
  for (const HistoryRecord& r : records) result.read += int(r.times.size());
  for (const HistoryChannel& ch : channels) result.channel_names.push_back(ch.name);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    HistoryChannel& ch = channels[k];
    declared_noise.push_back(ch.noise);
    const double floor = std::max(ch.resolution / std::sqrt(12.0), 1e-9);
    if (!ch.declared) ch.noise = std::max(rough_noise(records, int(k)), floor);
    if (!(ch.noise > 0)) ch.noise = floor;
  }
  split(c, records);
  HistorySetting setting = c.setting;
  setting.channels = channels;
  for (const HistoryEffect& e : history_effects())
    for (HistoryForm& f : e.forms(setting)) history_forms.push_back(std::move(f));
  for (const HistoryForm& f : history_forms) result.forms.push_back(f.form);
  for (std::size_t k = 0; k < history_forms.size(); ++k) forms[&result.forms[k]] = &history_forms[k];
  for (const std::string& name : c.effects) {
    const Form* form = nullptr;
    for (const Form& f : result.forms)
      if (f.effect == name && !form) form = &f;
    if (!form) throw DataError(fmt::format("effect '{}' cannot act on this test", name));
    base.push_back(form);
  }
  for (const Form& f : result.forms)
    if (!std::ranges::count(c.effects, f.effect)) candidates.push_back(&f);
  problem = std::make_unique<HistoryProblem>(*c.model, std::move(records), std::move(channels), forms);
  work();
}

double HistoryStudy::period() const {
  return history_case.setting.frequency > 0 ? 2 * kPi / history_case.setting.frequency : 1e300;
}

std::vector<HistoryFinding> HistoryStudy::test(const Fit& f) const {
  Eigen::VectorXd z;
  if (!problem->whitened(f.model, f.p.data(), kWhole, z)) return {};
  return history_structure(*problem, z);
}

/// Level and colour of the noise from the residuals of a fit. Returns the largest relative change.
double HistoryStudy::estimate_noise(const Fit& at) {
  std::vector<Eigen::MatrixXd> e;
  if (!problem->residuals(at.model, at.p.data(), e)) return 0;
  double change = 0;
  for (int c = 0; c < problem->width(); ++c) {
    const HistoryChannel ch = problem->channels()[std::size_t(c)];
    Colour noise = colour(*problem, e, c, false);
    if (noise.rho < 0.06) noise = colour(*problem, e, c, true);
    const bool trusted = ch.declared && !std::ranges::count(contradicted, ch.name);
    double sigma = trusted ? declared_noise[std::size_t(c)] : noise.sigma;
    sigma = std::max({sigma, ch.resolution / std::sqrt(12.0), 1e-9});
    change = std::max({change, std::abs(std::log(sigma / ch.noise)), std::abs(noise.rho - ch.colour)});
    problem->set_noise(c, sigma, noise.rho);
  }
  return change;
}

/// Readings that stand alone far from a fit and from their neighbours.
bool HistoryStudy::drop_spikes(const Fit& at) {
  std::vector<Eigen::MatrixXd> e;
  if (!problem->residuals(at.model, at.p.data(), e)) return false;
  bool any = false;
  int offset = 0;
  for (std::size_t r = 0; r < e.size(); ++r) {
    for (int c = 0; c < problem->width(); ++c) {
      std::vector<double> size;
      for (std::ptrdiff_t i = 0; i < e[r].rows(); ++i)
        if (std::isfinite(e[r](i, c))) size.push_back(std::abs(e[r](i, c)));
      const double scale = std::max(1.4826 * median(size), problem->channels()[std::size_t(c)].noise);
      for (std::ptrdiff_t i = 0; i < e[r].rows(); ++i) {
        if (!(std::abs(e[r](i, c)) > 7 * scale)) continue;
        const auto beside = [&](std::ptrdiff_t k) {
          return k < 0 || k >= e[r].rows() || !std::isfinite(e[r](k, c)) ? 0.0 : e[r](k, c);
        };
        // A motion moves its neighbours too; two readings in a row may fail together.
        if (std::abs(e[r](i, c) - 0.5 * (beside(i - 2) + beside(i + 2))) < 6 * scale) continue;
        result.flagged.push_back({offset + int(i), fmt::format("{}", offset + i + 1),
                                  problem->channels()[std::size_t(c)].name,
                                  fmt::format("stands alone: {:.3g} off at {:.6g} s in {}", -e[r](i, c),
                                              problem->records()[r].times[std::size_t(i)], problem->records()[r].name),
                                  int(result.flagged.size()) + 1});
        problem->drop(int(r), int(i), c);
        any = true;
      }
    }
    offset += int(e[r].rows());
  }
  return any;
}

void HistoryStudy::work() {
  if (problem->training() < 24) {
    too_few = true;
    return;
  }
  const Rules& rules = history_case.rules;
  for (int pass = 0; pass < 3; ++pass) {
    found = search(*problem, base, candidates, period(), rules);
    if (!std::isfinite(found.base.deviance)) throw DataError("the model has no answer for these records");
    if (pass == 0 && drop_spikes(found.richest())) { found = search(*problem, base, candidates, period(), rules); }
    select();
    if (result.selection.clean) contradict(result.selection.chosen);
    // The richest model sees the least of an effect in the noise.
    if (estimate_noise(found.richest()) < 0.03) break;
  }
  select();
}

void HistoryStudy::contradict(const Fit& at) {
  std::vector<Eigen::MatrixXd> e;
  if (!problem->residuals(at.model, at.p.data(), e)) return;
  for (int c = 0; c < problem->width(); ++c) {
    const HistoryChannel& ch = problem->channels()[std::size_t(c)];
    if (!ch.declared || std::ranges::count(contradicted, ch.name)) continue;
    const Colour noise = colour(*problem, e, c, ch.colour == 0);
    double n = 0;
    for (const Eigen::MatrixXd& r : e) n += double(r.rows());
    const double ratio = noise.sigma / declared_noise[std::size_t(c)], error = 2 / std::sqrt(n);
    if (std::abs(std::log(ratio)) > 4.2 * error && (ratio > 1.25 || ratio < 0.8)) contradicted.push_back(ch.name);
  }
}

void HistoryStudy::select() {
  Selection& s = result.selection;
  const Rules& rules = history_case.rules;
  s = Selection{};
  // The noise may have changed since the fits: their deviances are taken anew.
  const auto renew = [&](Fit& f) {
    Eigen::VectorXd z;
    if (problem->whitened(f.model, f.p.data(), kWhole, z)) f.deviance = z.squaredNorm();
  };
  renew(found.base);
  for (auto* list : {&found.singles, &found.pairs, &found.triples}) {
    for (Candidate& c : *list) {
      const double old = c.fit.deviance;
      renew(c.fit);
      c.criterion += c.fit.deviance - old;
    }
    std::ranges::stable_sort(*list, {}, &Candidate::criterion);
  }
  s.base = s.chosen = found.base;
  s.silent = found.silent;
  before = test(found.base);
  const double gain = found.singles.empty() ? 0 : found.base.deviance - found.singles.front().fit.deviance;
  s.structured = !is_clean(before) || gain > rules.gain;
  const std::vector<Candidate>* level = nullptr;
  if (gain > rules.gain) {
    level = &found.singles;
    s.level = 1;
    s.clean = is_clean(test(level->front().fit));
    const auto step = [&](const std::vector<Candidate>& more) {
      if (!more.empty() && level->front().criterion - more.front().criterion > rules.further_gain) {
        level = &more;
        ++s.level;
        s.clean = is_clean(test(more.front().fit));
      }
    };
    step(found.pairs);
    if (s.level == 2 && !s.clean) {
      if (found.triples.empty()) search_triples(*problem, candidates, rules, found);
      step(found.triples);
    }
    s.chosen = level->front().fit;
  } else {
    s.clean = is_clean(before);
  }
  after = test(s.chosen);
  if (level && s.clean) {
    std::vector<const Candidate*> tied;
    for (const Candidate& c : *level)
      if (c.criterion <= level->front().criterion + rules.tie) tied.push_back(&c);
    settle(tied, s);
  }
  for (const auto* list : {&found.singles, &found.pairs, &found.triples})
    s.candidates.insert(s.candidates.end(), list->begin(), list->end());
  // Ranked as they are adopted: every further effect must pay for itself.
  std::ranges::stable_sort(s.candidates, {}, [&](const Candidate& c) {
    return c.criterion + rules.further_gain * double(c.effects.size());
  });
}

}  // namespace hosel::loop
