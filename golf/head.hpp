/// A rigid clubhead. All vectors and tensors in the face frame (Xc out of the face, Yc heel, Zc up).
#pragma once

#include <string>
#include <vector>

#include "golf/face.hpp"
#include "golf/vector.hpp"

namespace hosel {

struct Head {
  double mass = 0;              ///< [kg]
  Vec3 cg = Vec3::Zero();       ///< centre of gravity, from the face centre [m]
  Mat3 inertia = Mat3::Zero();  ///< about the cg [kg m^2]
  Face face;

  /// Sentences naming what no body can have (mass, symmetry, positive definiteness, triangle
  /// inequality of the principal moments); empty if all is well.
  std::vector<std::string> faults() const;
};

}  // namespace hosel
