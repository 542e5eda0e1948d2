#include "fem/yielding_face.hpp"

namespace hosel::fem {

double YieldingFace::travel(const Vec3& place, const SurfaceUnknowns& unknowns) const {
  return unknowns[0] * compliance_.shape(place.y(), place.z()).value;
}

Travel YieldingFace::travel_at(const Vec3& place, const SurfaceUnknowns& unknowns) const {
  const FaceCompliance::Shape shape = compliance_.shape(place.y(), place.z());
  Travel out;
  out.value = unknowns[0] * shape.value;
  out.slope = unknowns[0] * shape.slope;
  out.second = unknowns[0] * shape.second;
  out.shape = SurfaceUnknowns::Constant(1, shape.value);
  out.shape_slope = shape.slope;
  return out;
}

}  // namespace hosel::fem
