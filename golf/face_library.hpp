/// The shipped club faces by name, for the floors that read no files: library/faces of the tree.
#pragma once

#include <string_view>

#include "golf/face_compliance.hpp"

namespace hosel {

struct NamedFace {
  std::string_view name;
  FaceCompliance face;
};
/// nullptr where no shipped face has this name.
const NamedFace* find_face(std::string_view name);

}  // namespace hosel
