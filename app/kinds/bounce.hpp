/// The kind `bounce`: balls thrown obliquely at a rigid plate.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_bounce(CaseFile& file);

}  // namespace hosel::app
