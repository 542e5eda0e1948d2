/// Club faces by name.
#pragma once

#include <span>
#include <string_view>

#include "hosel/golf/face_compliance.hpp"

namespace hosel {

struct NamedFace {
  std::string_view name;
  std::string_view what;  ///< one sentence for `hosel list`, with where the numbers come from
  FaceCompliance face;
};
/// Found by `calibrate-face` from characteristic time and restitution, the effective mass from the plate's size:
/// a clamped elliptical plate moves with a fifth of its mass.
std::span<const NamedFace> face_library();
/// nullptr where no face has this name.
const NamedFace* find_face(std::string_view name);

}  // namespace hosel
