/// kind = "modes": the free vibrations of a ball.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_modes(CaseFile& file);

}  // namespace hosel::app
