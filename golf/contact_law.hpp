/// The contact of a blow: the impact law of the models that have one, and friction on the patch of a deformable ball.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace hosel {

/// What holds a point that has not slid yet.
struct StaticFriction {
  double coefficient = 0;  ///< [-]
  double distance = 0;     ///< of slip over which what it has beyond sliding friction falls to 1/e [m]
};

/// Between a point of a deformable ball and the face.
struct PatchFriction {
  double coefficient = 0.4;                     ///< Coulomb's, of sliding [-]
  std::optional<double> transition_speed = {};  ///< where set, friction is regularised by velocity [m/s]
  std::optional<StaticFriction> at_rest = {};   ///< where set, what holds a point until it has slid some way

  /// Sentences naming what cannot be; empty if all is well.
  std::vector<std::string> faults() const;
};

/// The impact law's defaults: linear restitution law, sticking.
struct ContactLaw {
  /// Normal coefficient of restitution e = level + slope * approach speed.
  double restitution = 0.86;           ///< level [-]
  double restitution_slope = -0.0029;  ///< [s/m]
  /// e falls by falloff * (distance from the face centre)^2.
  double restitution_falloff = 0;  ///< [1/m^2]
  /// After the blow the surfaces separate tangentially with -e_t times their approach slip.
  double tangential_restitution = 0;  ///< e_t [-]
  /// Coulomb limit of the impulse; inf sticks.
  double friction = std::numeric_limits<double>::infinity();
  /// The normal impulse passes this far below the ball's centre (down the face, along its slip), as a fraction of the
  /// ball's radius; positive adds spin.
  double normal_force_offset = 0;  ///< [-]
  /// Of a finite-element ball, which knows none of the above.
  PatchFriction patch = {};

  double normal_restitution(double approach_speed, double distance_from_centre) const {
    return restitution + restitution_slope * approach_speed -
           restitution_falloff * distance_from_centre * distance_from_centre;
  }
};

}  // namespace hosel
