#include "solvers/main_effects.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "golf/dense.hpp"
#include "solvers/random.hpp"

namespace hosel::solvers {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Columns of one factor, and what they are at its two ends.
struct Block {
  MatrixXd columns;
  MatrixXd ends;  ///< ordered: rows at the lowest and the highest value; else one a level
};

Block block_of(const EffectFactor& factor, bool quadratic) {
  const auto n = Eigen::Index(factor.x.size());
  const std::set<double> levels(factor.x.begin(), factor.x.end());
  Block b;
  if (factor.ordered) {
    const Eigen::Index degree = quadratic && levels.size() > 2 ? 2 : 1;
    const double low = *levels.begin(), high = *levels.rbegin();
    b.columns.resize(n, degree);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double t = 2 * (factor.x[std::size_t(i)] - low) / (high - low) - 1;
      b.columns(i, 0) = t;
      if (degree == 2) b.columns(i, 1) = (3 * t * t - 1) / 2;
    }
    b.ends = MatrixXd::Ones(2, degree);
    b.ends(0, 0) = -1;
  } else {
    const auto count = Eigen::Index(levels.size());
    b.columns = MatrixXd::Zero(n, count - 1);
    for (Eigen::Index i = 0; i < n; ++i)
      if (const auto level = std::distance(levels.begin(), levels.find(factor.x[std::size_t(i)])); level > 0)
        b.columns(i, level - 1) = 1;
    b.ends = MatrixXd::Zero(count, count - 1);
    b.ends.bottomRows(count - 1).setIdentity();
  }
  const Eigen::RowVectorXd mean = b.columns.colwise().mean();
  b.columns.rowwise() -= mean;
  b.ends.rowwise() -= mean;
  return b;
}

double variance(const VectorXd& v) { return v.size() ? (v.array() - v.mean()).square().mean() : 0; }

/// Shares of the variance over the rows `kept`, by the coefficients fitted to them.
VectorXd shares(const std::vector<Block>& blocks, const MatrixXd& all, const VectorXd& y,
                const std::vector<Eigen::Index>& kept, VectorXd& coefficients) {
  const MatrixXd x = all(kept, Eigen::all);
  const VectorXd response = y(kept);
  coefficients = dense::minimum_norm(x, response);
  VectorXd out(Eigen::Index(blocks.size()));
  const double whole = variance(response);
  Eigen::Index at = 1;
  for (std::size_t f = 0; f < blocks.size(); ++f) {
    const Eigen::Index width = blocks[f].columns.cols();
    out[Eigen::Index(f)] = whole > 0 ? variance(x.middleCols(at, width) * coefficients.segment(at, width)) / whole : 0;
    at += width;
  }
  return out;
}

/// What the curve is where it turns within its range: slope * P1(t) + curvature * P2(t), t from -1 to 1.
std::optional<double> turn(const MainEffect& e, double slope, double curvature) {
  if (!(std::abs(slope) < 3 * std::abs(curvature))) return {};
  const double t = -slope / (3 * curvature);
  const double there = e.at_high + slope * (t - 1) + curvature * 1.5 * (t * t - 1);
  const double beyond = curvature > 0 ? std::min(e.at_low, e.at_high) - there : there - std::max(e.at_low, e.at_high);
  constexpr double least = 0.25;  // a quadratic through what saturates turns too
  return beyond > least * std::abs(e.at_high - e.at_low) ? std::optional(there) : std::nullopt;
}

/// Mean response at each value of a factor, and how many points have it.
std::map<double, std::pair<double, double>> means_of(const EffectFactor& f, const VectorXd& y) {
  std::map<double, std::pair<double, double>> out;
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    auto& [mean, n] = out[f.x[i]];
    mean += (y[Eigen::Index(i)] - mean) / ++n;
  }
  return out;
}

/// Variance of those means over that of the response.
double share_of(const std::map<double, std::pair<double, double>>& means, const VectorXd& y) {
  double sum = 0;
  for (const auto& [x, at] : means) sum += at.second * std::pow(at.first - y.mean(), 2);
  return sum / double(y.size()) / variance(y);
}

/// Whether every combination of the factors' values stands there equally often.
bool full_factorial(const std::vector<EffectFactor>& factors) {
  std::map<std::vector<double>, std::size_t> times;
  const std::size_t n = factors.front().x.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> at;
    for (const EffectFactor& f : factors) at.push_back(f.x[i]);
    ++times[at];
  }
  std::size_t combinations = 1;
  for (const EffectFactor& f : factors) combinations *= std::set<double>(f.x.begin(), f.x.end()).size();
  return times.size() == combinations &&
         std::ranges::all_of(times, [&](const auto& t) { return t.second * combinations == n; });
}

}  // namespace

