/// The curved club face: xc = -(yc^2 / (2 bulge) + zc^2 / (2 roll)) in the face frame.
#pragma once

#include <limits>

#include "golf/vector.hpp"

namespace hosel {

struct Face {
  double bulge = std::numeric_limits<double>::infinity();  ///< heel-toe radius [m], inf = flat
  double roll = std::numeric_limits<double>::infinity();   ///< up-down radius [m], inf = flat

  /// Height of the surface over the face plane at (yc, zc) [m]; zero or negative.
  double height(double yc, double zc) const { return -(yc * yc / (2 * bulge) + zc * zc / (2 * roll)); }
  /// The surface point above (yc, zc), face frame [m].
  Vec3 point(double yc, double zc) const { return {height(yc, zc), yc, zc}; }
  /// Unit outward normal there, face frame.
  Vec3 normal(double yc, double zc) const { return Vec3(1, yc / bulge, zc / roll).normalized(); }
};

}  // namespace hosel
