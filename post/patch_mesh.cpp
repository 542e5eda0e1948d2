#include "post/patch_mesh.hpp"

namespace hosel::post {

VtkMesh patch_mesh(const std::vector<fem::ContactPoint>& points) {
  VtkMesh out;
  std::vector<Vec3> moved, traction;
  VtkField pressure{"contact_pressure", "Pa", 1, {}}, slip{"slip", "m", 1, {}}, sliding{"sliding", "", 1, {}};
  for (const fem::ContactPoint& p : points) {
    out.cells.push_back({CellShape::vertex, {static_cast<std::int64_t>(out.points.size())}});
    out.points.push_back(p.reference);
    moved.push_back(p.position - p.reference);
    traction.push_back(p.traction);
    pressure.values.push_back(p.pressure);
    slip.values.push_back(p.slip);
    sliding.values.push_back(p.sliding ? 1 : 0);
  }
  out.point_fields = {vector_field("displacement", "m", moved), vector_field("contact_traction", "Pa", traction),
                      std::move(pressure), std::move(slip), std::move(sliding)};
  return out;
}

}  // namespace hosel::post
