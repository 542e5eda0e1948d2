/// kind = "study": a design of blows through models or through another case, with comparison, statements and figures.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_study(CaseFile& file);

}  // namespace hosel::app
