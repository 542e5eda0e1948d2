/// Another coefficient of sliding on the patch of a deformable ball.
#pragma once

#include "golf/contact_law.hpp"

namespace hosel::models {

/// Static friction keeps its ratio to that of sliding.
inline void slide(PatchFriction& patch, double friction) {
  if (patch.at_rest)
    patch.at_rest->coefficient = patch.coefficient > 0 ? friction * (patch.at_rest->coefficient / patch.coefficient)
                                                       : friction;
  patch.coefficient = friction;
}

}  // namespace hosel::models
