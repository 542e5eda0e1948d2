/// kind = "tune": parameters of a model against measured shots.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_tune(CaseFile& file);

}  // namespace hosel::app
