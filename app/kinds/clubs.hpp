/// kind = "clubs": a rolling model against the means of several clubs, with straight-line fits.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_clubs(CaseFile& file);

}  // namespace hosel::app
