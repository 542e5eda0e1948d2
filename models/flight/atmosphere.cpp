#include "models/flight/atmosphere.hpp"

#include <cmath>

#include "golf/units.hpp"

namespace hosel::models {
namespace {

/// Mole fraction of water vapour (Picard et al. 2008, A1).
double vapour_fraction(const Weather& w) {
  const double T = w.temperature, t = T - 273.15;
  const double saturation = std::exp(1.2378847e-5 * T * T - 1.9121316e-2 * T + 33.93711047 - 6.3431645e3 / T);
  const double enhancement = 1.00062 + 3.14e-8 * w.pressure + 5.6e-7 * t * t;
  return w.humidity * enhancement * saturation / w.pressure;
}

/// Compressibility factor (Picard et al. 2008, A1.4).
double compressibility(const Weather& w, double x) {
  const double t = w.temperature - 273.15, ratio = w.pressure / w.temperature;
  return 1 -
         ratio * (1.58123e-6 + t * (-2.9331e-8 + t * 1.1043e-10) + (5.707e-6 - 2.051e-8 * t) * x +
                  (1.9898e-4 - 2.376e-6 * t) * x * x) +
         ratio * ratio * (1.83e-11 - 0.765e-8 * x * x);
}

}  // namespace

double standard_pressure(double altitude) {
  constexpr double lapse = 0.0065, temperature = 288.15, earth = 6356766, molar_mass = 0.0289644, gas = 8.31432;
  const double geopotential = earth * altitude / (earth + altitude);
  return 101325 * std::pow(1 - lapse * geopotential / temperature, kGravity * molar_mass / (gas * lapse));
}

Air air(const Weather& w) {
  constexpr double gas = 8.314472, dry = 28.96546e-3, water = 18.01528e-3;  // [J/(mol K)], [kg/mol]
  constexpr double reference = 273.15, sutherland = 110.4;
  const double x = vapour_fraction(w);
  return {.density = w.pressure * dry * (1 - x * (1 - water / dry)) / (compressibility(w, x) * gas * w.temperature),
          .viscosity = 1.716e-5 * std::pow(w.temperature / reference, 1.5) * (reference + sutherland) /
                       (w.temperature + sutherland)};
}

}  // namespace hosel::models
