/// The air that a ball flies through: density and viscosity from the weather, and wind over height.
#pragma once

namespace hosel::models {

struct Weather {
  double temperature = 288.15;  ///< [K]
  double pressure = 101325;     ///< at the place itself, not reduced to sea level [Pa]
  double humidity = 0;          ///< relative, 0 to 1
};

/// Pressure at an altitude [m] in the standard atmosphere's lowest layer [Pa].
/// Source: [@standard-atmosphere], to 11 km.
double standard_pressure(double altitude);

/// What the weather makes of the air.
struct Air {
  double density = 1.225;       ///< [kg/m^3]
  double viscosity = 1.789e-5;  ///< dynamic [Pa s]
};

/// Density by CIPM-2007 with 400 ppm of carbon dioxide, viscosity of dry air by Sutherland's formula. The air's
/// density is that of the launch all along the flight: it falls by 0.3 % up to an apex of 30 m.
/// Source: [@cipm-2007] (stated for 15 to 27 degC and 600 to 1100 hPa, there to 2.2e-5); Sutherland (1893) with the
/// constants of White, Viscous Fluid Flow.
Air air(const Weather& weather);

enum class WindProfile {
  uniform,      ///< the same at every height
  logarithmic,  ///< speed ln(1 + z / z0) / ln(1 + reference / z0), z over the lower of tee and landing ground
};

/// A steady wind that blows in one direction at every height.
struct Wind {
  double speed = 0;    ///< at the reference height [m/s]
  double towards = 0;  ///< where it blows to, right of the target positive: 0 helps, pi is into the face [rad]
  WindProfile profile = WindProfile::logarithmic;
  double reference = 10;    ///< height at which the speed holds [m]
  double roughness = 0.03;  ///< z0 of the logarithmic profile [m]; open grass (Wieringa 1992, J. Wind Eng. 41:357)
};

}  // namespace hosel::models
