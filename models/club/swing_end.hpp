/// The end of a swing, where the blow begins: motion of the head and state of the shaft.
#pragma once

#include <optional>

#include "models/club/loaded_shaft.hpp"
#include "models/club/swing.hpp"

namespace hosel::models {

struct SwingEnd {
  /// In a face frame turned about the normal by `lie`, in which the head arrives without a lie: a delivery knows none.
  Club club;
  Delivery delivery;
  double lie = 0;              ///< dynamic lie of the club as it was described [rad]
  double lead = 0, droop = 0;  ///< of the hosel [m]
  LoadedShaft shaft;
  GripLoad hands;  ///< as a measurement of the grip alone would have it
};

/// Swings the club from hanging still at `begin` to `end` along the grip's motion. The face frame is turned by `lie`;
/// where not given, by that with which the head arrives. Throws std::invalid_argument where the shaft has no head, or
/// where a face of unlike bulge and roll would be turned; NonConvergence.
SwingEnd swing_end(const Club& club, const SwingOptions& options, const fem::Motion& motion, double begin, double end,
                   std::optional<double> lie = {});

/// Where a place on the face of the club as it was described is on the turned one; toe and high [m].
void turn_place(double lie, Delivery& delivery);

}  // namespace hosel::models
