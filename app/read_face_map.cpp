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

std::vector<post::Claim> read_statements(Table root, const std::vector<std::string>& figures) {
  std::vector<post::Claim> out;
  for (Table t : root.tables("statements")) {
    post::Claim claim{t.text({"text", "a published statement that the maps may bear out or not"}), {}};
    for (const std::string& where :
         t.texts({"where", "comparisons of the maps' figures that bear the statement out"})) {
      try {
        claim.where.emplace_back(where, figures);
      } catch (const std::invalid_argument& e) { t.fail("where", e.what()); }
    }
    if (claim.where.empty()) t.fail("where", "name at least one comparison that bears the statement out");
    out.push_back(std::move(claim));
  }
  return out;
}

}  // namespace hosel::app
