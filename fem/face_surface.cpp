#include "fem/face_surface.hpp"

namespace hosel::fem {

double FaceSurface::gap(const Vec3& y) const {
  const Vec3 gradient(1, y.y() / face_.bulge, y.z() / face_.roll);
  return (y.x() - face_.height(y.y(), y.z())) / gradient.norm();
}

SurfacePoint FaceSurface::at(const Vec3& y) const {
  SurfacePoint out;
  const Vec3 curvature(0, 1 / face_.bulge, 1 / face_.roll);
  const Vec3 gradient(1, y.y() / face_.bulge, y.z() / face_.roll);
  const double length = gradient.norm();
  out.normal = gradient / length;
  out.gap = (y.x() - face_.height(y.y(), y.z())) / length;
  out.slope = out.normal - out.gap / length * curvature.cwiseProduct(out.normal);
  const Mat3 across = Mat3::Identity() - out.normal * out.normal.transpose();
  out.curvature = across * curvature.asDiagonal() * across / length;
  return out;
}

}  // namespace hosel::fem
