/// Volume of the intersection of the ball with the face, exact.
#pragma once

#include <cmath>

#include "golf/units.hpp"

namespace hosel::models {

/// Overlap of a ball of radius r with a convex spherical face of radius R = 1 / curvature (curvature
/// 0: a plane, the ball's side open), whose surfaces overlap by `depth` on the line of centres.
///   V = pi d^2 (12 r - 4 (1 + c r) d + c d^2) / (12 (1 + c (r - d))),  c = 1/R, d = depth,
/// which is the lens formula pi (r + R - a)^2 (a^2 + 2 a (r + R) - 3 (r - R)^2) / (12 a) for the
/// distance a = r + R - d of the centres, written so that R -> infinity loses no digits.
struct Overlap {
  double volume = 0;    ///< [m^3]
  double area = 0;      ///< dV/d(depth) [m^2]: the disc that the two spheres have in common
  double centroid = 0;  ///< distance of the overlap's centroid from the ball's centre [m]
};

/// depth <= 0: separate, all zero (the centroid is then the ball's radius, its limit).
/// depth >= 2 min(r, R): the smaller one lies inside the other; the volume is its own.
/// This stands up to depth 2 max(r, R), where the smaller one would leave on the far side.
/// Precondition: radius > 0, curvature >= 0.
inline Overlap overlap(double depth, double radius, double curvature) {
  const double r = radius, c = curvature, d = depth;
  Overlap o;
  o.centroid = r;
  if (!(d > 0)) return o;
  const double smaller = c * r > 1 ? 1 / c : r;
  if (d >= 2 * smaller) {  // contained
    o.volume = 4.0 / 3.0 * kPi * smaller * smaller * smaller;
    // The smaller body's centre: the ball's own, or that of the face's sphere at r + R - d.
    o.centroid = c * r > 1 ? r + smaller - d : 0;
    return o;
  }
  const double by_D = 1 / (1 + c * (r - d));  // R over the distance of the centres
  o.volume = kPi / 12 * d * d * (12 * r - 4 * (1 + c * r) * d + c * d * d) * by_D;
  o.area = kPi / 4 * d * (2 * r - d) * (2 - c * d) * (2 * (1 + c * r) - c * d) * by_D * by_D;
  // Two caps on the common disc at z0 from the ball's centre: the ball's beyond it, of height d - c eta,
  // and the face's before it, of height c eta.
  const double eta = d * (2 * r - d) / 2 * by_D;
  const double z0 = r - d + c * eta, beyond = (d - c * eta) * (r + z0);
  const double face_cap = kPi * (c * eta * eta - c * c * c * eta * eta * eta / 3);
  const double moment = kPi / 4 * beyond * beyond + (r - d) * face_cap +
                        kPi * (2 * c * c * eta * eta * eta / 3 - c * c * c * c * eta * eta * eta * eta / 4);
  o.centroid = moment / o.volume;
  return o;
}

/// V_0 (V / V_0)^exponent with V_0 = 1 cm^3, a drive's at a depth of 4 mm [m^3]. The volume grows like the depth
/// squared, so that an exponent of 3/4 gives Hertz's power of the depth.
inline double powered(double volume, double exponent) {
  constexpr double kReference = 1e-6;
  return exponent == 1 || !(volume > 0) ? volume : kReference * std::pow(volume / kReference, exponent);
}

/// Integral of powered(volume) over the depth from 0 [m^4]: the potential of a force k V is k times it.
double overlap_potential(double depth, double radius, double curvature, double exponent = 1);

}  // namespace hosel::models
