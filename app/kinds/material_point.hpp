/// kind = "material-point": one material driven along strain paths.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_material_point(CaseFile& file);

}  // namespace hosel::app
