/// A club face with a thickness as a contact surface: the curved face, moved inwards by unknowns times shapes.
#pragma once

#include <memory>
#include <utility>

#include "fem/face_surface.hpp"
#include "fem/shape_spline.hpp"

namespace hosel::fem {

/// The local normal follows the slope of what has moved. What the face weighs and what holds it: FaceSpring.
class PlateSurface final : public FaceSurface {
 public:
  /// `unknowns`: a block of as many numbers as the spline has functions; `largest`: of each, over the face.
  PlateSurface(const Face& face, std::shared_ptr<const ShapeSpline> shapes, Eigen::VectorXd largest,
               const DofMap::Block& unknowns)
      : FaceSurface(face), shapes_(std::move(shapes)), largest_(std::move(largest)), unknowns_(unknowns) {}
  std::optional<DofMap::Block> unknowns() const override { return unknowns_; }
  double reach(const SurfaceUnknowns& unknowns) const override { return largest_.dot(unknowns.cwiseAbs()); }
  double travel(const Vec3& place, const SurfaceUnknowns& unknowns) const override {
    return shapes_->sum(place.tail<2>(), unknowns);
  }
  Travel travel_at(const Vec3& place, const SurfaceUnknowns& unknowns) const override {
    return shapes_->at(place.tail<2>(), unknowns);
  }

 private:
  std::shared_ptr<const ShapeSpline> shapes_;
  Eigen::VectorXd largest_;
  DofMap::Block unknowns_;
};

}  // namespace hosel::fem
