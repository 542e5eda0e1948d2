#include "loop/run.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <set>

#include "loop/alike.hpp"
#include "loop/experiment.hpp"
#include "loop/inputs.hpp"
#include "models/rigid_eccentric.hpp"

namespace hosel::loop {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double median(std::vector<double> x) {
  if (x.empty()) return 0;
  const auto mid = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), mid, x.end());
  return *mid;
}

/// Scatter of a channel about a robust linear regression on the inputs (and their squares where rows allow):
/// a first idea of undeclared noise that no effect of smooth form can inflate.
double smooth_scatter(const Problem& problem, const std::vector<int>& rows, int channel, const Eigen::MatrixXd& residuals) {
  std::vector<int> seen;
  for (const int i : rows)
    if (std::isfinite(residuals(i, channel))) seen.push_back(i);
  const auto n = std::ptrdiff_t(seen.size());
  if (n < 4) return 0;
  std::vector<Eigen::VectorXd> basis = {Eigen::VectorXd::Ones(n)};
  const auto add = [&](Eigen::VectorXd x) {
    if (std::ptrdiff_t(basis.size()) * 3 >= n) return;
    x.array() -= x.mean();
    if (x.norm() < 1e-9) return;
    basis.push_back(x / x.norm());
  };
  for (const int power : {1, 2})
    for (int k = 0; k < kInputs; ++k) {
      Eigen::VectorXd x(n);
      for (std::ptrdiff_t i = 0; i < n; ++i) x[i] = get(problem.trial(seen[std::size_t(i)]).blow, Input(k));
      if (power == 2) x = Eigen::VectorXd((x.array() - x.mean()).square());
      add(x);
    }
  Eigen::MatrixXd A(n, std::ptrdiff_t(basis.size()));
  for (std::size_t k = 0; k < basis.size(); ++k) A.col(std::ptrdiff_t(k)) = basis[k];
  Eigen::VectorXd y(n), w = Eigen::VectorXd::Ones(n);
  for (std::ptrdiff_t i = 0; i < n; ++i) y[i] = residuals(seen[std::size_t(i)], channel);
  double scale = 0;
  for (int pass = 0; pass < 12; ++pass) {
    const Eigen::MatrixXd WA = w.cwiseSqrt().asDiagonal() * A;
    const Eigen::VectorXd b = WA.colPivHouseholderQr().solve(Eigen::VectorXd(w.cwiseSqrt().cwiseProduct(y)));
    const Eigen::VectorXd r = y - A * b;
    std::vector<double> size;
    for (std::ptrdiff_t i = 0; i < n; ++i) size.push_back(std::abs(r[i]));
    scale = 1.4826 * median(size) * std::sqrt(double(n) / double(n - A.cols()));
    if (!(scale > 0)) break;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const double u = r[i] / (4.685 * scale);
      w[i] = std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) + 1e-6 : 1e-6;
    }
  }
  return scale;
}

struct Scatter {
  double ratio = 1;  ///< root mean square over sigma
  double error = 1;  ///< of log ratio
};

/// Scatter of a channel about a fit in units of its own sigma, without the rows beyond 5 sigma.
Scatter scatter(const Problem& problem, const std::vector<int>& rows, int channel, const Eigen::MatrixXd& residuals, int fitted) {
  double sum = 0, fourth = 0, n = 0;
  for (const int i : rows) {
    if (!std::isfinite(residuals(i, channel))) continue;
    const double u = residuals(i, channel) / problem.sigma(i, channel), s = std::min(u * u, 36.0);
    sum += s;
    fourth += s * s;
    ++n;
  }
  const double dof = std::max(1.0, n - double(fitted) / problem.width());
  Scatter out;
  if (n < 3 || !(sum > 0)) return out;
  const double mean = sum / n;
  out.ratio = std::sqrt(sum / dof);
  out.error = std::max(std::sqrt(std::max(0.0, fourth / n - mean * mean) / n) / mean / 2, 1 / std::sqrt(2 * dof));
  return out;
}

struct Rows {
  std::vector<int> train, holdout;
};

