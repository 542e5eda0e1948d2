/// Ranges, medians and robust standard deviations.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace hosel::loop {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Relative, or in the unit at hand where nothing is that small: what differs by less is the same.
inline constexpr double kRoundOff = 1e-9;
/// Of the number at hand, or in its unit: what arithmetic alone leaves of it.
inline constexpr double kLastBits = 1e-12;
/// Of the largest, or in noise units: what is fainter is the round-off of what made it.
inline constexpr double kFaint = 1e-6;
/// Of a size, or in noise units: so little of it is as good as nothing.
inline constexpr double kNothing = 1e-3;
/// Of a whole: so much of it is nearly all.
inline constexpr double kNearlyAll = 0.8;
/// Robust deviations: farther off is one reading in some 10^10 of a normal scatter.
inline constexpr double kFar = 7;
/// Robust deviations beyond which a value must not count as it stands.
inline constexpr double kFence = 4;
/// In place of zero where a number is divided by or its logarithm taken.
inline constexpr double kTiny = 1e-300;

/// Least and largest of what `of` gives of each, NaN left out; infinite, the least above the largest, of none.
template <class Of>
std::pair<double, double> range_of(const auto& all, const Of& of) {
  double low = kInfinity, high = -low;
  for (const auto& x : all) {
    const double value = of(x);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return {low, high};
}

/// The value of a share of some that rise.
inline double at_share(const std::vector<double>& rising, double share) {
  return rising[std::size_t(share * double(rising.size() - 1))];
}

/// Whether so wide a range about a middle is more than round-off; false for infinite ones too.
inline bool varies(double width, double middle) { return width > kRoundOff * (1 + std::abs(middle)); }

/// Minus the logarithm of the standard normal density at zero.
inline const double kLogRootTwoPi = std::log(2 * std::numbers::pi) / 2;

/// Places of `n` things by rising `of` a place; equals in their order.
template <class Index = int>
std::vector<Index> rising_order(std::size_t n, const auto& of) {
  std::vector<Index> places(n);
  std::iota(places.begin(), places.end(), Index(0));
  std::ranges::stable_sort(places, {}, of);
  return places;
}

/// The mean of the two middle values where their number is even; 0 of none.
inline double median(std::vector<double> x) {
  if (x.empty()) return 0;
  const auto mid = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), mid, x.end());
  return x.size() % 2 == 1 ? *mid : std::midpoint(*std::max_element(x.begin(), mid), *mid);
}

/// The standard deviation of normal values whose distances from their middle these are.
inline double robust_deviation(std::vector<double> distances) {
  constexpr double of_median = 1.4826;
  return of_median * median(std::move(distances));
}

/// The median, and the standard deviation by the distances from it.
inline std::pair<double, double> robust_moments(const std::vector<double>& x) {
  const double middle = median(x);
  std::vector<double> off;
  for (const double v : x) off.push_back(std::abs(v - middle));
  return {middle, robust_deviation(std::move(off))};
}

/// Of what rounding to steps of this size adds: a uniform distribution's.
inline double rounding_deviation(double step) {
  constexpr double variance_of_unit = 1.0 / 12;
  return step * std::sqrt(variance_of_unit);
}

}  // namespace hosel::loop
