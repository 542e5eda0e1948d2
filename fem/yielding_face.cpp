#include "fem/yielding_face.hpp"

namespace hosel::fem {

double YieldingFace::travel(const Vec3& place, const SurfaceUnknowns& unknowns) const {
  return unknowns[0] * compliance_.shape(place.y(), place.z()).value;
}

Travel YieldingFace::travel_at(const Vec3& place, const SurfaceUnknowns& unknowns) const {
  const FaceCompliance::Shape shape = compliance_.shape(place.y(), place.z());
  Travel out;
  out.value = unknowns[0] * shape.value;
  out.slope.segment<2>(1) = unknowns[0] * shape.slope;
  out.slope[3] = shape.value;
  out.second.block<2, 2>(1, 1) = unknowns[0] * shape.second;
  out.second.block<2, 1>(1, 3) = shape.slope;
  out.second.block<1, 2>(3, 1) = shape.slope.transpose();
  return out;
}

}  // namespace hosel::fem
