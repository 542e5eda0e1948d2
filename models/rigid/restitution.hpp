/// The coefficient of restitution of one blow.
#pragma once

#include "golf/contact_law.hpp"

namespace hosel::models {

/// e at this approach speed [m/s] and distance from the face centre [m]. Throws std::invalid_argument outside [0, 1]:
/// below, ball and face would pass through each other; above, the blow would create energy.
double normal_restitution(const ContactLaw& law, double approach_speed, double distance_from_centre);

}  // namespace hosel::models
