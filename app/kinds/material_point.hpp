/// kind = "material-point": one material driven along strain paths.
#pragma once

#include "hosel/app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_material_point(CaseFile& file);

}  // namespace hosel::app
