// One number for a state of stress.
#pragma once

#include <cmath>

#include "fem/materials/symmetric.hpp"

namespace hosel::fem {

/// Von Mises' equivalent of a Cauchy stress, in the stress's unit (components as in Sym).
inline double von_mises(const Sym& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

}  // namespace hosel::fem
