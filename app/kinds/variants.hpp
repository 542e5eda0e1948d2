/// The kind `variants`: one blow in several variants of its case, side by side.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_variants(CaseFile& file);

}  // namespace hosel::app
