#include "app/read_face.hpp"

#include "app/library.hpp"

namespace hosel::app {

FaceCompliance read_compliance(Table table, const std::optional<FaceCompliance>& named) {
  FaceCompliance face;
  table.decided_by("face.name");
  face.mass = table.quantity({"effective_mass", "of the face's mode, at its centre; part of the head's mass"}, "g",
                             {1e-4, 0.1}, standard_of(named, &FaceCompliance::mass));
  face.stiffness = table.quantity({"stiffness", "at the centre of the face"}, "N_per_m", {1e5, 1e12},
                                  standard_of(named, &FaceCompliance::stiffness));
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

std::optional<FaceCompliance> read_face(Table table) {
  if (!table.has("name")) return read_compliance(table, {});
  const std::string name = *named_entry(table, "name", Shelf::faces);
  if (name == kRigidFace) return {};
  return read_compliance(table, library_face(name).face);
}

std::optional<FaceCompliance> read_club_face(Table root) {
  auto own = root.optional_table("face");
  if (own && own->has("plate")) return {};
  if (own && own->has("name")) return read_face(*own);
  // The head's own is echoed as if the case had named it; single keys of [face] replace its values.
  if (auto head = root.optional_table("head"); head && head->has("name"))
    if (const std::string face = library_head(*named_entry(*head, "name", Shelf::heads)).face; !face.empty()) {
      Table t = root.default_table("face");
      t.decided_by("head.name");
      t.text({"name", "a face of the library (`hosel list`)"}, face);
      return read_compliance(t, library_face(face).face);
    }
  if (own) return read_face(*own);
  return {};
}

post::FaceGrid read_face_grid(Table root) {
  post::FaceGrid g;
  if (auto t = root.optional_table("grid")) {
    g.width = t->quantity({"width", "of the grid, heel to toe"}, "mm", {1e-3, 0.2}, g.width);
    g.height = t->quantity({"height", "of the grid, up the face"}, "mm", {1e-3, 0.2}, g.height);
    g.columns = int(t->integer({"columns", "points of the grid, heel to toe"}, 3, 1001, g.columns));
    g.rows = int(t->integer({"rows", "points of the grid, up the face"}, 3, 1001, g.rows));
  }
  return g;
}

bool has_plate(Table root) {
  const auto own = root.optional_table("face");
  return own && own->has("plate");
}

}  // namespace hosel::app
