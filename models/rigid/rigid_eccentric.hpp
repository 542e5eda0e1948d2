/// The eccentric impact of a rigid ball on a free rigid head in three dimensions.
#pragma once

#include "models/impact_model.hpp"

namespace hosel::models {

/// One impulse J acts on ball and head at P. After it the surfaces separate with e times the
/// approach speed along n and -e_t times the approach slip across it (0 sticks); where that needs
/// more than friction allows, the ball slides throughout with |J_t| = mu J_n.
/// Contact mobility K = 1/m + 1/M - [a] I_b^-1 [a] - [c] I_h^-1 [c].
class RigidEccentric final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

}  // namespace hosel::models
