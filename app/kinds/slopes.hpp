/// kind = "slopes": what a launch changes by over the face, measured by regression beside models.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_slopes(CaseFile& file);

}  // namespace hosel::app
