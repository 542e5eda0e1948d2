#include "loop/history/problem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <set>

#include "golf/dense.hpp"
#include "loop/deviation.hpp"
#include "loop/history/noise.hpp"
#include "loop/rules.hpp"
#include "solvers/random.hpp"

namespace hosel::loop {
namespace {

constexpr int kFewestReadings = 24;  // training readings that can test anything

/// Scatter of a channel by third differences, which a smooth motion leaves small: a first idea of the noise.
double rough_noise(const std::vector<HistoryRecord>& records, int channel) {
  std::vector<double> size;
  for (const HistoryRecord& r : records)
    for (std::ptrdiff_t i = 3; i < r.measured.rows(); ++i) {
      const auto y = [&](std::ptrdiff_t k) { return r.measured(i - k, channel); };
      const double d = y(0) - 3 * y(1) + 3 * y(2) - y(3);
      if (std::isfinite(d)) size.push_back(std::abs(d));
    }
  return robust_deviation(size) / std::sqrt(20.0);
}

}  // namespace

HistoryProblem::HistoryProblem(const HistoryModel& model, const HistorySetting& setting,
                               std::vector<HistoryRecord> records, const Split& how, std::vector<std::string> notes,
                               std::vector<EffectEntry> own)
    : model_(model), setting_(setting), records_(std::move(records)), own_(std::move(own)), notes_(std::move(notes)) {
  Eigen::Index samples = 0;
  for (const HistoryRecord& r : records_) samples += r.measured.rows();
  measured_.resize(samples, width());
  samples = 0;
  for (const HistoryRecord& r : records_) {
    measured_.middleRows(samples, r.measured.rows()) = r.measured;
    samples += r.measured.rows();
  }
  for (int c = 0; c < width(); ++c) {
    HistoryChannel& ch = setting_.channels[c];
    ch.noise = ch.declared ? *ch.declared : std::max(rough_noise(records_, c), ch.least_noise());
  }
  split(how);
}

void HistoryProblem::split(const Split& how) {
  std::mt19937_64 random(how.seed);
  const double fraction = how.holdout_fraction;
  for (HistoryRecord& r : records_) r.train.assign(r.times.size(), 1);
  if (how.span) {
    for (HistoryRecord& r : records_)
      for (std::size_t i = 0; i < r.times.size(); ++i)
        r.train[i] = r.times[i] < (*how.span)[0] || r.times[i] > (*how.span)[1];
    return;
  }
  if (!(fraction > 0)) return;
  if (setting_.driven && records_.size() >= 3) {
    const std::vector<std::size_t> order = solvers::shuffled(records_.size(), random);
    const std::size_t held =
        std::clamp<std::size_t>(std::size_t(std::lround(fraction * double(order.size()))), 1, order.size() - 1);
    for (std::size_t k = 0; k < held; ++k) records_[order[k]].train.assign(records_[order[k]].times.size(), 0);
    return;
  }
  // Stretches of time, the first never.
  const auto group = std::max<std::size_t>(2, std::size_t(std::lround(1 / fraction)));
  for (HistoryRecord& r : records_) {
    const std::size_t n = r.times.size(), blocks = std::min<std::size_t>(3 * group, n / 8);
    for (std::size_t first = 0; first + 1 < blocks; first += group) {
      const std::size_t size = std::min(group, blocks - first);
      std::size_t block = first + random() % size;
      if (block == 0) block = 1;
      for (std::size_t i = n * block / blocks; i < n * (block + 1) / blocks; ++i) r.train[i] = 0;
    }
  }
}

std::vector<Parametrisation> HistoryProblem::forms() const {
  std::vector<Parametrisation> all;
  for (const EffectEntry& e : effects_with(own_)) std::ranges::move(e.forms(setting_), std::back_inserter(all));
  return all;
}

std::vector<Problem::Row> HistoryProblem::rows() const {
  std::vector<Row> all;
  for (const HistoryRecord& r : records_)
    for (const char train : r.train) {
      const int k = int(all.size());
      all.push_back({k, k, fmt::format("{}", k + 1), !train});
    }
  return all;
}

std::vector<std::string> HistoryProblem::notes() const {
  std::vector<std::string> all = notes_;
  for (const HistoryChannel& c : setting_.channels)
    if (c.colour > 0)
      all.push_back(fmt::format("{}: neighbouring readings are correlated by {:.2f}; every test counts with that",
                                c.name, c.colour));
  return all;
}

std::optional<std::string> HistoryProblem::too_few() const {
  if (density(Part::train).values < kFewestReadings)
    return fmt::format("fewer than {} readings to learn from: too few to test anything", kFewestReadings);
  return {};
}

double HistoryProblem::whiten(const HistoryRecord& record, const Eigen::MatrixXd& column, bool train, double window,
                              double* out) const {
  const auto n = record.measured.rows();
  const double last = record.times.empty() ? 0 : record.times.front() + window;
  double logarithms = 0;
  for (std::ptrdiff_t c = 0; c < record.measured.cols(); ++c) {
    const HistoryChannel& ch = channel(int(c));
    const double one = 1 / ch.noise, rho = ch.colour, next = one / std::sqrt(1 - rho * rho);
    bool before = false;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const bool here = std::isfinite(record.measured(i, c)) && (record.train[i] != 0) == train &&
                        record.times[i] <= last;
      out[c * n + i] = !here ? 0 : before ? next * (column(i, c) - rho * column(i - 1, c)) : one * column(i, c);
      if (here) logarithms += std::log(before ? next : one);
      before = here;
    }
  }
  return logarithms;
}

