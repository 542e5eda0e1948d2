// The ball's lift is not the flight law's.
#include "loop/effects/all.hpp"
#include "models/flight/flight.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> lift_law(const Setting& setting) {
  if (!setting.flies) return {};
  return {{.what = "factor on the lift coefficient",
           .parameters = {{"relative_lift", "1", 1, -0.6, 0.6, 0.03}},
           .flight = [](Sizes p, models::FlightConditions& c) { c.law.lift_scale *= 1 + p[0]; }}};
}

}  // namespace hosel::loop::forms
