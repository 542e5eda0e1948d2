/// What a model with an impact law (rather than a deformable ball) declares of the contact.
/// The defaults are the base models of the specification: linear restitution law, sticking.
#pragma once

#include <limits>

namespace hosel {

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
  /// The normal impulse passes this far above the ball's centre (towards the slip direction of the
  /// face's pull), as a fraction of the ball radius; positive adds spin.
  double normal_force_offset = 0;  ///< [-]

  double normal_restitution(double approach_speed, double distance_from_centre) const {
    return restitution + restitution_slope * approach_speed -
           restitution_falloff * distance_from_centre * distance_from_centre;
  }
};

}  // namespace hosel
