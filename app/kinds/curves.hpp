/// kind = "curves": launch against one parameter, or force histories, for a family of another.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_curves(CaseFile& file);

}  // namespace hosel::app
