/// Seeded draws that are the same with every standard library: the generator's own bits, no distributions.
#pragma once

#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace hosel::solvers {

/// In [0, 1).
inline double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1.0p-53; }

/// 0 ... n - 1 in random order (Fisher and Yates).
inline std::vector<std::size_t> shuffled(std::size_t n, std::mt19937_64& random) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t(0));
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

/// One value in each of n equal strata of [low, high], in random order: a column of a Latin hypercube (McKay, Beckman
/// and Conover 1979).
inline std::vector<double> latin_column(double low, double high, std::size_t n, std::mt19937_64& random) {
  std::vector<double> out;
  for (const std::size_t stratum : shuffled(n, random))
    out.push_back(low + (high - low) * (double(stratum) + uniform(random)) / double(n));
  return out;
}

}  // namespace hosel::solvers
