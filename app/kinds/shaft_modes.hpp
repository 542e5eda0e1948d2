/// kind = "modes" of a case with a [shaft]: natural frequencies and shapes of a shaft, with or without its head.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_shaft_modes(CaseFile& file);

}  // namespace hosel::app
