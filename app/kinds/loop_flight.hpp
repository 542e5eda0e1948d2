/// `kind = "loop"` with `base = "flight"`: measured flights, from launches that were seen.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_loop_flight(CaseFile& file);

}  // namespace hosel::app
