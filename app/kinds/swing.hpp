/// kind = "swing": a flexible club driven by the motion of the grip, up to impact.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_swing(CaseFile& file);

}  // namespace hosel::app
