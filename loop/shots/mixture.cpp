#include "loop/shots/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "golf/dense.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

constexpr double kLeastShare = 0.125, kLeastApart = 2.4;
constexpr Eigen::Index kFewestToPart = 16;  // rows

double log_normal(double u, double s) { return -0.5 * u * u / (s * s) - std::log(s) - kLogRootTwoPi; }

/// Largest log-likelihood of one population: normal, or Student of some degrees of freedom.
double one_population(const Eigen::VectorXd& y) {
  const double n = double(y.size()), mean = y.mean(), s = std::sqrt((y.array() - mean).square().sum() / n);
  if (!(s > 0)) return kInfinity;
  double best = -n * (std::log(s) + kLogRootTwoPi + 0.5);
  for (const double nu : {2.0, 3.0, 5.0, 10.0}) {
    double centre = mean, scale = s;
    Eigen::ArrayXd weight;
    for (int pass = 0; pass < 30; ++pass) {  // expectation and maximisation
      weight = (nu + 1) / (nu + ((y.array() - centre) / scale).square());
      centre = (weight * y.array()).sum() / weight.sum();
      scale = std::sqrt((weight * (y.array() - centre).square()).sum() / n);
    }
    const double constant = std::lgamma((nu + 1) / 2) - std::lgamma(nu / 2) - 0.5 * std::log(nu * std::numbers::pi) -
                            std::log(scale);
    best = std::max(best, n * constant - (nu + 1) / 2 * (1 + ((y.array() - centre) / scale).square() / nu).log().sum());
  }
  return best;
}

/// The same, flatter than the normal: exp(-|u|^shape), the last all but uniform. Two populations fit these better than
/// the normal does.
double flat_population(const Eigen::VectorXd& y) {
  const double n = double(y.size()), s = std::sqrt((y.array() - y.mean()).square().sum() / n);
  if (!(s > 0)) return kInfinity;
  double best = -kInfinity;
  for (const double shape : {3.0, 6.0, 20.0}) {
    double low = y.minCoeff(), high = y.maxCoeff();
    Eigen::ArrayXd u;
    for (int pass = 0; pass < kPasses; ++pass) {  // to the centre of the least sum of powers
      const double centre = (low + high) / 2;
      u = (y.array() - centre) / s;
      ((u.sign() * u.abs().pow(shape - 1)).sum() > 0 ? low : high) = centre;
    }
    const double width = s * std::pow(shape * u.abs().pow(shape).mean(), 1 / shape);
    best = std::max(best, n * (std::log(shape / (2 * width)) - std::lgamma(1 / shape) - 1 / shape));
  }
  return best;
}

/// Rows that are rather of the second population, by their probabilities.
std::vector<char> likelier(const Eigen::ArrayXd& second) {
  std::vector<char> rows;
  for (const double p : second) rows.push_back(p > 0.5);
  return rows;
}

/// Two normal populations of one scatter, from a first division at each of some quantiles.
Mixture two_populations(const Eigen::VectorXd& y) {
  const Eigen::Index n = y.size();
  std::vector<double> sorted(y.data(), y.data() + n);
  std::ranges::sort(sorted);
  Mixture best;
  best.gain = -kInfinity;
  for (const double q : {0.2, 0.35, 0.5, 0.65, 0.8}) {
    const double cut = at_share(sorted, q);
    Eigen::ArrayXd second = (y.array() > cut).cast<double>();
    double share = 0, a = 0, b = 0, s = 1, sum = 0;
    for (int pass = 0; pass < kPasses; ++pass) {
      share = second.mean();
      if (!(share * double(n) >= 2 && (1 - share) * double(n) >= 2)) break;
      b = (second * y.array()).sum() / second.sum();
      a = ((1 - second) * y.array()).sum() / (1 - second).sum();
      s = std::sqrt((second * (y.array() - b).square() + (1 - second) * (y.array() - a).square()).mean());
      if (!(s > kRoundOff)) break;
      sum = 0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const double one = std::log(1 - share) + log_normal(y[i] - a, s),
                     two = std::log(share) + log_normal(y[i] - b, s);
        const double top = std::max(one, two), both = top + std::log(std::exp(one - top) + std::exp(two - top));
        second[i] = std::exp(two - both);
        sum += both;
      }
    }
    if (!(share * double(n) >= 2 && (1 - share) * double(n) >= 2 && s > kRoundOff) || sum <= best.gain) continue;
    best = {.gain = sum, .share = share, .apart = (b - a) / s, .deviation = s, .second = likelier(second)};
  }
  return best;
}

}  // namespace

