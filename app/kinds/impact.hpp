/// kind = "impact": one blow through one or several models.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_impact(CaseFile& file);

}  // namespace hosel::app
