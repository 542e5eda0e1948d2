/// The rigid club face as a contact surface.
#pragma once

#include "fem/contact_surface.hpp"
#include "golf/face.hpp"

namespace hosel::fem {

/// The gap is the distance, to first order, to xc = -(yc^2 / (2 bulge) + zc^2 / (2 roll)).
class FaceSurface : public ContactSurface {
 public:
  explicit FaceSurface(const Face& face) : face_(face) {}
  double gap(const Vec3& place) const override;
  SurfacePoint at(const Vec3& place) const override;
  double reach(const SurfaceUnknowns&) const override { return 0; }

 private:
  Face face_;
};

}  // namespace hosel::fem