/// Whole clusters or single rows, by a seeded shuffle of their names in order of appearance.
Rows split_rows(const LoopCase& c, const Problem& problem, const std::vector<int>& row_of, const std::vector<int>& usable,
                std::vector<std::string>& notes) {
  // Thresholds show at the most oblique shots only, so these are never held out: beyond them nothing would be learnt.
  std::vector<double> oblique;
  for (const int i : usable) {
    Blow blow = problem.trial(i).blow;
    if (!c.head_turns) blow.delivery.impact_toe = blow.delivery.impact_high = 0;  // such a base knows the face's centre only
    const models::ContactGeometry g = models::contact_geometry(blow);
    const double approach = g.approach.dot(g.normal);
    oblique.push_back((g.approach - approach * g.normal).norm() / approach);
  }
  std::vector<int> group(usable.size());
  int count = 0;
  if (!c.split.by.empty()) {
    const Column* by = c.shots.find(c.split.by);
    if (!by) throw DataError(fmt::format("{}:1: no column '{}' to split by", c.shots.file, c.split.by));
    const Groups g = groups(*by);
    for (std::size_t i = 0; i < usable.size(); ++i) group[i] = g.of_row[std::size_t(row_of[std::size_t(usable[i])])];
    count = int(g.name.size());
    int missing = count;
    for (int& x : group)
      if (x < 0) x = missing++;
    count = missing;
  } else {
    // Single rows: of every three (at one third) neighbours in obliquity one is held out, so that both sets reach
    // over the whole range.
    std::vector<std::size_t> order(usable.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return oblique[i]; });
    std::mt19937_64 random(c.split.seed);
    const double fraction = c.split.holdout_fraction;
    std::vector<char> out(usable.size(), 0);
    const std::size_t outermost = order.size() < 60 ? 1 : 2;
    const std::size_t block = fraction > 0 ? std::max<std::size_t>(2, std::size_t(std::lround(1 / fraction))) : 0;
    for (std::size_t k = 0; block && k < order.size(); k += block) {
      const std::size_t size = std::min(block, order.size() - k);
      if (size < block && double(random() >> 11) * 0x1p-53 > double(size) * fraction) continue;
      // One of the block, or as many as the fraction asks for.
      const auto take = std::max<std::size_t>(1, std::size_t(std::lround(fraction * double(size))));
      for (std::size_t t = 0; t < take; ++t) {
        const std::size_t which = k + (random() % size);
        out[order[std::max<std::size_t>(which, std::min(outermost, k + size - 1))]] = 1;
      }
    }
    Rows rows;
    for (std::size_t i = 0; i < usable.size(); ++i) (out[i] ? rows.holdout : rows.train).push_back(usable[i]);
    return rows;
  }
  std::vector<int> members(std::size_t(count), 0);
  for (const int g : group) ++members[std::size_t(g)];
  std::vector<int> order;
  for (int g = 0; g < count; ++g)
    if (members[std::size_t(g)]) order.push_back(g);
  if (!usable.empty()) std::erase(order, group[std::size_t(std::ranges::max_element(oblique) - oblique.begin())]);
  std::mt19937_64 random(c.split.seed);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  std::set<int> held;
  const double wanted = c.split.holdout_fraction * double(usable.size());
  double have = 0;
  for (const int g : order) {
    const double more = members[std::size_t(g)];
    if (have + more > wanted + 0.5 * more) continue;
    held.insert(g);
    have += more;
    if (have >= wanted) break;
  }
  if (held.empty() && c.split.holdout_fraction > 0) notes.push_back("no holdout could be split off");
  Rows rows;
  for (std::size_t i = 0; i < usable.size(); ++i) (held.contains(group[i]) ? rows.holdout : rows.train).push_back(usable[i]);
  return rows;
}

Errors errors(const Problem& problem, const Rows& rows, int channel, const Eigen::MatrixXd& residuals) {
  Errors e;
  double train = 0, hold = 0, bias = 0;
  for (const int i : rows.train)
    if (const double r = residuals(i, channel); std::isfinite(r)) {
      train += r * r;
      ++e.train;
    }
  for (const int i : rows.holdout)
    if (const double r = residuals(i, channel); std::isfinite(r)) {
      hold += r * r;
      bias += r;
      ++e.holdout;
    }
  (void)problem;
  e.train_rmse = e.train ? std::sqrt(train / e.train) : kNaN;
  e.holdout_rmse = e.holdout ? std::sqrt(hold / e.holdout) : kNaN;
  e.holdout_bias = e.holdout ? bias / e.holdout : kNaN;
  return e;
}

/// At most so many rows, evenly spread: what names an effect does not need thousands, and their cost would be felt.
std::vector<int> thinned(const std::vector<int>& rows) {
  constexpr std::size_t most = 450;
  if (rows.size() <= most) return rows;
  std::vector<int> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(rows[k * rows.size() / most]);
  return some;
}

/// Mean log predictive density per value.
double score(const Problem& problem, const std::vector<int>& rows, const Model& model, const Eigen::VectorXd& p, const Loss& loss) {
  const Eigen::VectorXd z = whitened(problem, rows, model, p);
  const int m = problem.width();
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto W = problem.whitening(rows[i]);
    for (int c = 0; c < m; ++c)
      if (problem.observed(rows[i], c) && W(c, c) > 0) {
        sum += std::log(W(c, c)) - 0.5 * std::log(2 * kPi);
        ++count;
      }
    sum -= 0.5 * loss(z.segment(std::ptrdiff_t(i) * m, m).squaredNorm());
  }
  return count ? sum / count : kNaN;
}

