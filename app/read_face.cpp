#include "hosel/app/read_face.hpp"

#include "hosel/golf/face_library.hpp"

namespace hosel::app {

FaceCompliance read_face(Table table) {
  std::optional<FaceCompliance> named;
  if (table.has("name")) {
    std::vector<std::string> names;
    for (const NamedFace& f : face_library()) names.emplace_back(f.name);
    named = find_face(table.choice({"name", "a face of the library (`hosel list`)"}, names))->face;
  }
  const auto standard = [&](double FaceCompliance::*value) {
    return named ? std::optional((*named).*value) : std::nullopt;
  };
  FaceCompliance face;
  face.mass = table.quantity({"effective_mass", "of the face's mode, at its centre; part of the head's mass"}, "g",
                             {1e-4, 0.1}, standard(&FaceCompliance::mass));
  face.stiffness = table.quantity({"stiffness", "at the centre of the face"}, "N_per_m", {1e5, 1e12},
                                  standard(&FaceCompliance::stiffness));
  face.damping =
      table.quantity({"damping", "at the centre of the face"}, "N_s_per_m", {0, 1e4}, named ? named->damping : 0.0);
  constexpr double kNoEnd = std::numeric_limits<double>::infinity();
  face.half_width =
      table.quantity({"half_width", "where the face no longer moves, heel to toe; inf: it moves alike everywhere"},
                     "mm", {0.005, kNoEnd}, named ? named->half_width : face.half_width);
  face.half_height = table.quantity({"half_height", "where the face no longer moves, up and down"}, "mm",
                                    {0.005, kNoEnd}, named ? named->half_height : face.half_height);
  return face;
}

}  // namespace hosel::app
