/// Motion of the ball after it lands on turf, level or sloped along the target line: rigid bounces, then rolling.
///
/// Each bounce happens on a plane that the turf's crater tilts against the motion by
///   theta = 15.4 deg (v / 18.6 m/s) (phi / 44.4 deg), phi the path's angle from the vertical,
/// with e = 0.510 - 0.0375 v_n + 0.000903 v_n^2 (0.120 above 20 m/s) across it and Coulomb friction along it; hops
/// are free of air, and end below 5 mm; the ball then rolls with 5/7 rho g of deceleration. On a slope all of this
/// holds in the axes of the ground, phi from its normal, and 5/7 of the weight along it acts on the rolling ball.
/// Source: [@penner-2002]: one turf, and rolling resistance over its range on greens. Its author expects more on a
/// fairway.
#pragma once

#include <vector>

#include "models/flight/flight.hpp"

namespace hosel::models {

struct BounceRoll {
  double friction = 0.40;
  double rolling = 0.131;                            ///< rho
  double rolling_low = 0.065, rolling_high = 0.196;  ///< what turf spreads over
};

struct Run {
  double total = 0;                       ///< horizontal distance from launch to rest [m]
  double side = 0;                        ///< of the rest, right of the target positive [m]
  double total_firm = 0, total_slow = 0;  ///< `total` at the ends of the turf's spread of rolling resistance [m]
  int bounces = 0;
  std::vector<Vec3> path;  ///< of the ball's centre from the landing to its rest
};

/// Throws std::invalid_argument on a slope on which a ball bounces or rolls on for ever, std::domain_error where the
/// ball comes faster than the law of the turf knows (a topped drive).
Run run_out(const FlightPoint& landing, const Ball& ball, const Ground& ground, const BounceRoll& turf = {});

}  // namespace hosel::models
