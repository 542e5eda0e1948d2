/// The ball as a body: what every model needs to know of it.
#pragma once

namespace hosel {

struct Ball {
  double mass = 0.04593;        ///< [kg]
  double radius = 0.021335;     ///< [m]
  double inertia_factor = 0.4;  ///< I / (m r^2); 0.4 for a uniform sphere

  double inertia() const { return inertia_factor * mass * radius * radius; }  ///< [kg m^2]
};

}  // namespace hosel
