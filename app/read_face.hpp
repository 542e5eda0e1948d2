/// `[face]`: what of a club face yields.
#pragma once

#include "hosel/app/reader.hpp"
#include "hosel/golf/face_compliance.hpp"

namespace hosel::app {

/// A `name` of the library, single values of it replaced; without a name mass and stiffness are required.
FaceCompliance read_face(Table table);

}  // namespace hosel::app