bool HistoryProblem::solve(const Model& model, const Eigen::VectorXd& p, double window, Solution& out,
                           Eigen::VectorXd* z) const {
  TestSetup setup(setting_.channels.size());
  model.each(p.data(), [&](const Parametrisation& f, Sizes q) { f.setup(q, setup); });
  if (!model_.answer(setup, out.answers)) return false;
  if (z) z->resize(measured_.size());
  out.unknowns.assign(records_.size(), {});
  std::ptrdiff_t place = 0;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    const HistoryRecord& record = records_[r];
    Prediction& a = out.answers[r];
    const auto size = record.measured.size();
    for (std::ptrdiff_t c = 0; c < record.measured.cols(); ++c) {
      const double gain = 1 + setup.gain[c], si = channel(int(c)).si;
      a.value.col(c) = (gain * a.value.col(c).array() + setup.offset[c]) / si;
      for (Eigen::MatrixXd& u : a.unknown) u.col(c) *= gain / si;
    }
    if (!a.unknown.empty())  // where the start is unknown, so is every zero
      for (std::ptrdiff_t c = 0; c < record.measured.cols(); ++c) {
        a.unknown.emplace_back(Eigen::MatrixXd::Zero(record.measured.rows(), record.measured.cols()));
        a.unknown.back().col(c).setOnes();
      }
    Eigen::VectorXd w(size);
    whiten(record, a.value - record.measured, true, window, w.data());
    if (!a.unknown.empty()) {
      Eigen::MatrixXd U(size, std::ptrdiff_t(a.unknown.size()));
      for (std::size_t k = 0; k < a.unknown.size(); ++k)
        whiten(record, a.unknown[k], true, window, U.col(std::ptrdiff_t(k)).data());
      Eigen::VectorXd norm = U.colwise().norm();
      // What the channels show of a mode of the other plane is round-off, and no unknown.
      const double faint = kFaint * norm.maxCoeff();
      for (std::ptrdiff_t k = 0; k < U.cols(); ++k) {
        if (norm[k] > faint) U.col(k) /= norm[k];
        else U.col(k).setZero(), norm[k] = 1;
      }
      // A Tikhonov term: modes in two planes with one frequency look alike in one channel.
      Eigen::MatrixXd G = U.transpose() * U;
      G.diagonal().array() += 1e-8;
      const Eigen::VectorXd u = dense::Ldlt(G).solve(Eigen::VectorXd(-(U.transpose() * w)));
      w += U * u;
      out.unknowns[r] = u.cwiseQuotient(norm);
    }
    if (!w.allFinite()) return false;
    if (z) z->segment(place, size) = w;
    place += size;
  }
  return true;
}

bool HistoryProblem::whitened(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                              double window) const {
  Solution s;
  if (part != Part::holdout) return solve(model, p, window, s, &z);
  const Eigen::MatrixXd e = residuals(model, p);
  if (!e.size()) return false;
  z.resize(e.size());
  Eigen::Index row = 0;
  for (const HistoryRecord& r : records_) {
    whiten(r, e.middleRows(row, r.measured.rows()), false, window, z.data() + row * width());
    row += r.measured.rows();
  }
  return true;
}

/// One-sided, inside the plausible range, where the model has an answer.
bool HistoryProblem::linearise(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                               Eigen::MatrixXd& J, double window) const {
  if (!whitened(part, model, p, z, window)) return false;
  J.resize(z.size(), p.size());
  Eigen::VectorXd x = p, moved;
  Eigen::Index k = 0;
  for (const Parameter* q : model.parameters()) {
    const double step = p[k] + kStep * q->scale > q->max ? -kStep : kStep;
    x[k] = p[k] + step * q->scale;
    if (!whitened(part, model, x, moved, window)) return false;
    x[k] = p[k];
    J.col(k++) = (moved - z) / step;
  }
  return true;
}

