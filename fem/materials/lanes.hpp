/// Several points at once: arithmetic on four numbers in vector registers.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace hosel::fem {

inline constexpr int kLanes = 4;
/// One number of each of `kLanes` points. Operators work lane by lane (an extension of GCC and Clang).
using Lanes = double __attribute__((vector_size(8 * kLanes)));
using SymLanes = std::array<Lanes, 6>;   ///< symmetric tensors, in the order of Sym
using Mat3Lanes = std::array<Lanes, 9>;  ///< component (i, I) at i + 3 I

inline void load(Lanes& to, const double* from) { std::memcpy(&to, from, sizeof to); }
inline void store(double* to, const Lanes& from) { std::memcpy(to, &from, sizeof from); }

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
