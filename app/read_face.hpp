/// `[face]`: what of a club face yields.
#pragma once

#include <optional>

#include "app/reader.hpp"
#include "golf/face_compliance.hpp"
#include "post/face_map.hpp"

namespace hosel::app {

/// Values of a face, single ones of `named` replaced; without one mass and stiffness are required.
FaceCompliance read_compliance(Table table, const std::optional<FaceCompliance>& named);
/// A `name` of the library, single values of it replaced; nothing where the name is "rigid".
std::optional<FaceCompliance> read_face(Table table);
/// `[face]` of a case, else that of the head that `[head] name` names; nothing where neither yields,
/// or where it is a plate.
std::optional<FaceCompliance> read_club_face(Table root);
/// `[grid]` of places on the face; the published 75 x 37.5 mm with 15 x 9 points where it is absent.
post::FaceGrid read_face_grid(Table root);
/// Whether `[face]` of a case is a plate.
bool has_plate(Table root);

}  // namespace hosel::app
