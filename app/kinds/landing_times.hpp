/// `kind = "landing-times"`: launches at several sites with the time of their landing: does the air's density alone
/// carry what the sites differ by at equal launch?
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_landing_times(CaseFile& file);

}  // namespace hosel::app
