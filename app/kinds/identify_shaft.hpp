/// kind = "identify-shaft": stiffness scale and damping of a shaft from measured swings.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_identify_shaft(CaseFile& file);

}  // namespace hosel::app
