/// Middles and standard deviations that a few bad values do not move.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace hosel::loop {

/// The upper of the two middle values where their number is even; 0 of none.
inline double median(std::vector<double> x) {
  if (x.empty()) return 0;
  const auto mid = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), mid, x.end());
  return *mid;
}

/// The standard deviation of normal values whose distances from their middle these are.
inline double robust_deviation(std::vector<double> distances) {
  constexpr double of_median = 1.4826;
  return of_median * median(std::move(distances));
}

/// Of what rounding to steps of this size adds: a uniform distribution's.
inline double rounding_deviation(double step) {
  constexpr double variance_of_unit = 1.0 / 12;
  return step * std::sqrt(variance_of_unit);
}

}  // namespace hosel::loop
