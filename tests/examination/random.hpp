#pragma once
// Random numbers that are the same on every machine: mt19937_64 is fixed by the standard, its
// distributions are not, so these are written out.

#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>

namespace examination {

/// Mixes a word into a seed (splitmix64, Steele et al. 2014), so that neighbouring sets share nothing.
inline std::uint64_t mix(std::uint64_t seed, std::uint64_t word) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15ULL + word + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

inline std::uint64_t mix(std::uint64_t seed, std::string_view text) {
  for (const char c : text) seed = mix(seed, static_cast<unsigned char>(c));
  return seed;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [low, high).
  double uniform(double low = 0, double high = 1) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  /// Uniform among 0 .. count-1.
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  bool chance(double p) { return uniform() < p; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

  /// Standard normal (Box-Muller).
  double normal() {
    const double u = 1.0 - uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * uniform());
  }
  /// Normal, redrawn until within `limit` standard deviations: a golfer's spread has no far tails.
  double bounded_normal(double limit = 2.5) {
    for (;;)
      if (const double z = normal(); std::abs(z) <= limit) return z;
  }
  /// Student's t with 3 degrees of freedom, scaled to unit variance.
  double heavy() {
    const double z = normal(), a = normal(), b = normal(), c = normal();
    return z / std::sqrt(a * a + b * b + c * c);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace examination
