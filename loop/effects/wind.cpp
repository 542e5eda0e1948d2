// A wind blows that is not declared.
#include <cmath>

#include "loop/effects/all.hpp"
#include "models/flight/flight.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> wind(const Setting& setting) {
  if (!setting.flies) return {};
  return {{.what = "towards the target and to the right of it, at the height of the declared wind",
           .parameters = {{"wind_along", "m/s", 1, -15, 15, 0.5}, {"wind_to_the_right", "m/s", 1, -15, 15, 0.5}},
           .flight = [](Sizes p, models::FlightConditions& c) {
             if (p[0] == 0 && p[1] == 0) return;
             const double along = c.wind.speed * std::cos(c.wind.towards) + p[0],
                          right = c.wind.speed * std::sin(c.wind.towards) + p[1];
             c.wind.speed = std::hypot(along, right);
             c.wind.towards = std::atan2(right, along);
           }}};
}

}  // namespace hosel::loop::forms
