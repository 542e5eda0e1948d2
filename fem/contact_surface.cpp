#include "fem/contact_surface.hpp"

#include <stdexcept>

namespace hosel::fem {

double ContactSurface::travel(const Vec3& place, const SurfaceUnknowns& unknowns) const {
  return travel_at(place, unknowns).value;
}

Travel ContactSurface::travel_at(const Vec3&, const SurfaceUnknowns&) const {
  throw std::logic_error("contact: a surface with unknowns states how far they move it");
}

SurfacePose pose(const SurfaceCarrier& carrier, const State& s) {
  SurfacePose p{carrier.position, carrier.attitude, Vec3::Zero(), Vec3::Zero()};
  if (carrier.translation) {
    p.axes = rotation(s, *carrier.rotation).toRotationMatrix();
    p.spin = p.axes * s.v.segment<3>(carrier.rotation->v);
    p.centre = s.q.segment<3>(carrier.translation->q);
    p.velocity = s.v.segment<3>(carrier.translation->v);
  }
  const Vec3 arm = p.axes * carrier.centre;
  p.centre += arm;
  p.velocity += p.spin.cross(arm);
  return p;
}

}  // namespace hosel::fem
