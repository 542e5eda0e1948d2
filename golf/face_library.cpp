#include "golf/face_library.hpp"

#include <algorithm>
#include <array>

namespace hosel {
namespace {

const std::array kFaces = {
#include "library/faces.inc"  // written by cmake/HoselLibrary.cmake
};

}  // namespace

const NamedFace* find_face(std::string_view name) {
  const auto it = std::ranges::find(kFaces, name, &NamedFace::name);
  return it == kFaces.end() ? nullptr : &*it;
}

}  // namespace hosel
