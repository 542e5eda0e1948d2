#include "post/patch_mesh.hpp"

namespace hosel::post {

VtkMesh patch_mesh(const std::vector<fem::ContactPoint>& points, const fem::TractionField& field) {
  VtkMesh out;
  std::vector<Vec3> moved, traction, at_station;
  VtkField pressure{"contact_pressure", "Pa", 1, {}}, station_pressure{"station_pressure", "Pa", 1, {}},
      slip{"slip", "m", 1, {}}, sliding{"sliding", "", 1, {}};
  for (const fem::ContactPoint& p : points) {
    out.cells.push_back({CellShape::vertex, {static_cast<std::int64_t>(out.points.size())}});
    out.points.push_back(p.reference);
    moved.push_back(p.position - p.reference);
    const fem::TractionField::Value v = field.at(p.reference);
    traction.push_back(v.traction);
    pressure.values.push_back(v.pressure);
    at_station.push_back(p.traction);
    station_pressure.values.push_back(p.pressure);
    slip.values.push_back(p.slip);
    sliding.values.push_back(p.sliding ? 1 : 0);
  }
  out.point_fields = {vector_field("displacement", "m", moved),
                      vector_field("contact_traction", "Pa", traction),
                      std::move(pressure),
                      vector_field("station_traction", "Pa", at_station),
                      std::move(station_pressure),
                      std::move(slip),
                      std::move(sliding)};
  return out;
}

}  // namespace hosel::post
