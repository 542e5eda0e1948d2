/// A clubhead: rigid, or with a face that yields. All vectors and tensors in the face frame (Xc out of the face, Yc
/// heel, Zc up).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "golf/face.hpp"
#include "golf/face_compliance.hpp"
#include "golf/vector.hpp"

namespace hosel {

struct Head {
  double mass = 0;              ///< [kg]
  Vec3 cg = Vec3::Zero();       ///< centre of gravity, from the face centre [m]
  Mat3 inertia = Mat3::Zero();  ///< about the cg [kg m^2]
  Face face;
  std::optional<FaceCompliance> compliance = {};  ///< of the face; none: rigid. The rigid models know none

  /// Sentences naming what no body can have (mass, symmetry, positive definiteness, triangle
  /// inequality of the principal moments, the face); empty if all is well.
  std::vector<std::string> faults() const;
};

}  // namespace hosel
