#include "fem/materials/time_temperature.hpp"

#include <cmath>
#include <stdexcept>

namespace hosel::fem {
namespace {

double log_shift(const TimeTemperature& law, double temperature) {
  return -law.c1 * (temperature - law.origin) / (law.c2 + temperature - law.origin);
}

}  // namespace

std::vector<std::string> TimeTemperature::faults(double temperature) const {
  std::vector<std::string> out;
  if (!(c1 >= 0) || !(c2 > 0))
    out.emplace_back("a shift of time by temperature needs c1 of at least zero, c2 above it");
  for (const double T : {measured, temperature})
    if (!(T > origin - c2)) {
      out.emplace_back("a rubber has no shift of time at or below " + std::to_string(origin - c2) + " K (T0 - c2)");
      break;
    }
  return out;
}

double TimeTemperature::shift(double temperature) const {
  return std::pow(10, log_shift(*this, temperature) - log_shift(*this, measured));
}

Solid at_temperature(Solid solid, const TimeTemperature& law, double temperature) {
  if (const auto faults = law.faults(temperature); !faults.empty()) throw std::invalid_argument(faults.front());
  const double entropic = temperature / law.measured, shift = law.shift(temperature);
  solid.elastic = solid.elastic.stiffened(entropic);
  for (MaxwellBranch& b : solid.branches) {
    b.modulus *= entropic;
    b.time *= shift;
  }
  return solid;
}

}  // namespace hosel::fem
