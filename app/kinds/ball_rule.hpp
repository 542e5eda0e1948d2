/// `kind = "ball-rule"`: a ball that just meets a distance limit under old test conditions is changed until it just
/// meets it under new ones; what players lose.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_ball_rule(CaseFile& file);

}  // namespace hosel::app
