/// What kinds that map the face read alike.
#pragma once

#include "app/reader.hpp"
#include "post/face_map.hpp"

namespace hosel::app {

/// `[grid]`; the published 75 x 37.5 mm with 15 x 9 points where it is absent.
post::FaceGrid read_face_grid(Table root);

}  // namespace hosel::app
