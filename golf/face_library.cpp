#include "hosel/golf/face_library.hpp"

#include <algorithm>
#include <array>

namespace hosel {
namespace {

constexpr std::array kFaces = {
    NamedFace{"modern-driver",
              "titanium at the rules' limit: 257 us and 0.830, 48.77 m/s on a head of 0.200 kg",
              {.mass = 10e-3, .stiffness = 5.37e6, .damping = 17, .half_width = 0.050, .half_height = 0.028}},
    NamedFace{"early-titanium",
              "thicker titanium, assumed at 205 us: as stiff as a face under the rules' line at 0.807",
              {.mass = 11e-3, .stiffness = 8.45e6, .damping = 15, .half_width = 0.042, .half_height = 0.024}},
    NamedFace{"steel-iron",
              "cast steel iron, assumed at 130 us: hardly more restitution than a rigid face",
              {.mass = 15e-3, .stiffness = 21e6, .damping = 28, .half_width = 0.035, .half_height = 0.022}},
};

}  // namespace

std::span<const NamedFace> face_library() { return kFaces; }

const NamedFace* find_face(std::string_view name) {
  const auto it = std::ranges::find(kFaces, name, &NamedFace::name);
  return it == kFaces.end() ? nullptr : &*it;
}

}  // namespace hosel