std::optional<MainEffects> main_effects(const std::vector<EffectFactor>& factors, const std::vector<double>& response) {
  const auto n = Eigen::Index(response.size());
  if (factors.empty() || n < 4) return {};
  const VectorXd y = Eigen::Map<const VectorXd>(response.data(), n);
  if (!(y.maxCoeff() - y.minCoeff() > 1e-12 * y.cwiseAbs().maxCoeff())) return {};

  MainEffects out;
  out.full_factorial = full_factorial(factors);
  // Columns of all factors; straight lines alone where points that leave gaps are few.
  bool quadratic = true;
  const auto unknowns = [&] {
    Eigen::Index width = 1;
    for (const EffectFactor& f : factors) {
      const auto levels = Eigen::Index(std::set<double>(f.x.begin(), f.x.end()).size());
      width += f.ordered ? Eigen::Index(quadratic && levels > 2 ? 2 : 1) : levels - 1;
    }
    return width;
  };
  if (n < (out.full_factorial ? unknowns() + 2 : 3 * unknowns())) quadratic = false;
  const Eigen::Index width = unknowns();
  if (n < width + 2) return {};
  std::vector<Block> blocks;
  for (const EffectFactor& f : factors) blocks.push_back(block_of(f, quadratic));
  MatrixXd all(n, width);
  all.col(0).setOnes();
  Eigen::Index at = 1;
  for (const Block& b : blocks) {
    all.middleCols(at, b.columns.cols()) = b.columns;
    at += b.columns.cols();
  }

  std::vector<Eigen::Index> every(static_cast<std::size_t>(n));
  std::iota(every.begin(), every.end(), Eigen::Index(0));
  VectorXd coefficients;
  VectorXd whole = shares(blocks, all, y, every, coefficients);
  if (out.full_factorial)  // of any curve, not of a quadratic alone
    for (std::size_t f = 0; f < factors.size(); ++f) whole[Eigen::Index(f)] = share_of(means_of(factors[f], y), y);

  at = 1;
  for (std::size_t f = 0; f < blocks.size(); ++f) {
    const Eigen::Index columns = blocks[f].columns.cols();
    const VectorXd ends = (blocks[f].ends * coefficients.segment(at, columns)).array() + y.mean();
    const bool ordered = factors[f].ordered;
    MainEffect& e = out.factors.emplace_back(MainEffect{.share = whole[Eigen::Index(f)],
                                                        .at_low = ordered ? ends[0] : ends.minCoeff(),
                                                        .at_high = ordered ? ends[1] : ends.maxCoeff()});
    if (ordered && columns == 2) e.between = turn(e, coefficients[at], coefficients[at + 1]);
    if (ordered && out.full_factorial) {
      const auto means = means_of(factors[f], y);
      e.at_low = means.begin()->second.first;
      e.at_high = means.rbegin()->second.first;
    }
    at += columns;
  }
  constexpr double slack = 0.2;  // a space-filling design of few points has chance correlations
  const double explained = 1 - variance(y - all * coefficients) / variance(y);
  out.separable = out.full_factorial || (std::abs(whole.sum() - explained) < slack && whole.maxCoeff() < 1 + 1e-9);
  out.order.resize(factors.size());
  std::iota(out.order.begin(), out.order.end(), std::size_t(0));
  std::ranges::stable_sort(out.order, std::greater(), [&](std::size_t f) { return out.factors[f].share; });

  // Groups of points left out, drawn with a seed of their own: the same design gives the same intervals.
  constexpr Eigen::Index most = 40;
  const Eigen::Index groups = std::min(n, most);
  std::mt19937_64 random(1981);
  const std::vector<std::size_t> turn = shuffled(std::size_t(n), random);
  MatrixXd left_out(groups, Eigen::Index(factors.size()));
  double error = 0;
  for (Eigen::Index g = 0; g < groups; ++g) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < n; ++i)
      if (Eigen::Index(turn[std::size_t(i)]) % groups != g) kept.push_back(i);
    VectorXd own;
    left_out.row(g) = shares(blocks, all, y, kept, own).transpose();
    for (Eigen::Index i = 0; i < n; ++i)
      if (Eigen::Index(turn[std::size_t(i)]) % groups == g) error += std::pow(y[i] - all.row(i).dot(own), 2);
  }
  out.predicted = 1 - error / double(n) / variance(y);
  const double t = boost::math::quantile(boost::math::students_t(double(groups - 1)), 0.975);
  const auto half_width = [&](const VectorXd& values) {
    return t * std::sqrt(double(groups - 1) * variance(values));  // (G - 1) / G times the sum of squares
  };
  for (std::size_t f = 0; f < factors.size(); ++f) {
    MainEffect& e = out.factors[f];
    const double half = half_width(left_out.col(Eigen::Index(f)));
    e.low = std::max(0.0, e.share - half);
    e.high = std::min(1.0, e.share + half);
  }
  if (factors.size() > 1) {
    const auto first = Eigen::Index(out.order[0]), second = Eigen::Index(out.order[1]);
    const double half = half_width(left_out.col(first) - left_out.col(second));
    out.first_is_certain = whole[first] - whole[second] > half;
  }
  return out;
}

}  // namespace hosel::solvers
