#include "solvers/sobol_indices.hpp"

#include <boost/random/sobol.hpp>
#include <limits>
#include <stdexcept>

namespace hosel::solvers {

SobolIndices sobol_indices(const std::function<double(const Eigen::VectorXd&)>& f, Eigen::Index inputs,
                           std::size_t points) {
  if (inputs < 1 || points < 1) throw std::invalid_argument("shares of variance need inputs and points");
  boost::random::sobol sequence(std::size_t(2 * inputs));
  sequence.discard(std::uintmax_t(2 * inputs));  // it begins with a corner
  const auto next = [&] {
    Eigen::VectorXd u(inputs);
    for (double& value : u)
      value = double(sequence()) / double(std::numeric_limits<boost::random::sobol::result_type>::max());
    return u;
  };
  const auto n = Eigen::Index(points);
  Eigen::ArrayXd a(n), b(n);
  Eigen::ArrayXXd mixed(n, inputs);  // of the first point with one input of the second
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd first = next(), second = next();
    a[k] = f(first);
    b[k] = f(second);
    for (Eigen::Index i = 0; i < inputs; ++i) {
      Eigen::VectorXd between = first;
      between[i] = second[i];
      mixed(k, i) = f(between);
    }
  }
  const double mean = (a.mean() + b.mean()) / 2;
  const double variance = ((a - mean).square().mean() + (b - mean).square().mean()) / 2;
  SobolIndices out{Eigen::VectorXd::Zero(inputs), Eigen::VectorXd::Zero(inputs)};
  if (!(variance > 0)) return out;
  for (Eigen::Index i = 0; i < inputs; ++i) {
    out.first[i] = ((b - mean) * (mixed.col(i) - a)).mean() / variance;
    out.total[i] = (a - mixed.col(i)).square().mean() / 2 / variance;
  }
  return out;
}

}  // namespace hosel::solvers
