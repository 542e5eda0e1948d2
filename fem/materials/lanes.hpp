/// Several points of a material at once.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "golf/lanes.hpp"

namespace hosel::fem {

using SymLanes = std::array<Lanes, 6>;   ///< symmetric tensors, in the order of Sym
using Mat3Lanes = std::array<Lanes, 9>;  ///< component (i, I) at i + 3 I

inline double inverse_cbrt(double x) { return 1 / std::cbrt(x); }
/// x^(-1/3) for x > 0, to a unit in the last place: a third of the exponent, then three steps of fourth order.
inline void inverse_cbrt(const Lanes& x, Lanes& out) {
  for (int l = 0; l < kLanes; ++l)
    out[l] = std::bit_cast<double>(0x553ef0ff289dd796 - std::bit_cast<std::uint64_t>(x[l]) / 3);  // within 4 %
  for (int step = 0; step < 3; ++step) {
    const Lanes r = 1.0 - x * out * out * out;
    out += out * r * (1.0 / 3 + r * (2.0 / 9 + r * (14.0 / 81)));
  }
}
inline void inverse_cbrt(double x, double& out) { out = inverse_cbrt(x); }

}  // namespace hosel::fem