/// Central, of second order one-sided at the edges of the plausible range; zero where the model has no answer.
Eigen::MatrixXd HistoryProblem::jacobian(Part part, const Model& model, const Eigen::VectorXd& p) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(measured_.size(), p.size());
  Eigen::VectorXd x = p, one, two, z;
  Eigen::Index k = 0;
  for (const Parameter* q : model.parameters()) {
    const double step = kStep * q->scale;
    const auto look = [&](double steps, Eigen::VectorXd& out) {
      x[k] = p[k] + steps * step;
      const bool good = whitened(part, model, x, out, Stage::kWhole);
      x[k] = p[k];
      return good;
    };
    if (p[k] + step > q->max || p[k] - step < q->min) {
      const double side = p[k] + step > q->max ? -1 : 1;
      if (look(0, z) && look(side, one) && look(2 * side, two)) J.col(k) = side * (4 * one - 3 * z - two) / (2 * kStep);
    } else if (look(1, one) && look(-1, two)) {
      J.col(k) = (one - two) / (2 * kStep);
    }
    ++k;
  }
  return J;
}

/// Held-out readings too, the unknowns of the start from training. Empty where the model has no answer.
Eigen::MatrixXd HistoryProblem::residuals(const Model& model, const Eigen::VectorXd& p) const {
  Solution s;
  if (!solve(model, p, Stage::kWhole, s, nullptr)) return {};
  Eigen::MatrixXd e = -measured_;
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    auto here = e.middleRows(row, records_[r].measured.rows());
    here += s.answers[r].value;
    for (std::size_t k = 0; k < s.answers[r].unknown.size(); ++k)
      here += s.unknowns[r][std::ptrdiff_t(k)] * s.answers[r].unknown[k];
    row += here.rows();
  }
  return e;
}

Problem::Density HistoryProblem::density(Part part) const {
  Density d;
  const bool train = part != Part::holdout;
  for (const HistoryRecord& r : records_) {
    Eigen::VectorXd whitened(r.measured.size());
    const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(r.measured.rows(), r.measured.cols());
    d.log_whitening += whiten(r, ones, train, Stage::kWhole, whitened.data());
    d.values += double((whitened.array() != 0).count());
  }
  return d;
}

/// An oscillation is fitted over a few periods first, then over ever more, since over many a frequency that is off by
/// one cycle is a minimum of its own.
std::vector<Stage> HistoryProblem::stages() const {
  if (model_.slow()) return {{.loss = {}, .iterations = 5}};
  std::vector<Stage> all;
  double span = 0;
  for (const HistoryRecord& r : records_)
    if (!r.times.empty()) span = std::max(span, r.times.back() - r.times.front());
  // Ten times three times as long, 240,000 periods, are more than any record of a bench has.
  if (const double periods = 2 * kPi / setting_.frequency; setting_.frequency > 0)
    for (double w = std::max(4 * periods, span / std::pow(3, 10)); w < 0.7 * span; w *= 3)
      all.push_back({.window = w, .loss = {}, .iterations = 8});
  all.push_back({.loss = {}, .iterations = 20});
  return all;
}

Effort HistoryProblem::effort() const {
  if (model_.slow()) return {.starts = 1, .pairs = 0, .singles_grown = 1, .pairs_grown = 1, .grown = 4, .reported = 12};
  return {.starts = 8, .pairs = 0, .singles_grown = 5, .pairs_grown = 2, .grown = 4};
}

/// Readings that stand alone far from the best fit and from their neighbours.
bool HistoryProblem::screen(const Selection& selection) {
  const Eigen::MatrixXd e = residuals(selection.richest.model, selection.richest.p);
  const std::size_t known = flags_.size();
  Eigen::Index first = 0;
  for (HistoryRecord& record : records_) {
    const Eigen::Index rows = e.size() ? record.measured.rows() : 0;
    for (int c = 0; c < width(); ++c) {
      const auto here = [&](Eigen::Index i) { return e(first + i, c); };
      std::vector<double> size;
      for (Eigen::Index i = 0; i < rows; ++i)
        if (std::isfinite(here(i))) size.push_back(std::abs(here(i)));
      const double scale = std::max(robust_deviation(size), channel(c).noise);
      for (Eigen::Index i = 0; i < rows; ++i) {
        if (!(std::abs(here(i)) > kFar * scale)) continue;
        const auto beside = [&](Eigen::Index k) {
          return k < 0 || k >= rows || !std::isfinite(here(k)) ? 0.0 : here(k);
        };
        // A motion moves its neighbours too; two readings in a row may fail together.
        if (std::abs(here(i) - 0.5 * (beside(i - 2) + beside(i + 2))) < 6 * scale) continue;
        flags_.push_back(
            {int(first + i),
             {},
             fmt::format("{}", first + i + 1),
             channel(c).name,
             fmt::format("stands alone: {:.3g} off at {:.6g} s in {}", -here(i), record.times[i], record.name),
             int(flags_.size()) + 1});
        record.measured(i, c) = measured_(first + i, c) = kNaN;
      }
    }
    first += record.measured.rows();
  }
  return flags_.size() == known;
}

