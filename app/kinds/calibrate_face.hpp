/// kind = "calibrate-face": a face that yields from characteristic times, restitution and the plate's mass.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_calibrate_face(CaseFile& file);

}  // namespace hosel::app
