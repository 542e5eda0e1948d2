/// Which factor of a design moves a response most: first-order shares of its variance, with intervals.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace hosel::solvers {

/// What was varied: its value at every point, or the number of its level where levels have no order.
struct EffectFactor {
  std::vector<double> x;
  bool ordered = true;
};

struct MainEffect {
  double share = 0;                ///< of the response's variance, by this factor alone
  double low = 0, high = 0;        ///< 95 % interval of the share
  double at_low = 0, at_high = 0;  ///< response at the factor's lowest and highest value (ordered), else lowest and
                                   ///< highest response over its levels; the mean over the other factors
  std::optional<double> between;   ///< response where the fitted curve turns, where that is beyond both ends by a
                                   ///< quarter of their difference
};

struct MainEffects {
  std::vector<MainEffect> factors;  ///< as they were given
  std::vector<std::size_t> order;   ///< from the largest share to the smallest
  bool separable = true;            ///< the shares add up to what all factors explain, within a fifth of the variance,
                                    ///< and none is beyond one: those of factors that vary together do not
  bool first_is_certain = false;    ///< the 95 % interval of the first share minus the second lies above zero
  bool full_factorial = false;      ///< every combination of values equally often: shares and ends by level means
  double predicted = 0;             ///< share of the variance that the effects predict at points left out
};

/// Least squares of the response on a constant and, for each factor, Legendre polynomials of first and second degree
/// (first alone where it has two values, or where fewer than three points an unknown do not fill a grid), or one level
/// against the others. A share is the variance of the factor's fitted part over the design's points, over that of the
/// response: of independent factors, its first-order Sobol index (Sudret 2008). Intervals: jackknife over groups of
/// points left out (Efron and Stein 1981). Nothing where the response is the same everywhere or where fewer points than
/// unknowns plus two are there.
std::optional<MainEffects> main_effects(const std::vector<EffectFactor>& factors, const std::vector<double>& response);

}  // namespace hosel::solvers
