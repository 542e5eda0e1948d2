#include "app/study/emulator.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "solvers/sobol_indices.hpp"

namespace hosel::app {
namespace {

using Eigen::Index;

constexpr Index kMost = 300;     // points: the cost grows with their cube
constexpr Index kGroups = 8;     // left out in turn
constexpr double kEnough = 0.9;  // of the variance, at points left out

}  // namespace

StudyEmulator::Scale StudyEmulator::scale(std::size_t column) const {
  const solvers::Distribution& s = columns_[column].spread;
  if (s.kind == solvers::Distribution::Kind::uniform) return {(s.low + s.high) / 2, (s.high - s.low) / 2};
  return {s.mean, 2 * s.sd};
}

Eigen::VectorXd StudyEmulator::scaled(const Eigen::VectorXd& x) const {
  Eigen::VectorXd out(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Scale s = scale(std::size_t(i));
    out[i] = (x[i] - s.centre) / s.half;
  }
  return out;
}

Eigen::VectorXd StudyEmulator::at_shares(const Eigen::VectorXd& share) const {
  Eigen::VectorXd out(share.size());
  for (Index i = 0; i < share.size(); ++i)
    out[i] = columns_[std::size_t(i)].spread.quantile(std::clamp(share[i], 1e-9, 1 - 1e-9));
  return out;
}

std::optional<StudyEmulator> StudyEmulator::of(const StudyTable& table, std::size_t series) {
  StudyEmulator out;
  out.columns_ = table.design.only_drawn();
  const auto inputs = Index(out.columns_.size());
  if (inputs == 0) return {};
  const StudySeries& s = table.series[series];
  std::vector<Eigen::VectorXd> at;
  std::vector<double> answers;
  std::vector<std::vector<double>> numbers;
  for (std::size_t c = 0; c < std::size_t(inputs); ++c) numbers.push_back(table.design.numbers(c));
  for (std::size_t d = 0; d < s.y.size(); ++d) {
    if (!std::isfinite(s.y[d])) continue;
    Eigen::VectorXd x(inputs);
    for (Index i = 0; i < inputs; ++i) x[i] = numbers[std::size_t(i)][d];
    at.push_back(out.scaled(x));
    answers.push_back(s.y[d]);
  }
  const auto all = Index(answers.size()), n = std::min(all, kMost);
  if (all < std::max<Index>(3 * inputs, kGroups)) return {};
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(answers.data(), all);
  const double variance = (y.array() - y.mean()).square().mean();
  if (!(variance > 1e-20 * y.squaredNorm() / double(all))) return {};
  Eigen::MatrixXd x(n, inputs);
  for (Index k = 0; k < n; ++k) x.row(k) = at[std::size_t(k)].transpose();
  out.points_ = std::size_t(n);
  out.whole_ = solvers::Kriging(x, y.head(n));

  // A sample's points stand in no order: every eighth is a group of its own.
  double square = 0;
  for (Index g = 0; g < kGroups; ++g) {
    std::vector<Index> kept;
    for (Index k = 0; k < n; ++k)
      if (k % kGroups != g) kept.push_back(k);
    out.without_.emplace_back(x(kept, Eigen::all), y(kept), out.whole_.correlation(),
                              solvers::Kriging::Search{.sweeps = 0});
    for (Index k = g; k < n; k += kGroups) square += std::pow(out.without_.back()(at[std::size_t(k)])[0] - y[k], 2);
  }
  for (Index k = n; k < all; ++k) square += std::pow(out.whole_(at[std::size_t(k)])[0] - y[k], 2);
  out.error_ = std::sqrt(square / double(all));
  out.predicted_ = 1 - square / double(all) / variance;
  if (!(out.predicted_ >= kEnough)) return {};
  return out;
}

StudyEmulator::Shares StudyEmulator::shares() const {
  constexpr std::size_t draws = 1024;
  const auto inputs = Index(columns_.size());
  /// First-order indices above the total ones.
  const auto indices = [&](const solvers::Kriging& of) {
    const auto s =
        solvers::sobol_indices([&](const Eigen::VectorXd& u) { return of(scaled(at_shares(u)))[0]; }, inputs, draws);
    Eigen::VectorXd both(2 * inputs);
    both << s.first, s.total;
    return both;
  };
  const Eigen::VectorXd whole = indices(whole_);
  Eigen::MatrixXd left_out(kGroups, 2 * inputs);
  for (Index g = 0; g < kGroups; ++g) left_out.row(g) = indices(without_[std::size_t(g)]).transpose();
  // The jackknife over groups (Efron and Stein 1981), as of solvers::main_effects.
  const Eigen::RowVectorXd mean = left_out.colwise().mean();
  const Eigen::RowVectorXd sd =
      ((left_out.rowwise() - mean).array().square().colwise().sum() * double(kGroups - 1) / double(kGroups)).sqrt();
  const double t = boost::math::quantile(boost::math::students_t(double(kGroups - 1)), 0.975);
  Shares out;
  for (Index i = 0; i < 2 * inputs; ++i)
    (i < inputs ? out.alone : out.together)
        .push_back({std::clamp(whole[i], 0.0, 1.0), std::clamp(whole[i] - t * sd[i], 0.0, 1.0),
                    std::clamp(whole[i] + t * sd[i], 0.0, 1.0)});
  return out;
}

}  // namespace hosel::app
