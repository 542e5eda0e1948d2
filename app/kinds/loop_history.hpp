#pragma once

#include "app/job.hpp"

namespace hosel::app {

/// `kind = "loop"` with `[model] base = "shaft"`: time histories of a bench test, or of a swing where there is a
/// `[motion]`.
std::unique_ptr<Job> read_loop_history(CaseFile& file);

}  // namespace hosel::app
