#include "hosel/loop/shots/mixture.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hosel::loop {
namespace {

constexpr double kLeastShare = 0.125, kLeastApart = 2.4;

double log_normal(double u, double s) {
  return -0.5 * u * u / (s * s) - std::log(s) - 0.5 * std::log(2 * std::numbers::pi);
}

/// Largest log-likelihood of one population: normal, or Student of some degrees of freedom.
double one_population(const Eigen::VectorXd& y) {
  const double n = double(y.size()), mean = y.mean(), s = std::sqrt((y.array() - mean).square().sum() / n);
  if (!(s > 0)) return std::numeric_limits<double>::infinity();
  double best = -n * (std::log(s) + 0.5 * std::log(2 * std::numbers::pi) + 0.5);
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

/// Two normal populations of one scatter, from a first division at each of some quantiles.
Mixture two_populations(const Eigen::VectorXd& y) {
  const Eigen::Index n = y.size();
  std::vector<double> sorted(y.data(), y.data() + n);
  std::ranges::sort(sorted);
  Mixture best;
  best.gain = -std::numeric_limits<double>::infinity();
  for (const double q : {0.2, 0.35, 0.5, 0.65, 0.8}) {
    const double cut = sorted[std::size_t(q * double(n - 1))];
    Eigen::ArrayXd second = (y.array() > cut).cast<double>();
    double share = 0, a = 0, b = 0, s = 1, sum = 0;
    for (int pass = 0; pass < 40; ++pass) {
      share = second.mean();
      if (!(share * double(n) >= 2 && (1 - share) * double(n) >= 2)) break;
      b = (second * y.array()).sum() / second.sum();
      a = ((1 - second) * y.array()).sum() / (1 - second).sum();
      s = std::sqrt((second * (y.array() - b).square() + (1 - second) * (y.array() - a).square()).mean());
      if (!(s > 1e-9)) break;
      sum = 0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const double one = std::log(1 - share) + log_normal(y[i] - a, s),
                     two = std::log(share) + log_normal(y[i] - b, s);
        const double top = std::max(one, two), both = top + std::log(std::exp(one - top) + std::exp(two - top));
        second[i] = std::exp(two - both);
        sum += both;
      }
    }
    if (!(share * double(n) >= 2 && (1 - share) * double(n) >= 2 && s > 1e-9) || sum <= best.gain) continue;
    best = {.gain = sum, .share = share, .apart = (b - a) / s, .deviation = s, .second = {}};
    for (const double p : second) best.second.push_back(p > 0.5);
  }
  return best;
}

}  // namespace

std::optional<Mixture> mixture(const Eigen::MatrixXd& z) {
  const Eigen::Index n = z.rows(), m = z.cols();
  if (n < 16) return {};
  // The principal direction of the bulk: what is far off is drawn in.
  const Eigen::MatrixXd bulk = z.cwiseMax(-12.0).cwiseMin(12.0);
  const Eigen::MatrixXd centred = bulk.rowwise() - bulk.colwise().mean();
  std::vector<Eigen::VectorXd> directions{
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(centred.transpose() * centred).eigenvectors().col(m - 1)};
  for (Eigen::Index c = 0; c < m; ++c) directions.push_back(Eigen::VectorXd::Unit(m, c));
  std::optional<Mixture> best;
  for (const Eigen::VectorXd& d : directions) {
    const Eigen::VectorXd y = bulk * d;
    Mixture two = two_populations(y);
    if (std::min(two.share, 1 - two.share) < kLeastShare || two.apart < kLeastApart) continue;
    two.gain = 2 * (two.gain - one_population(y));
    if (!best || two.gain > best->gain) best = std::move(two);
  }
  return best;
}

}  // namespace hosel::loop
