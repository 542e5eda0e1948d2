/// `kind = "flight"`: where balls of given launches go.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_flights(CaseFile& file);

}  // namespace hosel::app
