#include "loop/shots/remainder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "golf/parallel.hpp"
#include "loop/deviation.hpp"
#include "loop/rules.hpp"
#include "solvers/kriging.hpp"

namespace hosel::loop {
namespace {

constexpr std::size_t kMostForRemainder = 5000;  // rows
constexpr std::size_t kMostPoints = 300;         // of a process, whose search for lengths takes a factor a step
constexpr int kParts = 5;                        // of the rows, each foretold by the others

/// Columns that a remainder may follow, over the model's shots: standardised to some two units, inside the range of
/// `rows`.
struct RemainderInputs {
  std::vector<std::string> name;
  Eigen::MatrixXd x;                 // shots x columns
  std::vector<double> middle, unit;  // of each in its header's unit

  RemainderInputs(const std::vector<Line>& lines, const Shots& shots, const std::vector<int>& rows) {
    std::vector<Eigen::VectorXd> kept;
    for (const Line& l : lines) {
      std::vector<double> seen;
      for (const int i : rows)
        if (std::isfinite(l.x[i])) seen.push_back(l.x[i]);
      if (seen.size() < rows.size() / 2 || seen.size() < 3) continue;
      // In the order of the rows: Eigen's order depends on where the numbers lie in memory.
      const double mean = std::accumulate(seen.begin(), seen.end(), 0.0) / double(seen.size());
      double square = 0;
      for (const double v : seen) square += (v - mean) * (v - mean) / double(seen.size());
      if (!varies(std::sqrt(square), mean)) continue;
      const auto [low, high] = std::ranges::minmax(seen);
      const double half = 2 * std::sqrt(square);
      Eigen::VectorXd scaled = l.x;
      for (double& v : scaled) v = ((std::isfinite(v) ? std::clamp(v, low, high) : mean) - mean) / half;
      const Column* column = shots.find(l.name);
      const double si = column ? column->si : 1;
      name.push_back(l.name);
      middle.push_back(mean / si);
      unit.push_back(half / si);
      kept.push_back(std::move(scaled));
    }
    x.resize(kept.empty() ? 0 : kept.front().size(), std::ptrdiff_t(kept.size()));
    for (std::size_t k = 0; k < kept.size(); ++k) x.col(std::ptrdiff_t(k)) = kept[k];
  }
};

/// Of some of the rows, evenly spread, then through all of them.
solvers::Kriging process_of(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
  std::vector<int> all(std::size_t(x.rows()));
  std::iota(all.begin(), all.end(), 0);
  const std::vector<int> some = evenly(all, kMostPoints);
  const Eigen::MatrixXd of = x(some, Eigen::all), told = y(some, Eigen::all);
  const solvers::Kriging likeliest(of, told, solvers::Kriging::noisy());
  return some.size() == all.size() ? likeliest : likeliest.through(x, y);
}

/// One channel's: its value over all shots, of training rows as the other parts foretell it; empty: none.
struct OfChannel {
  Eigen::VectorXd value;
  Remainder::Place place;
};

OfChannel of_channel(const ShotModel& model, int c, const std::vector<int>& rows, const std::vector<int>& part,
                     const RemainderInputs& in, const Eigen::VectorXd& residual) {
  std::vector<int> seen;
  std::vector<double> r;
  for (const int i : rows)
    if (std::isfinite(residual[i])) {
      seen.push_back(i);
      r.push_back(residual[i]);
    }
  if (seen.size() < kFewestToLearn) return {};
  const auto [middle, scale] = robust_moments(r);
  if (!(scale > 0)) return {};
  const auto n = std::ptrdiff_t(seen.size());
  Eigen::MatrixXd x(n, in.x.cols()), y(n, 1);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    x.row(i) = in.x.row(seen[i]);
    y(i, 0) = std::clamp((r[i] - middle) / scale, -kFence, kFence);
  }
  // Lengths and nugget too are those of the other parts: chosen on all rows they would know what they foretell.
  Eigen::VectorXd others(n);
  for (int k = 0; k < kParts; ++k) {
    std::vector<std::ptrdiff_t> in_part, outside;
    for (std::ptrdiff_t i = 0; i < n; ++i) (part[seen[i]] == k ? in_part : outside).push_back(i);
    if (in_part.empty() || outside.size() < kFewestToLearn / 2) return {};
    const Eigen::MatrixXd from = x(outside, Eigen::all), of = y(outside, Eigen::all);
    const solvers::Kriging process = process_of(from, of);
    for (const std::ptrdiff_t i : in_part) others[i] = process(x.row(i).transpose())[0];
  }
  double fall = 0;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double sigma = model.sigma(seen[i], c), z = (scale * y(i, 0) + middle) / sigma,
                 g = (scale * others[i] + middle) / sigma;
    fall += z * z - (z - g) * (z - g);
  }
  // Rows that others foretell gain t by chance in exp(-t / 2) of such channels at most.
  if (!(fall > 2 * (kBeyondChance + std::log(model.width())))) return {};
  const solvers::Kriging process = process_of(x, y);
  OfChannel out{.value = Eigen::VectorXd(model.shots()), .place = {.channel = c}};
  Eigen::VectorXd without = Eigen::VectorXd::Zero(in.x.cols());
  double whole = 0;
  const auto value = [&](const Eigen::VectorXd& at) { return scale * process(at)[0] + middle; };
  for (int i = 0; i < model.shots(); ++i) out.value[i] = value(in.x.row(i).transpose());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double g = out.value[seen[i]];
    whole += g * g / double(n);
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      Eigen::VectorXd at = x.row(i).transpose();
      at[k] = 0;
      without[k] += std::pow(g - value(at), 2) / double(n);
    }
    if (std::abs(g) > std::abs(out.place.largest)) out.place.largest = g, out.place.at = double(i);
  }
  Eigen::Index most = 0;
  without.maxCoeff(&most);
  out.place.size = std::sqrt(whole);
  out.place.along = in.name[most];
  out.place.share = whole > 0 ? std::min(1.0, without[most] / whole) : 0;
  out.place.at = in.middle[most] + in.unit[most] * x(std::ptrdiff_t(out.place.at), most);
  for (std::ptrdiff_t i = 0; i < n; ++i) out.value[seen[i]] = scale * others[i] + middle;
  return out;
}

}  // namespace

