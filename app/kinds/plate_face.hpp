/// kind = "plate-face": everything that a maker asks of a face with a thickness.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_plate_face(CaseFile& file);

}  // namespace hosel::app
