/// `[face.plate]`: a face with a thickness.
#pragma once

#include <optional>

#include "app/reader.hpp"
#include "models/fe/plate_face.hpp"

namespace hosel::app {

/// Outline, thickness, material, rim and mesh. Throws InputError; faults of a CSV with its name and line.
models::PlateDesign read_plate(Table table);
/// That of a case's `[face]`, if it has one.
std::optional<models::PlateDesign> read_optional_plate(Table root);

}  // namespace hosel::app
