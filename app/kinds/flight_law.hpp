/// `kind = "flight-law"`: a law of drag, lift and decay of spin inferred from followed flights, half of the players
/// left out, and what it and the published laws make of those.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_flight_law(CaseFile& file);

}  // namespace hosel::app
