/// The hinged club of Cochran and Stobbs (1968), The Search for the Perfect Swing.
#pragma once

#include "models/impact_model.hpp"
#include "models/rigid/impulse.hpp"

namespace hosel::models {

/// As the pendulum club, but the head turns freely about a hinge at the hosel, whose axis is
/// perpendicular to the shaft and to the face's normal: the shaft cannot push the head on.
/// Throws std::invalid_argument where the club has no shaft.
class HingedHead final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

Mat6 hinged_mobility(const Blow& blow);

}  // namespace hosel::models
