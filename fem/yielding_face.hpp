/// A yielding club face as a contact surface: the curved face, moved inwards by one unknown times a shape.
#pragma once

#include <algorithm>

#include "fem/face_surface.hpp"
#include "golf/face_compliance.hpp"

namespace hosel::fem {

/// The local normal follows the slope of what has moved. What the face weighs and what holds it: FaceSpring.
class YieldingFace final : public FaceSurface {
 public:
  /// `travel`: a block of one number, the travel at the centre of the face [m].
  YieldingFace(const Face& face, const FaceCompliance& compliance, const DofMap::Block& travel)
      : FaceSurface(face), compliance_(compliance), travel_(travel) {}
  std::optional<DofMap::Block> unknowns() const override { return travel_; }
  double reach(const SurfaceUnknowns& unknowns) const override { return std::max(0.0, -unknowns[0]); }
  double travel(const Vec3& place, const SurfaceUnknowns& unknowns) const override;
  Travel travel_at(const Vec3& place, const SurfaceUnknowns& unknowns) const override;

 private:
  FaceCompliance compliance_;
  DofMap::Block travel_;
};

}  // namespace hosel::fem
