/// A club face that yields: a lumped mass on a spring and a damper, which moves with a shape over the face.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "golf/vector.hpp"

namespace hosel {

/// The face has moved inwards by w shape(yc, zc), along -Xc. The shape is that of a clamped elliptical plate under
/// pressure, (1 - (yc / half_width)^2 - (zc / half_height)^2)^2, and zero outside the ellipse. The mass is part of the
/// head's and sits at the face centre.
struct FaceCompliance {
  double mass = 0;                ///< effective [kg]
  double stiffness = 0;           ///< at the centre [N/m]
  double damping = 0;             ///< [N s/m]
  double half_width = INFINITY;   ///< heel-toe, where the face no longer moves [m]; inf: the same everywhere
  double half_height = INFINITY;  ///< up-down [m]

  /// Value, first and second derivatives by yc and zc.
  struct Shape {
    double value = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  };
  Shape shape(double yc, double zc) const;

  /// Sentences naming what no face can have; empty if all is well.
  std::vector<std::string> faults() const;
};

}  // namespace hosel
