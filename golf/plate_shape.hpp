/// How a clamped elliptical plate deflects, of a number and of several side by side.
#pragma once

#include "golf/lanes.hpp"

namespace hosel {

/// (1 - yy y^2 - zz z^2 - 2 yz y z)^2 and zero outside the ellipse; without yz, which its turn makes, yy and zz are one
/// over the squared half axes [1/m^2].
template <class T>
struct PlateShape {
  T height, value, slope_y, slope_z;  ///< root of the value; value; its derivatives by y and z

  PlateShape(const T& yy, const T& zz, const T& yz, const T& y, const T& z) {
    const T under = 1 - yy * y * y - zz * z * z - 2 * yz * y * z;
    height = select(under > 0, under, T(0));
    value = height * height;
    slope_y = -4 * height * (yy * y + yz * z);
    slope_z = -4 * height * (zz * z + yz * y);
  }
};

}  // namespace hosel
