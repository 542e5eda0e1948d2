/// kind = "sweep": any case over a grid or a Latin hypercube of its keys.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_sweep(CaseFile& file);

}  // namespace hosel::app
