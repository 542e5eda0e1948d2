/// `kind = "loaded-club"`: a swing, and the blow that its club strikes, loaded as it is.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_loaded_club(CaseFile& file);

}  // namespace hosel::app
