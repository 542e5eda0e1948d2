#include "fem/friction/slip_weakening.hpp"

#include <cmath>

namespace hosel::fem {

namespace {

/// A mean of e^-x' from zero to x, and its derivative by x; by their series where the closed form loses digits.
struct Mean {
  double value = 0, slope = 0;
};
Mean even(double x) {
  if (x < 1e-4) return {1 - x / 2 + x * x / 6, -0.5 + x / 3 - x * x / 8};
  const double value = -std::expm1(-x) / x;
  return {value, (std::exp(-x) - value) / x};
}
/// Weighted with x', as a pressure that grows from zero weights it.
Mean rising(double x) {
  if (x < 1e-2)
    return {1 - x * (2.0 / 3 - x * (0.25 - x * (1.0 / 15 - x / 72))), -2.0 / 3 + x * (0.5 - x * (0.2 - x / 18))};
  const double e = std::exp(-x), value = 2 * (-std::expm1(-x) - x * e) / (x * x);
  return {value, 2 * (e - value) / x};
}

}  // namespace

Friction SlipWeakening::at(const Slip& slip, bool derivatives) const {
  const double more = (rest_.coefficient - sliding_) * std::exp(-slip.path / rest_.distance), first = sliding_ + more,
               size = slip.stretch.norm(), beyond = size - first * slip.pressure / stiffness_;
  if (!(beyond > 0)) return Coulomb(first, stiffness_).at(slip, derivatives);
  // A point that has come without a stretch came without a pressure.
  const bool fresh = slip.step == slip.stretch;
  const double x = beyond / rest_.distance;
  const Mean left = fresh ? rising(x) : even(x);
  Friction out = Coulomb(sliding_ + more * left.value, stiffness_).at(slip, derivatives);
  if (!derivatives) return out;
  const Vec3 d = slip.stretch / size;
  const double by_beyond = slip.pressure * more * left.slope / rest_.distance;
  out.by_pressure -= by_beyond * first / stiffness_ * d;
  out.by_stretch += by_beyond * d * d.transpose();
  return out;
}

std::vector<std::string> SlipWeakening::faults() const {
  std::vector<std::string> out = Coulomb(sliding_, stiffness_).faults();
  if (!(rest_.coefficient >= sliding_) || !std::isfinite(rest_.coefficient))
    out.emplace_back("contact: static friction must be finite and at least that of sliding");
  if (!(rest_.distance > 0)) out.emplace_back("contact: the slip over which static friction falls must be positive");
  return out;
}

}  // namespace hosel::fem
