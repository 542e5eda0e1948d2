// The spin dies out faster or slower than declared.
#include "loop/effects/all.hpp"
#include "models/flight/flight.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> spin_decay(const Setting& setting) {
  if (!setting.flies) return {};
  return {{.what = "rate of the spin's decay",
           .parameters = {{"change_of_rate", "1/s", 1, -0.05, 0.3, 0.02}},
           .flight = [](Sizes p, models::FlightConditions& c) { c.law.decay.rate += p[0]; }}};
}

}  // namespace hosel::loop::forms
