/// kind = "calibrate-ball": a ball's material from its normal impacts on a wall.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_calibrate_ball(CaseFile& file);

}  // namespace hosel::app
