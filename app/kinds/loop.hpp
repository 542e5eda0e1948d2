/// kind = "loop": from measured shots to the effect that the model lacks.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_loop(CaseFile& file);

}  // namespace hosel::app
