/// Volume of the intersection of the ball with the face, exact.
#pragma once

#include <cmath>

#include "golf/lanes.hpp"
#include "golf/units.hpp"

namespace hosel::models {

/// Overlap of a ball of radius r with a convex spherical face of radius R = 1 / curvature (curvature
/// 0: a plane, the ball's side open), whose surfaces overlap by `depth` on the line of centres.
///   V = pi d^2 (12 r - 4 (1 + c r) d + c d^2) / (12 (1 + c (r - d))),  c = 1/R, d = depth,
/// which is the lens formula pi (r + R - a)^2 (a^2 + 2 a (r + R) - 3 (r - R)^2) / (12 a) for the
/// distance a = r + R - d of the centres, written so that R -> infinity loses no digits.
template <class T>
struct OverlapOf {
  T volume = 0;    ///< [m^3]
  T area = 0;      ///< dV/d(depth) [m^2]: the disc that the two spheres have in common
  T centroid = 0;  ///< distance of the overlap's centroid from the ball's centre [m]
};
using Overlap = OverlapOf<double>;

/// Of a number, or of several side by side (golf/lanes.hpp).
/// depth <= 0: separate, all zero (the centroid is then the ball's radius, its limit).
/// depth >= 2 min(r, R): the smaller one lies inside the other; the volume is its own.
/// This stands up to depth 2 max(r, R), where the smaller one would leave on the far side.
/// Precondition: radius > 0, curvature >= 0.
template <class T>
OverlapOf<T> overlap(const T& depth, const T& radius, const T& curvature) {
  const T r = radius, c = curvature;
  const auto touching = depth > 0;
  const T d = select(touching, depth, T(0));
  OverlapOf<T> o;
  const T by_D = 1 / (1 + c * (r - d));  // R over the distance of the centres
  o.volume = kPi / 12 * d * d * (12 * r - 4 * (1 + c * r) * d + c * d * d) * by_D;
  o.area = kPi / 4 * d * (2 * r - d) * (2 - c * d) * (2 * (1 + c * r) - c * d) * by_D * by_D;
  // Two caps on the common disc at z0 from the ball's centre: the ball's beyond it, of height d - c eta,
  // and the face's before it, of height c eta.
  const T eta = d * (2 * r - d) / 2 * by_D;
  const T z0 = r - d + c * eta, beyond = (d - c * eta) * (r + z0);
  const T face_cap = kPi * (c * eta * eta - c * c * c * eta * eta * eta / 3);
  const T moment = kPi / 4 * beyond * beyond + (r - d) * face_cap +
                   kPi * (2 * c * c * eta * eta * eta / 3 - c * c * c * c * eta * eta * eta * eta / 4);
  o.centroid = select(touching, moment / o.volume, r);
  if (const auto rounder = c * r > 1, contained = d >= 2 * select(rounder, 1 / c, r); any(contained)) {
    const T smaller = select(rounder, 1 / c, r);
    replace(contained, o.volume, 4.0 / 3.0 * kPi * smaller * smaller * smaller);
    replace(contained, o.area, T(0));
    // The smaller body's centre: the ball's own, or that of the face's sphere at r + R - d.
    replace(contained, o.centroid, select(rounder, r + smaller - d, T(0)));
  }
  return o;
}

/// V_0 (V / V_0)^exponent with V_0 = 1 cm^3, a drive's at a depth of 4 mm [m^3]. The volume grows like the depth
/// squared, so that an exponent of 3/4 gives Hertz's power of the depth.
template <class T>
T powered(const T& volume, double exponent) {
  constexpr double kReference = 1e-6;
  if (exponent == 1) return volume;
  using std::pow;
  const T share = volume / kReference, power = pow(select(share > 0, share, T(1)), exponent);
  return select(share > 0, kReference * power, volume);
}

/// Integral of powered(volume) over the depth from 0 [m^4]: the potential of a force k V is k times it.
double overlap_potential(double depth, double radius, double curvature, double exponent = 1);

}  // namespace hosel::models
