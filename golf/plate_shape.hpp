/// How a clamped elliptical plate deflects, of a number and of several side by side.
#pragma once

#include "golf/lanes.hpp"

namespace hosel {

/// (1 - curvature_y y^2 - curvature_z z^2)^2 and zero outside the ellipse; the curvatures are one over the squared half
/// axes [1/m^2].
template <class T>
struct PlateShape {
  T height, value, slope_y, slope_z;  ///< root of the value; value; its derivatives by y and z

  PlateShape(const T& curvature_y, const T& curvature_z, const T& y, const T& z) {
    const T under = 1 - curvature_y * y * y - curvature_z * z * z;
    height = select(under > 0, under, T(0));
    value = height * height;
    slope_y = -4 * height * curvature_y * y;
    slope_z = -4 * height * curvature_z * z;
  }
};

}  // namespace hosel
