#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hosel::loop {

/// The upper of the two middle values where their number is even; 0 of none.
inline double median(std::vector<double> x) {
  if (x.empty()) return 0;
  const auto mid = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), mid, x.end());
  return *mid;
}

}  // namespace hosel::loop
