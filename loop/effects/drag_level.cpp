// The ball's drag is not the flight law's.
#include "loop/effects/all.hpp"
#include "models/flight/flight.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> drag_level(const Setting& setting) {
  if (!setting.flies) return {};
  return {{.what = "factor on the drag coefficient",
           .parameters = {{"relative_drag", "1", 1, -0.4, 0.4, 0.02}},
           .flight = [](Sizes p, models::FlightConditions& c) { c.law.drag_scale *= 1 + p[0]; }}};
}

}  // namespace hosel::loop::forms