std::optional<Mixture> mixture(const Eigen::MatrixXd& z) {
  const Eigen::Index m = z.cols();
  // What is far off is drawn in.
  const Eigen::MatrixXd bulk = z.unaryExpr([](double x) { return std::isnan(x) ? x : std::clamp(x, -12.0, 12.0); });
  const auto rows_with = [&](Eigen::Index first, Eigen::Index channels) {
    std::vector<int> rows;
    for (Eigen::Index i = 0; i < bulk.rows(); ++i)
      if (!bulk.row(i).segment(first, channels).hasNaN()) rows.push_back(int(i));
    return rows;
  };
  std::optional<Mixture> best;
  const auto look = [&](std::vector<int> rows, const Eigen::VectorXd& y) {
    Mixture two = two_populations(y);
    if (std::min(two.share, 1 - two.share) < kLeastShare || two.apart < kLeastApart) return;
    if (2 * (two.gain - flat_population(y)) < Rules{}.tie) return;
    two.gain = 2 * (two.gain - one_population(y));
    two.rows = std::move(rows);
    if (!best || two.gain > best->gain) best = std::move(two);
  };
  std::vector<int> complete = rows_with(0, m);
  if (std::ssize(complete) >= kFewestToPart) {  // along the principal direction of the bulk
    const Eigen::MatrixXd all = bulk(complete, Eigen::all), centred = all.rowwise() - all.colwise().mean();
    const Eigen::VectorXd y = all * dense::eigenpairs(centred.transpose() * centred).vectors.col(m - 1);
    look(std::move(complete), y);
  }
  for (Eigen::Index c = 0; c < m; ++c)
    if (std::vector<int> rows = rows_with(c, 1); std::ssize(rows) >= kFewestToPart) {
      const Eigen::VectorXd y = bulk(rows, c);
      look(std::move(rows), y);
    }
  return best;
}

double one_population(const Eigen::MatrixXd& z) {
  double sum = 0;
  for (const auto& column : z.colwise()) sum += one_population(Eigen::VectorXd(column));
  return sum;
}

std::optional<Mixture> mixture(const Eigen::MatrixXd& first, const Residuals& second, const Eigen::VectorXd& start,
                               const Eigen::VectorXd& low, const Eigen::VectorXd& high, double one) {
  constexpr double untold_share = 1.0 / 7;
  constexpr int passes = 15;
  const Eigen::Index n = first.rows(), m = first.cols(), size = start.size();
  if (n < kFewestToPart) return {};
  Eigen::VectorXd p = start;
  Eigen::MatrixXd z, moved;
  if (!second(p, z)) return {};
  // A row is of the second population where it lies nearer to it.
  Eigen::ArrayXd in = (z.rowwise().squaredNorm().array() < first.rowwise().squaredNorm().array()).cast<double>();
  Eigen::ArrayXd scatter = Eigen::ArrayXd::Ones(m);
  Mixture out;
  double log_likelihood = 0;
  for (int pass = 0; pass < passes; ++pass) {
    out.share = in.mean();
    if (std::min(out.share, 1 - out.share) < kLeastShare) return {};
    // Its size by one Gauss-Newton step on the rows that are in it.
    std::vector<Eigen::MatrixXd> slope;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    for (Eigen::Index k = 0; k < size; ++k) {
      Eigen::VectorXd there = p;
      there[k] += there[k] + kCoarseStep > high[k] ? -kCoarseStep : kCoarseStep;
      if (!second(there, moved)) return {};
      slope.push_back((moved - z) / (there[k] - p[k]));
    }
    const auto weighted = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
      return (((a.array() * b.array()).colwise() * in).colwise().sum().transpose() / scatter.square()).sum();
    };
    for (Eigen::Index k = 0; k < size; ++k) {
      gradient[k] = weighted(slope[k], z);
      for (Eigen::Index l = 0; l < size; ++l) normal(k, l) = weighted(slope[k], slope[l]);
    }
    normal.diagonal() *= 1 + 1e-9;
    p = (p - dense::Ldlt(normal).solve(gradient)).cwiseMax(low).cwiseMin(high);
    if (!p.allFinite() || !second(p, z)) return {};
    scatter = (((z.array().square().colwise() * in) + (first.array().square().colwise() * (1 - in))).colwise().mean())
                  .sqrt()
                  .transpose();
    if (!(scatter.minCoeff() > kRoundOff)) return {};
    log_likelihood = -0.5 * double(n * m) * std::log(2 * std::numbers::pi) - double(n) * scatter.log().sum();
    const auto distance = [&](const Eigen::MatrixXd& a) -> Eigen::ArrayXd {
      return (a.array().rowwise() / scatter.transpose()).square().rowwise().sum();
    };
    const Eigen::ArrayXd a = std::log(1 - out.share) - 0.5 * distance(first),
                         b = std::log(out.share) - 0.5 * distance(z);
    const Eigen::ArrayXd top = a.max(b), both = top + ((a - top).exp() + (b - top).exp()).log();
    in = (b - both).exp();
    log_likelihood += both.sum();
  }
  if (double((in > kTold && in < 1 - kTold).count()) > untold_share * double(n)) return {};
  const Eigen::MatrixXd apart = (z - first).array().rowwise() / scatter.transpose();
  out.apart = std::sqrt(apart.squaredNorm() / double(n));
  if (out.apart < kLeastApart) return {};
  out.deviation = std::sqrt(scatter.square().mean());
  out.gain = 2 * (log_likelihood - one) - Rules{}.parameter_cost * double(size);
  out.rows.resize(std::size_t(n));
  std::iota(out.rows.begin(), out.rows.end(), 0);
  out.second = likelier(in);
  return out;
}

}  // namespace hosel::loop
