#include "app/read_face_map.hpp"

namespace hosel::app {

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

}  // namespace hosel::app
