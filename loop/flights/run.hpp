/// The loop on flights.
#pragma once

#include "loop/flights/case.hpp"
#include "loop/result.hpp"

namespace hosel::loop {

/// Throws DataError where nothing can be compared.
LoopResult run(const FlightCase& c);

}  // namespace hosel::loop
