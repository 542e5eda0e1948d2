#include "models/reduced/volume.hpp"

#include <algorithm>
#include <array>

#include "golf/units.hpp"

namespace hosel::models {

double overlap_potential(double depth, double radius, double curvature, double exponent) {
  if (!(depth > 0)) return 0;
  const double smaller = curvature * radius > 1 ? 1 / curvature : radius;
  const double lens = std::min(depth, 2 * smaller);
  // Ten-point Gauss rule on four parts: the integrand is a quotient of low-order polynomials, or a power of it.
  static constexpr std::array<double, 5> at = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                               0.8650633666889845, 0.9739065285171717};
  static constexpr std::array<double, 5> weight = {0.2955242247147529, 0.2692667193099963, 0.2190863625159820,
                                                   0.1494513491505806, 0.0666713443086881};
  double sum = 0;
  const int parts = 4;
  const double half = lens / (2 * parts);
  for (int k = 0; k < parts; ++k) {
    const double middle = (2 * k + 1) * half;
    for (int i = 0; i < 5; ++i)
      sum += half * weight[i] *
             (powered(overlap(middle - half * at[i], radius, curvature).volume, exponent) +
              powered(overlap(middle + half * at[i], radius, curvature).volume, exponent));
  }
  return sum + (depth - lens) * powered(4.0 / 3.0 * kPi * smaller * smaller * smaller, exponent);
}

}  // namespace hosel::models
