#include "loop/history/histories.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "loop/history/noise.hpp"
#include "loop/history/search.hpp"

namespace hosel::loop {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRemaining = 1e-4;  ///< level of the test for what is left, adjusted for the number of tests

double median(std::vector<double> x) {
  if (x.empty()) return 0;
  const auto mid = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), mid, x.end());
  return *mid;
}

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
    const std::size_t held = std::clamp<std::size_t>(std::size_t(std::lround(fraction * double(records.size()))), 1, records.size() - 1);
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

class Histories {
 public:
  LoopResult result;

  explicit Histories(const HistoryCase& c) : case_(c) {
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
      declared_.push_back(ch.noise);
      const double floor = std::max(ch.resolution / std::sqrt(12.0), 1e-9);
      if (!ch.declared) ch.noise = std::max(rough_noise(records, int(k)), floor);
      if (!(ch.noise > 0)) ch.noise = floor;
    }
    split(c, records);
    HistorySetting setting = c.setting;
    setting.channels = channels;
    for (const HistoryEffect& e : history_effects())
      for (HistoryForm& f : e.forms(setting)) history_forms_.push_back(std::move(f));
    for (const HistoryForm& f : history_forms_) result.forms.push_back(f.form);
    for (std::size_t k = 0; k < history_forms_.size(); ++k) forms_[&result.forms[k]] = &history_forms_[k];
    for (const std::string& name : c.effects) {
      const Form* form = nullptr;
      for (const Form& f : result.forms)
        if (f.effect == name && !form) form = &f;
      if (!form) throw DataError(fmt::format("effect '{}' cannot act on this test", name));
      base_.push_back(form);
    }
    for (const Form& f : result.forms)
      if (!std::ranges::count(c.effects, f.effect)) candidates_.push_back(&f);
    problem_ = std::make_unique<HistoryProblem>(*c.model, std::move(records), std::move(channels), forms_);
    work();
    conclude();
  }

 private:
  const HistoryCase& case_;
  std::vector<double> declared_;
  std::vector<HistoryForm> history_forms_;
  std::map<const Form*, const HistoryForm*> forms_;
  std::vector<const Form*> base_, candidates_;
  std::unique_ptr<HistoryProblem> problem_;
  HistorySearch search_;
  std::vector<HistoryFinding> before_, after_;
  std::vector<std::string> contradicted_;
  bool too_few_ = false;

  double period() const { return case_.setting.frequency > 0 ? 2 * kPi / case_.setting.frequency : 1e300; }

  std::vector<HistoryFinding> test(const Fit& f) const {
    Eigen::VectorXd z;
    if (!problem_->whitened(f.model, f.p.data(), kWhole, z)) return {};
    return history_structure(*problem_, z);
  }
  static bool is_clean(const std::vector<HistoryFinding>& f) { return f.empty() || f.front().p_adjusted > kRemaining; }

  /// Level and colour of the noise from the residuals of a fit. Returns the largest relative change.
  double estimate_noise(const Fit& at) {
    std::vector<Eigen::MatrixXd> e;
    if (!problem_->residuals(at.model, at.p.data(), e)) return 0;
    double change = 0;
    for (int c = 0; c < problem_->width(); ++c) {
      const HistoryChannel ch = problem_->channels()[std::size_t(c)];
      Colour found = colour(*problem_, e, c, false);
      if (found.rho < 0.06) found = colour(*problem_, e, c, true);
      const bool trusted = ch.declared && !std::ranges::count(contradicted_, ch.name);
      double sigma = trusted ? declared_[std::size_t(c)] : found.sigma;
      sigma = std::max({sigma, ch.resolution / std::sqrt(12.0), 1e-9});
      change = std::max({change, std::abs(std::log(sigma / ch.noise)), std::abs(found.rho - ch.colour)});
      problem_->set_noise(c, sigma, found.rho);
    }
    return change;
  }

  /// Readings that stand alone far from a fit and from their neighbours.
  bool drop_spikes(const Fit& at) {
    std::vector<Eigen::MatrixXd> e;
    if (!problem_->residuals(at.model, at.p.data(), e)) return false;
    bool any = false;
    int offset = 0;
    for (std::size_t r = 0; r < e.size(); ++r) {
      for (int c = 0; c < problem_->width(); ++c) {
        std::vector<double> size;
        for (std::ptrdiff_t i = 0; i < e[r].rows(); ++i)
          if (std::isfinite(e[r](i, c))) size.push_back(std::abs(e[r](i, c)));
        const double scale = std::max(1.4826 * median(size), problem_->channels()[std::size_t(c)].noise);
        for (std::ptrdiff_t i = 0; i < e[r].rows(); ++i) {
          if (!(std::abs(e[r](i, c)) > 7 * scale)) continue;
          const auto beside = [&](std::ptrdiff_t k) { return k < 0 || k >= e[r].rows() || !std::isfinite(e[r](k, c)) ? 0.0 : e[r](k, c); };
          // A motion moves its neighbours too; two readings in a row may fail together.
          if (std::abs(e[r](i, c) - 0.5 * (beside(i - 2) + beside(i + 2))) < 6 * scale) continue;
          result.flagged.push_back({offset + int(i), fmt::format("{}", offset + i + 1), problem_->channels()[std::size_t(c)].name,
                                    fmt::format("stands alone: {:.3g} off at {:.6g} s in {}", -e[r](i, c), problem_->records()[r].times[std::size_t(i)], problem_->records()[r].name),
                                    int(result.flagged.size()) + 1});
          problem_->drop(int(r), int(i), c);
          any = true;
        }
      }
      offset += int(e[r].rows());
    }
    return any;
  }

  void work() {
    if (problem_->training() < 24) {
      too_few_ = true;
      return;
    }
    const Rules& rules = case_.rules;
    for (int pass = 0; pass < 3; ++pass) {
      search_ = search(*problem_, base_, candidates_, period(), rules);
      if (!std::isfinite(search_.base.deviance)) throw DataError("the model has no answer for these records");
      if (pass == 0 && drop_spikes(search_.richest())) {
        search_ = search(*problem_, base_, candidates_, period(), rules);
      }
      select();
      if (result.selection.clean) contradict(result.selection.chosen);
      // The richest model sees the least of an effect in the noise.
      if (estimate_noise(search_.richest()) < 0.03) break;
    }
    select();
  }

  void contradict(const Fit& at) {
    std::vector<Eigen::MatrixXd> e;
    if (!problem_->residuals(at.model, at.p.data(), e)) return;
    for (int c = 0; c < problem_->width(); ++c) {
      const HistoryChannel& ch = problem_->channels()[std::size_t(c)];
      if (!ch.declared || std::ranges::count(contradicted_, ch.name)) continue;
      const Colour found = colour(*problem_, e, c, ch.colour == 0);
      double n = 0;
      for (const Eigen::MatrixXd& r : e) n += double(r.rows());
      const double ratio = found.sigma / declared_[std::size_t(c)], error = 2 / std::sqrt(n);
      if (std::abs(std::log(ratio)) > 4.2 * error && (ratio > 1.25 || ratio < 0.8)) contradicted_.push_back(ch.name);
    }
  }

  void select() {
    Selection& s = result.selection;
    const Rules& rules = case_.rules;
    s = Selection{};
    // The noise may have changed since the fits: their deviances are taken anew.
    const auto renew = [&](Fit& f) {
      Eigen::VectorXd z;
      if (problem_->whitened(f.model, f.p.data(), kWhole, z)) f.deviance = z.squaredNorm();
    };
    renew(search_.base);
    for (auto* list : {&search_.singles, &search_.pairs, &search_.triples}) {
      for (Candidate& c : *list) {
        const double old = c.fit.deviance;
        renew(c.fit);
        c.criterion += c.fit.deviance - old;
      }
      std::ranges::stable_sort(*list, {}, &Candidate::criterion);
    }
    s.base = s.chosen = search_.base;
    s.silent = search_.silent;
    before_ = test(search_.base);
    const double gain = search_.singles.empty() ? 0 : search_.base.deviance - search_.singles.front().fit.deviance;
    s.structured = !is_clean(before_) || gain > rules.gain;
    const std::vector<Candidate>* level = nullptr;
    if (gain > rules.gain) {
      level = &search_.singles;
      s.level = 1;
      s.clean = is_clean(test(level->front().fit));
      const auto step = [&](const std::vector<Candidate>& more) {
        if (!more.empty() && level->front().criterion - more.front().criterion > rules.further_gain) {
          level = &more;
          ++s.level;
          s.clean = is_clean(test(more.front().fit));
        }
      };
      step(search_.pairs);
      if (s.level == 2 && !s.clean) {
        if (search_.triples.empty()) search_triples(*problem_, candidates_, rules, search_);
        step(search_.triples);
      }
      s.chosen = level->front().fit;
    } else {
      s.clean = is_clean(before_);
    }
    after_ = test(s.chosen);
    if (level && s.clean) {
      std::vector<const Candidate*> tied;
      for (const Candidate& c : *level)
        if (c.criterion <= level->front().criterion + rules.tie) tied.push_back(&c);
      settle(tied, s);
    }
    for (const auto* list : {&search_.singles, &search_.pairs, &search_.triples}) s.candidates.insert(s.candidates.end(), list->begin(), list->end());
    // Ranked as they are adopted: every further effect must pay for itself.
    std::ranges::stable_sort(s.candidates, {}, [&](const Candidate& c) { return c.criterion + rules.further_gain * double(c.effects.size()); });
  }

  /// The findings in the form that the report knows.
  void report_structure() {
    Selection& s = result.selection;
    const auto fill = [&](const std::vector<HistoryFinding>& from, StructureMap& map) {
      for (const HistoryFinding& f : from) {
        s.regressors.push_back({.column = "time_s", .kind = f.kind, .detail = f.detail, .value = {}});
        map.findings.push_back({.channel = f.channel, .regressor = int(s.regressors.size()) - 1, .statistic = f.signal, .signal = f.signal, .p_adjusted = f.p_adjusted});
      }
      map.p = from.empty() ? 1 : from.front().p_adjusted;
    };
    fill(before_, s.before);
    fill(after_, s.after);
  }

  Eigen::MatrixXd covariance(const Fit& f) const {
    const Eigen::MatrixXd J = problem_->jacobian(f.model, f.p);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinV);
    const auto n = J.cols();
    const auto parameters = f.model.parameters();
    Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(n, n);
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const double sv = svd.singularValues()[k];
      cov += (sv > 1e-3 ? 1 / (sv * sv) : 1e12) * svd.matrixV().col(k) * svd.matrixV().col(k).transpose();
    }
    for (std::ptrdiff_t a = 0; a < n; ++a)
      for (std::ptrdiff_t b = 0; b < n; ++b) cov(a, b) *= parameters[std::size_t(a)]->scale * parameters[std::size_t(b)]->scale;
    return cov;
  }

  static Errors errors(const HistoryProblem& problem, const std::vector<Eigen::MatrixXd>& e, int channel) {
    Errors out;
    double train = 0, held = 0, bias = 0;
    for (std::size_t r = 0; r < e.size(); ++r)
      for (std::ptrdiff_t i = 0; i < e[r].rows(); ++i) {
        const double x = e[r](i, channel);
        if (!std::isfinite(x)) continue;
        if (problem.records()[r].train[std::size_t(i)]) {
          train += x * x;
          ++out.train;
        } else {
          held += x * x;
          bias += x;
          ++out.holdout;
        }
      }
    out.train_rmse = out.train ? std::sqrt(train / out.train) : kNaN;
    out.holdout_rmse = out.holdout ? std::sqrt(held / out.holdout) : kNaN;
    out.holdout_bias = out.holdout ? bias / out.holdout : kNaN;
    return out;
  }

  void conclude() {
    for (const HistoryRecord& r : problem_->records())
      for (std::size_t i = 0; i < r.times.size(); ++i) ++(r.train[i] ? result.train : result.holdout);
    result.used = result.train + result.holdout;
    if (too_few_) {
      result.verdict = Verdict::insufficient;
      result.notes.push_back("fewer than 24 readings to learn from: too few to test anything");
      result.next.text = "a longer record";
      return;
    }
    const Selection& s = result.selection;
    result.adopted = s.adopted;
    result.ties = s.ties;
    if (!s.clean) {
      result.verdict = Verdict::unexplained;
      result.adopted.clear();
      result.ties.clear();
      locate();
    } else if (!contradicted_.empty()) {
      result.verdict = Verdict::noise_contradicted;
    } else if (!s.ties.empty()) {
      result.verdict = Verdict::ambiguous;
    } else {
      result.verdict = s.adopted.empty() ? Verdict::no_residual : Verdict::explained;
    }
    report_structure();

    // The holdout is read here, once, after the verdict.
    const Fit& base = s.base;
    const Fit& after = result.verdict != Verdict::unexplained ? s.chosen : base;
    const auto mean_score = [&](const Fit& f) {
      const auto [sum, n] = problem_->holdout_score(f.model, f.p.data());
      return n ? sum / n : kNaN;
    };
    result.base_score = mean_score(base);
    if (s.level > 0 && result.verdict != Verdict::unexplained && mean_score(after) < result.base_score) {
      result.verdict = Verdict::insufficient;
      result.notes.push_back(fmt::format("{} explained the training part and not what was held out: not adopted", fmt::join(result.adopted, ", ")));
      result.adopted.clear();
      result.ties.clear();
    }
    std::vector<Eigen::MatrixXd> eb, ea;
    problem_->residuals(base.model, base.p.data(), eb);
    problem_->residuals(after.model, after.p.data(), ea);
    for (int c = 0; c < problem_->width(); ++c) {
      const HistoryChannel& ch = problem_->channels()[std::size_t(c)];
      const bool trusted = ch.declared && !std::ranges::count(contradicted_, ch.name);
      ChannelResult out{.name = ch.name, .noise = ch.noise, .noise_source = trusted ? "declared" : "estimated"};
      out.before = errors(*problem_, eb, c);
      out.after = errors(*problem_, ea, c);
      out.scatter = out.after.train_rmse / ch.noise;
      result.channels.push_back(out);
      if (ch.colour > 0) result.notes.push_back(fmt::format("{}: neighbouring readings are correlated by {:.2f}; every test counts with that", ch.name, ch.colour));
      if (std::ranges::count(contradicted_, ch.name))
        result.notes.push_back(fmt::format("{}: declared noise {:.4g}, the data's own scatter shows {:.4g}", ch.name, declared_[std::size_t(c)], ch.noise));
    }
    for (std::size_t k = 0; k < std::min<std::size_t>(s.candidates.size(), problem_->slow() ? 12 : 25); ++k) {
      ScoredCandidate sc{.candidate = s.candidates[k]};
      const Eigen::MatrixXd cov = covariance(sc.candidate.fit);
      for (Eigen::Index j = 0; j < cov.rows(); ++j) sc.sd.push_back(std::sqrt(cov(j, j)));
      sc.holdout_score = mean_score(sc.candidate.fit);
      result.candidates.push_back(std::move(sc));
    }
    for (const std::string& e : s.silent) result.notes.push_back(fmt::format("{}: these channels would not show it", e));
    detectable(base);
    result.likeness = alike(after);
    next_experiment();
    int row = 0;
    for (std::size_t r = 0; r < problem_->records().size(); ++r) {
      const HistoryRecord& record = problem_->records()[r];
      for (std::size_t i = 0; i < record.times.size(); ++i, ++row) {
        UsedShot u{.row = row, .id = fmt::format("{}", row + 1), .holdout = !record.train[i]};
        for (int c = 0; c < problem_->width(); ++c) {
          u.measured.push_back(record.measured(std::ptrdiff_t(i), c));
          u.before.push_back(eb[r](std::ptrdiff_t(i), c));
          u.after.push_back(ea[r](std::ptrdiff_t(i), c));
        }
        result.shots.push_back(std::move(u));
      }
    }
  }

  void locate() {
    const auto add = [&](const std::vector<HistoryFinding>& from) {
      // An oscillation says more than the band it lies in.
      std::vector<HistoryFinding> told = from;
      std::ranges::stable_partition(told, [](const HistoryFinding& f) { return f.kind == "oscillation"; });
      for (const HistoryFinding& f : told) {
        if (f.p_adjusted > kRemaining) continue;
        const std::string& channel = result.channel_names[std::size_t(f.channel)];
        if (std::ranges::any_of(result.unexplained, [&](const Location& l) { return l.channel == channel; })) continue;
        result.unexplained.push_back({channel, "time_s", f.kind + (f.detail.empty() ? "" : " " + f.detail)});
      }
    };
    add(after_);
  }

  /// The size at which the deviance would fall by what a first effect needs.
  void detectable(const Fit& base) {
    std::set<std::string> seen;
    for (const Form* f : candidates_) {
      if (f->parameters.size() != 1 || !seen.insert(f->effect).second) continue;
      Fit probe = base;
      probe.model.forms.push_back(f);
      probe.p.conservativeResize(probe.model.size());
      probe.p.tail(1).setZero();
      Eigen::MatrixXd J = problem_->jacobian(probe.model, probe.p);
      Eigen::VectorXd column = J.rightCols(1);
      if (J.cols() > 1) {
        const Eigen::MatrixXd Q = orthonormal(J.leftCols(J.cols() - 1));
        column -= Q * (Q.transpose() * column);
      }
      const Parameter& q = f->parameters.front();
      const double value = std::sqrt(case_.rules.gain) / column.norm() * q.scale;
      result.minimum_detectable.push_back({f->effect, q.name, q.unit, value < std::max(q.max, -q.min) ? value / q.si : std::numeric_limits<double>::infinity()});
    }
  }

  /// One column per effect beside a fit.
  Likeness alike(const Fit& at) const {
    std::vector<EffectColumn> columns;
    std::set<std::string> seen;
    for (const Form* f : at.model.forms) seen.insert(f->effect);
    for (const Form* f : candidates_) {
      if (f->parameters.size() != 1 || !seen.insert(f->effect).second) continue;
      Model more = at.model;
      more.forms.push_back(f);
      Eigen::VectorXd p(more.size());
      p << at.p, 0.0;
      columns.push_back({f->effect, f->parameters.front().name, problem_->jacobian(more, p).rightCols(1)});
    }
    return likeness(columns, problem_->jacobian(at.model, at.p));
  }

  void next_experiment() {
    NextExperiment& next = result.next;
    if (result.verdict == Verdict::unexplained && !result.unexplained.empty()) {
      next.text = fmt::format("repeat the record with one thing changed at a time (free length, tip mass, amplitude): {} holds {} that no candidate explains",
                              result.unexplained.front().channel, result.unexplained.front().detail);
    } else if (result.verdict == Verdict::ambiguous) {
      std::vector<std::string> sensors;
      std::string names;
      for (const auto& tie : result.ties)
        for (const std::string& e : tie) {
          names += (names.empty() ? "" : ", ") + e;
          if (const HistoryEffect* h = find_history_effect(e)) sensors.emplace_back(h->sensor);
        }
      next.sensor = fmt::format("{}", fmt::join(sensors, "; or "));
      next.text = fmt::format("this record cannot separate {}: measure {}; or record the same club with a known mass at the tip and with a shorter free length", names, *next.sensor);
    } else if (result.verdict == Verdict::insufficient) {
      next.text = "a longer or stronger record: minimum_detectable says how large an effect this one could have shown";
    } else if (result.verdict == Verdict::noise_contradicted) {
      next.text = "a record at rest, to find the instrument's own scatter";
    } else {
      next.text = "nothing is tied; a longer record would narrow the parameters most";
    }
  }
};

}  // namespace

