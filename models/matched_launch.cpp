#include "models/matched_launch.hpp"

#include <algorithm>
#include <cmath>

#include "golf/units.hpp"
#include "models/checked_launch.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {

MatchedLaunch match_launch_angle(const ImpactModel& model, Blow blow, double launch_angle, double tolerance) {
  MatchedLaunch out{.blow = std::move(blow)};
  double& loft = out.blow.delivery.dynamic_loft;
  double slope = kLaunchPerLoft, last_loft = 0, last_angle = 0;
  while (out.blows < 8) {
    out.launch = checked_launch(model, out.blow);
    const double angle = out.launch.launch_angle();
    if (std::abs(angle - launch_angle) <= tolerance) return ++out.blows, out;
    if (out.blows++ > 0 && loft != last_loft) slope = (angle - last_angle) / (loft - last_loft);
    last_loft = loft;
    last_angle = angle;
    // Where the launch angle hardly follows, or falls, a secant leads anywhere.
    if (!(slope > 0.05)) slope = kLaunchPerLoft;
    loft += std::clamp((launch_angle - angle) / slope, -0.5, 0.5);
    if (std::abs(loft) >= kPi / 2) break;
  }
  throw solvers::NonConvergence("no loft of this blow gives the launch angle that was measured");
}

}  // namespace hosel::models
