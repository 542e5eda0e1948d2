// The air is denser or thinner than declared.
#include "loop/effects/all.hpp"
#include "models/flight/flight.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> air_density(const Setting& setting) {
  if (!setting.flies) return {};
  return {{.what = "factor on the density",
           .parameters = {{"relative_density", "1", 1, -0.35, 0.2, 0.02}},
           .flight = [](Sizes p, models::FlightConditions& c) { c.air.density *= 1 + p[0]; }}};
}

}  // namespace hosel::loop::forms