std::vector<Detectable> detectable(const Problem& problem, const std::vector<int>& rows, const Fit& base, const std::vector<const Form*>& forms,
                                   const Rules& rules) {
  // Found nine times in ten: the threshold and 1.3 standard deviations more.
  const double wanted = std::sqrt(rules.gain) + 1.3;
  std::vector<Detectable> all;
  std::set<std::string> done;
  const Eigen::VectorXd z0 = whitened(problem, rows, base.model, base.p);
  const Eigen::MatrixXd Q = orthonormal(whitened_jacobian(problem, rows, base.model, base.p));
  for (const Form* f : forms) {
    if (done.contains(f->effect)) continue;
    Model m = base.model;
    m.forms.push_back(f);
    Eigen::VectorXd p = Eigen::VectorXd::Zero(m.size());
    p.head(base.p.size()) = base.p;
    const Parameter& par = f->parameters[0];
    const auto signal = [&](double x) {
      p[base.p.size()] = x;
      Eigen::VectorXd d = whitened(problem, rows, m, p) - z0;
      if (Q.cols()) d -= Q * (Q.transpose() * d);
      return d.norm();
    };
    const double most = std::max(par.max, -par.min);
    const double sign = par.max >= -par.min ? 1 : -1;
    if (signal(sign * most) < wanted) {
      if (signal(sign * most) > 1e-3) {
        done.insert(f->effect);
        all.push_back({f->effect, par.name, par.unit, kNaN});
      }
      continue;
    }
    double lo = 0, hi = most;
    for (int k = 0; k < 40; ++k) (signal(sign * (lo + hi) / 2) < wanted ? lo : hi) = (lo + hi) / 2;
    done.insert(f->effect);
    all.push_back({f->effect, par.name, par.unit, hi / par.si});
  }
  return all;
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

namespace {

/// One pass over the loop with the outputs given: everything but the audit's second look and leave-one-out.
class Loop {
 public:
  /// `held_rows`: the holdout, where it is not split here. `doubted`: an input whose record counts for nothing.
  Loop(const LoopCase& c, const std::vector<DerivedColumn>& derived, std::optional<std::set<int>> held_rows = {},
       std::optional<Input> doubted = {})
      : case_(c), held_rows_(std::move(held_rows)), doubted_(doubted) {
    result.title = c.title;
    result.base = c.base;
    result.seed = c.split.seed;
    result.read = int(c.shots.rows());
    result.derived = derived;
    result.selection.clean = true;
    prepare();
    if (!problem_) {
      report_flags();
      return;
    }
    work();
    conclude();
  }

  LoopResult result;

 private:
  const LoopCase& case_;
  std::optional<std::set<int>> held_rows_;
  std::optional<Input> doubted_;
  Inputs inputs_;
  std::unique_ptr<Problem> problem_;
  std::vector<const Form*> base_forms_, candidate_forms_;
  std::vector<ColumnUse> uses_;
  std::vector<int> usable_;  // shots whose base answer exists
  Rows rows_;
  std::vector<RowFlag> early_;  // flagged before they could become shots
  std::vector<RowFlag> flags_;
  std::string widespread_;      // see Screening
  Loss loss_;
  std::vector<Regressor> regressors_;
  std::vector<std::string> contradicted_;
  std::vector<double> declared_;

  void flag_early(int row, std::string column, std::string reason, int shot = -1) {
    early_.push_back({.shot = shot, .row = row, .column = std::move(column), .reason = std::move(reason), .slip = false});
  }

  void prepare() {
    const Shots& shots = case_.shots;
    std::map<std::string, double> input_noise;
    for (const auto& [header, value] : case_.input_noise)
      if (const Column* c = shots.find(header)) input_noise[header] = value * c->si;
    inputs_ = make_inputs(shots, case_.blow, case_.head_mass_declared, input_noise);
    result.unused = inputs_.unused;
    result.notes = case_.notes;
    result.notes.insert(result.notes.end(), inputs_.notes.begin(), inputs_.notes.end());
    if (doubted_) distrust(*doubted_);

    // Cells that are no numbers, and values no blow has: flagged before anything is fitted.
    std::set<int> bad;
    for (const Column& c : shots.columns)
      for (const std::size_t row : c.broken)
        if (bad.insert(int(row)).second) flag_early(int(row), c.name, "not a finite number");
    for (const auto& [row, what] : inputs_.impossible)
      if (bad.insert(row).second) flag_early(row, what.substr(0, what.find('|')), what.substr(what.find('|') + 1));

    std::vector<Channel> channels;
    std::vector<const Column*> columns;
    std::set<std::string> redundant;
    for (const DerivedColumn& d : result.derived)
      if (!d.input) redundant.insert(d.column);
    for (int o = 0; o < 7; ++o) {
      const Column* c = shots.find_stem(stem(Output(o)));
      if (!c || c->role != Role::output || redundant.contains(c->name)) continue;
      double seen = 0;
      for (const double x : c->value) seen += std::isfinite(x);
      if (seen < 1) continue;
      Channel ch{.name = c->name, .output = Output(o), .si = c->si, .resolution = c->resolution / c->si};
      if (const auto it = case_.noise.find(c->name); it != case_.noise.end()) {
        ch.noise = it->second;
        ch.declared = true;
      }
      channels.push_back(ch);
      columns.push_back(c);
    }
    if (channels.empty() && std::ranges::any_of(shots.columns, [](const Column& k) { return k.role == Role::output; })) {
      result.verdict = Verdict::insufficient;
      result.notes.push_back("no launch quantity has a value");
      return;
    }
    if (channels.empty()) throw DataError(fmt::format("{}:1: no measured launch quantity (ball_speed_*, launch_angle_*, ...)", shots.file));

    std::vector<Trial> trials;
    std::vector<int> row_of;
    std::vector<Eigen::MatrixXd> covariance;
    for (std::size_t i = 0; i < inputs_.trials.size(); ++i) {
      if (bad.contains(inputs_.row_of[i])) continue;
      trials.push_back(inputs_.trials[i]);
      row_of.push_back(inputs_.row_of[i]);
      if (!inputs_.covariance.empty()) covariance.push_back(inputs_.covariance[i]);
    }
    inputs_.row_of = row_of;
    inputs_.covariance = covariance;
    if (trials.empty()) {
      result.verdict = Verdict::insufficient;
      result.notes.push_back("no row can be used");
      return;
    }
    Eigen::MatrixXd measured(std::ptrdiff_t(trials.size()), std::ptrdiff_t(channels.size()));
    for (std::size_t i = 0; i < trials.size(); ++i)
      for (std::size_t k = 0; k < channels.size(); ++k)
        measured(std::ptrdiff_t(i), std::ptrdiff_t(k)) = columns[k]->native(std::size_t(row_of[i]));
    // The record's last digit rounds: that much is added to the noise.
    for (Channel& ch : channels) ch.noise = std::hypot(ch.noise, ch.declared ? ch.resolution / std::sqrt(12.0) : 0.0);
    problem_ = std::make_unique<Problem>(*case_.model, case_.direct, std::move(trials), channels, std::move(measured));
    for (const Channel& ch : channels) result.channel_names.push_back(ch.name);
    for (const Channel& ch : channels) declared_.push_back(ch.declared ? ch.noise : 0);

    Setting setting;
    setting.head_turns = case_.head_turns;
    setting.inertia_declared = case_.inertia_declared;
    for (const Channel& ch : channels) setting.outputs.push_back(ch.output);
    for (const EffectEntry& e : effects())
      for (Form& f : e.forms(setting)) {
        // Rows without a shot number may stand in any order: that it is the session's is an assumption more.
        if (f.effect == "session-drift" && !shots.has_shot_column) f.rarity += 10;
        result.forms.push_back(std::move(f));
      }
    for (const std::string& e : case_.effects) {
      bool found = false;
      for (const Form& f : result.forms)
        if (f.effect == e && !found) {
          base_forms_.push_back(&f);
          found = true;
        }
    }
    for (const Form& f : result.forms)
      if (!std::ranges::count(case_.effects, f.effect)) candidate_forms_.push_back(&f);

    for (int k = 0; k < kInputs; ++k)
      if (const Column* c = shots.find_stem(stem(Input(k)))) uses_.push_back({c, k, -1});
    for (std::size_t k = 0; k < columns.size(); ++k) uses_.push_back({columns[k], -1, int(k)});

    std::vector<double> out(channels.size());
    for (int i = 0; i < problem_->shots(); ++i) {
      if (problem_->predict(i, Model{}, nullptr, out.data())) usable_.push_back(i);
      else flag_early(row_of[std::size_t(i)], "", "the base model has no answer: the head moves away from the ball", i);
    }
    const boost::math::chi_squared law(problem_->width());
    loss_.knee = quantile(law, 0.999);
    loss_.cap = 12 * loss_.knee;
  }

  /// Every shot's value of this input may be anything: its direction is projected out of the shot's channels.
  void distrust(Input input) {
    if (inputs_.covariance.empty()) inputs_.covariance.assign(inputs_.trials.size(), Eigen::MatrixXd::Zero(kInputs, kInputs));
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (const Trial& t : inputs_.trials) {
      lo = std::min(lo, get(t.blow, input));
      hi = std::max(hi, get(t.blow, input));
    }
    for (Eigen::MatrixXd& cov : inputs_.covariance) cov(int(input), int(input)) += std::pow(10 * std::max(hi - lo, 1e-3), 2);
  }

  std::vector<int> all_rows(const Rows& r) const {
    std::vector<int> all = r.train;
    all.insert(all.end(), r.holdout.begin(), r.holdout.end());
    std::ranges::sort(all);
    return all;
  }

  void split(const std::set<int>& without) {
    std::vector<int> kept;
    for (const int i : usable_)
      if (!without.contains(i)) kept.push_back(i);
    if (held_rows_) {
      rows_ = {};
      for (const int i : kept) (held_rows_->contains(inputs_.row_of[std::size_t(i)]) ? rows_.holdout : rows_.train).push_back(i);
    } else {
      // The split is made over all usable rows, so that screening does not reshuffle it.
      std::vector<std::string> unheard;
      const Rows all = split_rows(case_, *problem_, inputs_.row_of, usable_, unheard);
      rows_ = {};
      for (const int i : all.train)
        if (!without.contains(i)) rows_.train.push_back(i);
      for (const int i : all.holdout)
        if (!without.contains(i)) rows_.holdout.push_back(i);
    }
  }

  /// Noise that is not declared (or contradicted), from the residuals of a fit.
  void estimate_noise(const Fit* at) {
    const Eigen::VectorXd none;
    const Eigen::MatrixXd r = at ? problem_->residuals(at->model, at->p.data()) : problem_->residuals(Model{}, nullptr);
    for (int c = 0; c < problem_->width(); ++c) {
      const Channel& ch = problem_->channels()[std::size_t(c)];
      const bool refuted = std::ranges::count(contradicted_, ch.name) > 0;
      if (ch.declared && !refuted) continue;
      const double smooth = smooth_scatter(*problem_, rows_.train, c, r);
      double sd = smooth;
      if (at) {
        const Scatter s = scatter(*problem_, rows_.train, c, r, at->size());
        const double whole = s.ratio * [&] {
          double sum = 0;
          for (const int i : rows_.train) sum += problem_->sigma(i, c) * problem_->sigma(i, c);
          return std::sqrt(sum / std::max<double>(1, double(rows_.train.size())));
        }();
        sd = refuted || smooth <= 0 ? whole : std::min(whole, 1.3 * smooth);
      }
      // What noisy inputs contribute is counted separately.
      double from_inputs = 0;
      if (at && !inputs_.covariance.empty()) {
        double sum = 0;
        for (const int i : rows_.train) sum += std::max(0.0, problem_->sigma(i, c) * problem_->sigma(i, c) - ch.noise * ch.noise);
        from_inputs = sum / std::max<double>(1, double(rows_.train.size()));
      }
      const double floor = std::max({ch.resolution / std::sqrt(12.0), 1e-3 * sd, 1e-9});
      problem_->set_noise(c, std::max(std::sqrt(std::max(sd * sd - from_inputs, 0.09 * sd * sd)), floor));
    }
  }

  void set_covariance(const Fit* at) {
    if (at) problem_->set_covariance(inputs_.covariance, at->model, at->p.data());
    else problem_->set_covariance(inputs_.covariance, Model{}, nullptr);
  }

  /// Per channel: the noise is declared and not contradicted.
  std::vector<char> declared() const {
    std::vector<char> all;
    for (const Channel& c : problem_->channels()) all.push_back(c.declared && !std::ranges::count(contradicted_, c.name));
    return all;
  }
  bool noise_declared() const { return std::ranges::all_of(declared(), std::identity{}); }

  void select(bool deep) {
    result.selection = loop::select(*problem_, thinned(rows_.train), base_forms_, candidate_forms_, regressors_, loss_, declared(), case_.rules, deep);
  }

  void work() {
    split({});
    std::set<int> out;
    estimate_noise(nullptr);
    set_covariance(nullptr);
    regressors_ = loop::regressors(case_.shots, inputs_.row_of, thinned(rows_.train), *problem_);
    if (rows_.train.size() < 4) return;
    for (int pass = 0; pass < 4; ++pass) {
      select(pass > 0);
      const Fit& at = result.selection.chosen;
      const Screening screening = screen(*problem_, case_.shots, inputs_.row_of, uses_, at, result.selection.clean, early_);
      flags_ = screening.flags;
      widespread_ = screening.widespread;
      std::set<int> now;
      for (const RowFlag& f : flags_)
        if (f.shot >= 0) now.insert(f.shot);
      std::vector<int> changed;
      std::ranges::set_symmetric_difference(now, out, std::back_inserter(changed));
      const bool settled_rows = changed.size() * 500 <= std::size_t(problem_->shots());
      out = now;
      split(out);
      if (rows_.train.size() < 4) return;
      std::vector<double> before;
      for (const Channel& ch : problem_->channels()) before.push_back(ch.noise);
      contradict(at);
      estimate_noise(&at);
      bool settled_noise = true;
      for (int c = 0; c < problem_->width(); ++c)
        settled_noise = settled_noise && std::abs(problem_->channels()[std::size_t(c)].noise / before[std::size_t(c)] - 1) < 0.03;
      const bool first_covariance = pass == 0 && !inputs_.covariance.empty() && !at.model.forms.empty();
      set_covariance(&at);
      regressors_ = loop::regressors(case_.shots, inputs_.row_of, thinned(rows_.train), *problem_);
      if (settled_rows && settled_noise && !first_covariance) {
        if (pass == 0 && !result.selection.clean && result.selection.level == 2) select(true);
        break;
      }
      if (pass == 3) select(true);
    }
  }

  /// Declared noise that the scatter about a clean fit contradicts.
  void contradict(const Fit& at) {
    if (!result.selection.clean) return;
    const Eigen::MatrixXd r = problem_->residuals(at.model, at.p.data());
    for (int c = 0; c < problem_->width(); ++c) {
      const Channel& ch = problem_->channels()[std::size_t(c)];
      if (!ch.declared || std::ranges::count(contradicted_, ch.name)) continue;
      const Scatter s = scatter(*problem_, rows_.train, c, r, at.size());
      if (std::abs(std::log(s.ratio)) > 4.2 * s.error && (s.ratio > 1.25 || s.ratio < 0.8)) contradicted_.push_back(ch.name);
    }
  }

  void conclude() {
    const Selection& s = result.selection;
    report_flags();
    result.train = int(rows_.train.size());
    result.holdout = int(rows_.holdout.size());
    result.used = result.train + result.holdout;
    result.adopted = s.adopted;
    result.ties = s.ties;

    if (rows_.train.size() < 4) {
      result.verdict = Verdict::insufficient;
      result.adopted.clear();
      result.ties.clear();
      result.notes.push_back(fmt::format("{} training rows: too few to test anything", rows_.train.size()));
    } else if (!s.clean || (s.structured && s.level == 0)) {
      result.verdict = s.clean ? Verdict::insufficient : Verdict::unexplained;
      result.adopted.clear();
      result.ties.clear();
      if (result.verdict == Verdict::unexplained) locate();
    } else if (shape_remains()) {
      result.verdict = Verdict::unexplained;
      result.adopted.clear();
      result.ties.clear();
    } else if (!contradicted_.empty()) {
      result.verdict = Verdict::noise_contradicted;
    } else if (s.nameless) {
      result.verdict = Verdict::insufficient;
      result.ties.clear();
    } else if (!s.ties.empty()) {
      result.verdict = Verdict::ambiguous;
    } else {
      result.verdict = s.adopted.empty() ? Verdict::no_residual : Verdict::explained;
    }

    if (rows_.train.size() > thinned(rows_.train).size()) {
      result.notes.push_back(fmt::format("effects selected on {} of {} training rows, then fitted to all", thinned(rows_.train).size(), rows_.train.size()));
      Fit& chosen = result.selection.chosen;
      if (chosen.size() > 0) chosen = fit(*problem_, rows_.train, chosen.model, {chosen.p}, loss_);
    }
    // The holdout is read here, once: what was chosen must not fail there.
    const Fit& base = s.base;
    const bool offered = result.verdict != Verdict::unexplained && result.verdict != Verdict::insufficient && s.level > 0;
    const bool refuted = offered && held_out(s.chosen) > held_out(base) + case_.rules.holdout_loss;
    if (refuted) {
      result.notes.push_back(fmt::format("{} explained the training shots and not those held out: not adopted", fmt::join(names_of(s.chosen), " and ")));
      if (result.verdict != Verdict::noise_contradicted) result.verdict = Verdict::insufficient;
      result.adopted.clear();
      result.ties.clear();
    }
    const bool shown = offered && !refuted;
    const Fit& after = shown ? s.chosen : base;
    if (rows_.train.size() >= 4) {
      const Eigen::MatrixXd rb = problem_->residuals(base.model, base.p.data()), ra = problem_->residuals(after.model, after.p.data());
      for (int c = 0; c < problem_->width(); ++c) {
        const Channel& ch = problem_->channels()[std::size_t(c)];
        ChannelResult out{.name = ch.name, .noise = ch.noise, .noise_source = ch.declared && !std::ranges::count(contradicted_, ch.name) ? "declared" : "estimated"};
        out.scatter = scatter(*problem_, rows_.train, c, ra, after.size()).ratio;
        out.before = errors(*problem_, rows_, c, rb);
        out.after = errors(*problem_, rows_, c, ra);
        result.channels.push_back(out);
        if (std::ranges::count(contradicted_, ch.name))
          result.notes.push_back(fmt::format("{}: declared noise {:.4g}, the data's own scatter shows {:.4g}", ch.name, declared_[std::size_t(c)], ch.noise));
      }
      result.base_score = score(*problem_, rows_.holdout, base.model, base.p, loss_);
      for (std::size_t k = 0; k < std::min<std::size_t>(s.candidates.size(), 25); ++k) {
        ScoredCandidate sc{.candidate = s.candidates[k]};
        const Eigen::MatrixXd cov = covariance(*problem_, thinned(rows_.train), sc.candidate.fit, loss_, !noise_declared());
        for (Eigen::Index j = 0; j < cov.rows(); ++j) sc.sd.push_back(std::sqrt(cov(j, j)));
        sc.holdout_score = score(*problem_, rows_.holdout, sc.candidate.fit.model, sc.candidate.fit.p, loss_);
        result.candidates.push_back(std::move(sc));
      }
      result.minimum_detectable = detectable(*problem_, thinned(rows_.train), base, candidate_forms_, case_.rules);
      result.likeness = alike(*problem_, thinned(rows_.train), after, candidate_forms_);
      result.balance_before = balance(*problem_, rows_.train, base.model, base.p.data());
      result.balance_after = balance(*problem_, rows_.train, after.model, after.p.data());
      result.next = design(case_, *problem_, thinned(rows_.train), s, result.unexplained, result.verdict);
      std::vector<int> all = all_rows(rows_);
      const std::set<int> held(rows_.holdout.begin(), rows_.holdout.end());
      for (const int i : all) {
        UsedShot u{.row = inputs_.row_of[std::size_t(i)], .id = case_.shots.id[std::size_t(inputs_.row_of[std::size_t(i)])], .holdout = held.contains(i)};
        for (int c = 0; c < problem_->width(); ++c) {
          u.measured.push_back(problem_->measured()(i, c));
          u.before.push_back(rb(i, c));
          u.after.push_back(ra(i, c));
        }
        result.shots.push_back(std::move(u));
      }
    } else {
      result.next.text = "more shots";
    }
  }

  /// Deviance of the held-out rows.
  double held_out(const Fit& f) const { return deviance(whitened(*problem_, rows_.holdout, f.model, f.p), problem_->width(), loss_); }

  std::vector<std::string> names_of(const Fit& f) const {
    std::vector<std::string> names;
    for (std::size_t k = base_forms_.size(); k < f.model.forms.size(); ++k) names.push_back(f.model.forms[k]->effect);
    return names;
  }

  /// Findings numbered 1, 2, ... in order of rows.
  void report_flags() {
    if (flags_.empty()) flags_ = early_;
    int own = 0;
    for (const RowFlag& f : flags_) own = std::max(own, f.finding);
    for (const RowFlag& f : flags_)
      result.flagged.push_back({f.row, case_.shots.id[std::size_t(f.row)], f.column, f.reason, f.finding ? f.finding : ++own});
    std::ranges::stable_sort(result.flagged, {}, &LoopResult::Flag::row);
    std::map<int, int> number;
    for (auto& f : result.flagged) {
      const auto [it, fresh] = number.emplace(f.finding, int(number.size()) + 1);
      f.finding = it->second;
    }
  }

  Location place(const Finding& f) const {
    Location l;
    l.channel = f.channel >= 0 ? result.channel_names[std::size_t(f.channel)] : "";
    if (f.regressor < 0) {
      l.regressor = "shot";
      l.detail = "neighbours alike";
    } else if (std::size_t(f.regressor) < result.selection.regressors.size()) {
      const Regressor& r = result.selection.regressors[std::size_t(f.regressor)];
      l.regressor = r.column;
      l.detail = r.kind + (r.detail.empty() ? "" : " " + r.detail);
    }
    return l;
  }

  /// What scatter alone does not do, where a channel's scatter contradicts its declared noise or many shots are far
  /// off: it follows a regressor at a level that would not count alone, it has two heads, or it strikes a share of
  /// the shots that is no exception.
  bool shape_remains() {
    const Selection& s = result.selection;
    const Eigen::MatrixXd r = problem_->residuals(s.chosen.model, s.chosen.p.data());
    for (int c = 0; c < problem_->width(); ++c) {
      const std::string& name = result.channel_names[std::size_t(c)];
      const bool refuted = std::ranges::count(contradicted_, name) > 0;
      if (!refuted && name != widespread_) continue;
      for (const Finding& f : s.after.findings)
        if (f.channel == c && f.p_adjusted < 0.05) {
          result.unexplained.push_back(place(f));
          return true;
        }
      double n = 0, mean = 0, second = 0, fourth = 0;
      for (const int i : rows_.train)
        if (std::isfinite(r(i, c))) mean += r(i, c), ++n;
      mean /= std::max(1.0, n);
      for (const int i : rows_.train)
        if (std::isfinite(r(i, c))) {
          const double d = r(i, c) - mean;
          second += d * d / n;
          fourth += d * d * d * d / n;
        }
      // Two heads: kurtosis below that of a normal sample by 2.5 of its own standard deviations.
      if (n > 20 && fourth / (second * second) < 3 - 2.5 * std::sqrt(24 / n)) {
        result.unexplained.push_back({name, "", "two heads in the distribution: a mixture"});
        return true;
      }
      if (name == widespread_) {
        Location l{name, "", "many shots far off, the others within the noise: a mixture or a threshold"};
        for (const StructureMap* map : {&s.after, &s.before})
          for (const Finding& f : map->findings)
            if (f.channel == c && l.regressor.empty()) l.regressor = place(f).regressor;
        result.unexplained.push_back(l);
        return true;
      }
    }
    return false;
  }

  /// Where the structure sits: what remains after the best model if a foreign column drives it, else the map of
  /// the base, before anything was fitted to it.
  void locate() {
    const Selection& s = result.selection;
    const auto foreign = [&](const Finding& f) {
      return f.regressor < 0 || (std::size_t(f.regressor) < s.regressors.size() && s.regressors[std::size_t(f.regressor)].foreign);
    };
    const auto first = [&](const StructureMap& map, auto&& good) -> const Finding* {
      for (const Finding& f : map.findings)
        if (f.channel >= 0 && good(f)) return &f;
      return nullptr;
    };
    const auto add = [&](const Finding* f) {
      if (!f) return;
      const Location l = place(*f);
      for (const Location& known : result.unexplained)
        if (known.channel == l.channel && known.regressor == l.regressor) return;
      result.unexplained.push_back(l);
    };
    const Finding* left = first(s.after, [](const Finding&) { return true; });
    const Finding* base = first(s.before, [](const Finding&) { return true; });
    if (left && foreign(*left)) {
      add(left);
    } else {
      add(base);
      add(left);
    }
    // What the map shows nearly as plainly may be the driver: few shots do not part correlated columns.
    for (const StructureMap* map : {&s.after, &s.before})
      for (const Finding& f : map->findings)
        if (f.channel >= 0 && result.unexplained.size() < 4 && std::abs(f.signal) > 0.85 * std::abs(map->findings.front().signal) && f.p_adjusted < 0.05) add(&f);
  }
};

}  // namespace

namespace {

/// Rows flagged for what stands in this column: no evidence for or against a formula.
Shots without_flagged(const Shots& shots, const LoopResult& r) {
  Shots clean = shots;
  for (Column& c : clean.columns)
    for (const auto& f : r.flagged)
      if (c.numeric && std::size_t(f.row) < c.value.size()) c.value[std::size_t(f.row)] = kNaN;
  return clean;
}

/// Every cluster is the holdout once; errors and residuals are pooled over the clusters.
void leave_one_out(const LoopCase& c, const std::vector<DerivedColumn>& derived, LoopResult& whole) {
  const Groups g = groups(*c.shots.find(c.split.by));
  std::vector<UsedShot> pooled;
  std::vector<double> score_sum(whole.candidates.size(), 0.0);
  for (std::size_t k = 0; k < g.name.size(); ++k) {
    std::set<int> held;
    for (std::size_t i = 0; i < g.of_row.size(); ++i)
      if (g.of_row[i] == int(k)) held.insert(int(i));
    const Loop fold(c, derived, held);
    for (const UsedShot& u : fold.result.shots)
      if (u.holdout) pooled.push_back(u);
    if (fold.result.holdout > 0)
      whole.notes.push_back(fmt::format("without {} '{}': adopted {}{}", c.split.by, g.name[k],
                                        fold.result.adopted.empty() ? "nothing" : fmt::format("{}", fmt::join(fold.result.adopted, ", ")),
                                        fold.result.ties.empty() ? "" : fmt::format(", tied {}", fmt::join(fold.result.ties.front(), " or "))));
  }
  std::ranges::stable_sort(pooled, {}, &UsedShot::row);
  for (std::size_t ch = 0; ch < whole.channels.size(); ++ch) {
    const auto pool = [&](Errors& e, auto&& value) {
      double square = 0, sum = 0, n = 0;
      for (const UsedShot& u : pooled)
        if (ch < u.before.size() && std::isfinite(value(u))) {
          square += value(u) * value(u);
          sum += value(u);
          ++n;
        }
      e.holdout = int(n);
      e.holdout_rmse = n ? std::sqrt(square / n) : kNaN;
      e.holdout_bias = n ? sum / n : kNaN;
    };
    pool(whole.channels[ch].before, [&](const UsedShot& u) { return u.before[ch]; });
    pool(whole.channels[ch].after, [&](const UsedShot& u) { return u.after[ch]; });
  }
  whole.shots = pooled;
  whole.holdout = int(pooled.size());
}

}  // namespace

LoopResult run(const LoopCase& c) {
  if (c.shots.rows() > kMostShots)
    throw DataError(fmt::format("{}: {} rows; a loop takes at most {}: give it a sample", c.shots.file, c.shots.rows(), kMostShots));
  std::vector<DerivedColumn> derived = audit(c.shots, c.blow.ball);
  const std::optional<std::set<int>> held = c.split.leave_one_out ? std::optional(std::set<int>{}) : std::nullopt;
  auto loop = std::make_unique<Loop>(c, derived, held);
  if (!loop->result.flagged.empty()) {
    // Bad rows can hide a formula: once they are known, look again.
    const std::vector<DerivedColumn> again = audit(without_flagged(c.shots, loop->result), c.blow.ball);
    const auto outputs = [](const std::vector<DerivedColumn>& d) {
      std::set<std::string> names;
      for (const DerivedColumn& x : d)
        if (!x.input) names.insert(x.column);
      return names;
    };
    const bool refit = outputs(again) != outputs(derived);
    derived = again;
    if (refit) loop = std::make_unique<Loop>(c, derived, held);
    loop->result.derived = derived;
  }
  LoopResult result = std::move(loop->result);
  if (c.split.leave_one_out && !result.channels.empty()) leave_one_out(c, derived, result);
  for (const DerivedColumn& d : derived) {
    if (!d.input) continue;
    for (int k = 0; k < kInputs; ++k) {
      const Column* column = c.shots.find_stem(stem(Input(k)));
      if (!column || column->name != d.column) continue;
      const Loop without(c, derived, held, Input(k));
      std::vector<std::string> names = without.result.adopted;
      for (const auto& tie : without.result.ties) names.push_back(fmt::format("{}", fmt::join(tie, " or ")));
      result.without.emplace_back(d.column, names);
      result.notes.push_back(fmt::format("{} is computed from {} and is no independent evidence; without it the verdict is {}{}", d.column,
                                         fmt::join(d.from, ", "), name(without.result.verdict),
                                         names.empty() ? "" : fmt::format(" ({})", fmt::join(names, ", "))));
    }
  }
  return result;
}

}  // namespace hosel::loop
