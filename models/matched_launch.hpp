/// Finds the unknown loft of a blow from its measured launch angle. A launch monitor's dynamic loft may be computed
/// from the ball; the launch angle is seen. Spin and speed are then compared at the same launch angle, with the loft an
/// unknown of each shot.
#pragma once

#include "models/impact_model.hpp"

namespace hosel::models {

/// Launch angle gained by dynamic loft, of a gripping ball to begin with: launch ratios are 0.6 to 0.85.
inline constexpr double kLaunchPerLoft = 0.7;

struct MatchedLaunch {
  Blow blow;      ///< at the loft that was found
  Launch launch;  ///< of that blow
  int blows = 0;  ///< asked for
};

/// Secants in the dynamic loft, from the given one, until the launch angle is within `tolerance`. A tolerance of
/// 0.05 deg is 0.2 % of an iron's spin. Throws NonConvergence where eight blows do not get there.
MatchedLaunch match_launch_angle(const ImpactModel& model, Blow blow, double launch_angle, double tolerance);

}  // namespace hosel::models