std::optional<Remainder> remainder(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                   const std::vector<int>& all, const std::vector<int>& group, const Fit& fit) {
  const std::vector<int> rows = evenly(all, kMostForRemainder);
  // Whole groups in turn.
  std::map<int, int> part_of;
  std::vector<int> part(group.size(), 0);
  for (const int i : rows) {
    const auto known = part_of.try_emplace(group[i], int(part_of.size()) % kParts).first;
    part[i] = known->second;
  }
  if (rows.size() < kFewestToLearn || part_of.size() < kParts) return {};
  const RemainderInputs in(columns_of(shots, row_of, model), shots, rows);
  if (in.name.empty()) return {};
  const Eigen::MatrixXd residuals = model.residuals(fit.model, fit.p.data());
  std::vector<OfChannel> found(static_cast<std::size_t>(model.width()));
  for_all(std::size_t(0), found.size(), [&](std::size_t c) {
    found[c] = of_channel(model, int(c), rows, part, in, residuals.col(std::ptrdiff_t(c)));
  });

  Remainder out{.value = Eigen::MatrixXd::Zero(model.shots(), model.width())};
  for (std::size_t c = 0; c < found.size(); ++c) {
    if (!found[c].value.size()) continue;
    out.value.col(std::ptrdiff_t(c)) = found[c].value;
    out.places.push_back(found[c].place);
  }
  const solvers::Loss loss = loss_of_shot(model.width());
  for (const int i : all) {
    Eigen::VectorXd r = residuals.row(i).transpose();
    for (double& v : r) v = std::isfinite(v) ? v : 0;
    out.before += loss((model.whitening(i) * r).squaredNorm());
    out.after += loss((model.whitening(i) * (r - out.value.row(i).transpose())).squaredNorm());
  }
  if (!(out.fall() > 0)) {  // what one channel gains, another's agreement with it loses
    out.value.setZero();
    out.places.clear();
    out.after = out.before;
  }
  std::ranges::stable_sort(out.places, std::ranges::greater{},
                           [&](const auto& p) { return p.size / model.channel(p.channel).noise; });
  return out;
}

}  // namespace hosel::loop
