/// kind = "cross-check": a set of models over a grid of blows, each against a reference.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_cross_check(CaseFile& file);

}  // namespace hosel::app
