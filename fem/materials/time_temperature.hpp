/// Time-temperature shift: a rubber at another temperature than that of its measured constants.
#pragma once

#include "fem/materials/solid.hpp"

namespace hosel::fem {

/// Time and temperature of a rubber above its glass transition. Relaxation times change by the factor of Williams,
/// Landel and Ferry, log10 a(T) = -c1 (T - T0) / (c2 + T - T0); moduli of shear are entropic, proportional to the
/// absolute temperature. The ball is at one temperature: its own dissipation warms it by less than a kelvin.
/// Standard constants: cis-polybutadiene (96 % cis), the rubber of a ball's core ([@polymers-handbook], table 26.1).
struct TimeTemperature {
  double measured = 296.15;  ///< where the solid's constants hold [K]
  double c1 = 3.44;          ///< at `origin` [-]
  double c2 = 196.6;         ///< at `origin` [K]
  double origin = 298;       ///< T0 [K]

  /// Sentences naming what cannot be; empty if all is well. `temperature` [K].
  std::vector<std::string> faults(double temperature) const;
  /// Relaxation times at `temperature` [K] over those where the constants hold [-].
  double shift(double temperature) const;
};

/// The solid at `temperature` [K]. Throws std::invalid_argument on a fault.
Solid at_temperature(Solid solid, const TimeTemperature& law, double temperature);

}  // namespace hosel::fem