LoopResult run(const HistoryCase& c) {
  if (c.records.empty()) throw DataError("no record to look at");
  return std::move(Histories(c).result);
}

Shots as_shots(const HistoryCase& c) {
  Shots s;
  Column time{.name = "time_s", .stem = "time", .numeric = true}, record{.name = "record", .stem = "record", .role = Role::bookkeeping};
  std::vector<Column> channels;
  for (const HistoryChannel& ch : c.setting.channels) channels.push_back({.name = ch.name, .stem = ch.name, .role = Role::output, .numeric = true});
  for (const HistoryRecord& r : c.records)
    for (std::size_t i = 0; i < r.times.size(); ++i) {
      s.id.push_back(fmt::format("{}", s.id.size() + 1));
      s.line.push_back(i + 2);
      time.value.push_back(r.times[i]);
      record.text.push_back(r.name);
      for (std::size_t k = 0; k < channels.size(); ++k) channels[k].value.push_back(r.measured(std::ptrdiff_t(i), std::ptrdiff_t(k)));
    }
  s.columns.push_back(std::move(time));
  s.columns.push_back(std::move(record));
  for (Column& ch : channels) s.columns.push_back(std::move(ch));
  return s;
}

std::string history_residuals_csv(const HistoryCase& c, const LoopResult& r) {
  std::string out = "record,time_s,set";
  for (const ChannelResult& ch : r.channels) out += fmt::format(",{0}__measured,{0}__before,{0}__after", ch.name);
  out += '\n';
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format(",{:.9g}", x) : std::string(","); };
  std::size_t row = 0;
  for (const HistoryRecord& record : c.records)
    for (std::size_t i = 0; i < record.times.size() && row < r.shots.size(); ++i, ++row) {
      const UsedShot& u = r.shots[row];
      out += fmt::format("{},{:.9g},{}", record.name, record.times[i], u.holdout ? "holdout" : "train");
      for (std::size_t k = 0; k < u.measured.size(); ++k) out += cell(u.measured[k]) + cell(u.measured[k] + u.before[k]) + cell(u.measured[k] + u.after[k]);
      out += '\n';
    }
  return out;
}

}  // namespace hosel::loop
