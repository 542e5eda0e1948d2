/// The rolling rigid-body model in the plane of the loft.
#pragma once

#include "models/impact_model.hpp"

namespace hosel::models {

/// Ball and head rigid, the head does not turn, the ball leaves rolling (plus whatever tangential
/// restitution, friction limit and offset the contact law declares); azimuth and sidespin are zero.
/// v_n = v cos a (1 + e) / (1 + m/M), v_p = v sin a (1 + e_t) / (1 + m/M + m r^2 / I).
/// Source: [@dynamic-loft], eqs. (1)-(12).
class RigidPlanar final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

}  // namespace hosel::models
