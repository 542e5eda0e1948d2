/// A club face that yields: a lumped mass on a spring and a damper, which moves with a shape over the face.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "golf/vector.hpp"

namespace hosel {

/// The face has moved inwards by w shape(yc, zc), along -Xc. The shape is that of a clamped elliptical plate under
/// pressure, (1 - (y / half_width)^2 - (z / half_height)^2)^2, and zero outside the ellipse; y and z are Yc and Zc
/// turned about Xc by `turn`. The mass is part of the head's and sits at the face centre.
struct FaceCompliance {
  double mass = 0;                ///< effective [kg]
  double stiffness = 0;           ///< at the centre [N/m]
  double damping = 0;             ///< [N s/m]
  double half_width = INFINITY;   ///< heel-toe, where the face no longer moves [m]; inf: the same everywhere
  double half_height = INFINITY;  ///< up-down [m]
  double turn = 0;                ///< of the ellipse about Xc, from Yc to Zc: a head described in turned axes [rad]

  /// Value, first and second derivatives by yc and zc.
  struct Shape {
    double value = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  };
  Shape shape(double yc, double zc) const;
  /// C of the ellipse x'C x = 1 in face axes [1/m^2].
  Eigen::Matrix2d ellipse() const;

  /// Sentences naming what no face can have; empty if all is well.
  std::vector<std::string> faults() const;
};

}  // namespace hosel
