/// How the values of a parameter are spread.
#pragma once

#include <boost/math/distributions/normal.hpp>
#include <random>
#include <vector>

#include "solvers/random.hpp"

namespace hosel::solvers {

struct Distribution {
  enum class Kind { uniform, normal };
  Kind kind = Kind::uniform;
  double low = 0, high = 1;  ///< uniform: its ends
  double mean = 0, sd = 1;   ///< normal

  /// The value below which a share of all lies. A uniform one ends at its ends; of a normal one share 0 and 1 are
  /// infinite and must not be asked.
  double quantile(double share) const {
    if (kind == Kind::uniform) return low + (high - low) * share;
    return boost::math::quantile(boost::math::normal(mean, sd), share);
  }
};

/// `n` values: one in each of as many strata that are equally likely (a column of a Latin hypercube, in random order),
/// or each without regard to the others.
inline std::vector<double> drawn(const Distribution& of, std::size_t n, bool latin, std::mt19937_64& random) {
  if (of.kind == Distribution::Kind::uniform && latin) return latin_column(of.low, of.high, n, random);
  std::vector<double> out;
  if (latin) out = latin_column(0, 1, n, random);
  else
    for (std::size_t i = 0; i < n; ++i) out.push_back(uniform(random));
  for (double& x : out) x = of.quantile(x);
  return out;
}

}  // namespace hosel::solvers