Scatter HistoryProblem::scatter(int c, const Eigen::MatrixXd& residuals, int) const {
  const Colour noise = colour(*this, residuals, c, channel(c).colour == 0);
  return {noise.sigma / channel(c).noise, 2 / std::sqrt(std::max(1.0, noise.count))};
}

/// The richest model sees the least of an effect in the noise.
double HistoryProblem::update_noise(const Fit&, const Fit& richest) {
  const Eigen::MatrixXd e = residuals(richest.model, richest.p);
  double change = 0;
  for (int c = 0; c < width() && e.size(); ++c) {
    HistoryChannel& ch = setting_.channels[c];
    Colour noise = colour(*this, e, c, false);
    if (noise.rho < 0.06) noise = colour(*this, e, c, true);
    const double sigma = std::max(ch.trusted() ? *ch.declared : noise.sigma, ch.least_noise());
    change = std::max({change, std::abs(std::log(sigma / ch.noise)), std::abs(noise.rho - ch.colour)});
    ch.noise = sigma;
    ch.colour = noise.rho;
  }
  return change;
}

StructureMap HistoryProblem::structure(const Fit& fit, const Fit&, const Eigen::MatrixXd& directions,
                                       const Rules&) const {
  const Eigen::VectorXd z = loop::whitened(*this, Part::select, fit.model, fit.p);
  return z.size() ? history_structure(*this, z, directions) : StructureMap{};
}

/// A fit may move what it cannot explain into a channel that the base leaves clean: the place is where something
/// remains both before and after it, else where it was before.
std::vector<Location> HistoryProblem::places(const Selection& s) const {
  const auto shows = [](const Finding& f) { return f.channel >= 0 && f.p_adjusted <= Rules::of_histories().remaining; };
  std::set<int> dirty_before, both;
  for (const Finding& f : s.before.findings)
    if (shows(f)) dirty_before.insert(f.channel);
  for (const Finding& f : s.after.findings)
    if (shows(f) && dirty_before.contains(f.channel)) both.insert(f.channel);
  const bool moved = both.empty() && !dirty_before.empty();
  std::vector<Finding> told;
  for (const Finding& f : (moved ? s.before : s.after).findings)
    if (shows(f) && (moved || both.empty() || both.contains(f.channel))) told.push_back(f);
  // An oscillation says more than the band it lies in.
  std::ranges::stable_partition(told, [](const Finding& f) { return f.kind == "oscillation"; });
  std::vector<Location> all;
  for (const Finding& f : told)
    if (std::ranges::find(all, channel(f.channel).name, &Location::channel) == all.end())
      all.push_back(place_of(*this, f));
  return all;
}

NextExperiment HistoryProblem::next_experiment(const LoopResult& so_far) const {
  if (too_few()) return {.text = "A longer record"};
  if (so_far.verdict == Verdict::unexplained && !so_far.unexplained.empty()) {
    const auto placed = std::ranges::find_if(so_far.unexplained, [](const Location& l) { return !l.channel.empty(); });
    const std::string left = placed == so_far.unexplained.end() ? so_far.unexplained.front().detail
                                                                : fmt::format("{} holds {} that no candidate explains",
                                                                              placed->channel, placed->detail);
    return {.text = fmt::format(
                "Repeat the record with one thing changed at a time (free length, tip mass, amplitude): {}", left)};
  }
  if (so_far.verdict == Verdict::ambiguous) {
    const std::string sensor = fmt::format("{}", fmt::join(sensors_of(so_far.ties, own_), "; or "));
    return {.text = fmt::format("This record cannot separate {}: measure {}; or record the same club with a known mass "
                                "at the tip and with a shorter free length",
                                fmt::join(so_far.ties | std::views::join, ", "), sensor),
            .sensor = sensor};
  }
  if (so_far.verdict == Verdict::insufficient)
    return {.text = "A longer or stronger record: the list of smallest effects says what this one could have shown"};
  if (so_far.verdict == Verdict::noise_contradicted)
    return {.text = "A record at rest, to find the instrument's own scatter"};
  return {.text = "Nothing is tied. A longer record would narrow the parameters most"};
}

}  // namespace hosel::loop
