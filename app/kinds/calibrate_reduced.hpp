/// kind = "calibrate-reduced": what the reduced models need of a ball, from what its finite-element model does.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_calibrate_reduced(CaseFile& file);

}  // namespace hosel::app
