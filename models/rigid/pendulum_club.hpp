/// The club as a rigid pendulum.
#pragma once

#include "models/impact_model.hpp"
#include "models/rigid/impulse.hpp"

namespace hosel::models {

/// The club as one rigid pendulum: head and a rigid straight rod with the shaft's mass per length, free
/// to turn about its butt in all directions; the butt keeps the velocity that the club's motion gives it.
/// After the cylinder pendulum of Tanaka et al. (reference [2] of [@shaft-influence]). Contact as stick-slip.
/// Throws std::invalid_argument where the club has no shaft.
class PendulumClub final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

/// The mobility of the pendulum's head (models/rigid/impulse.hpp).
Mat6 pendulum_mobility(const Blow& blow);

}  // namespace hosel::models
