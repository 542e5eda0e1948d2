/// kind = "face-map": the launch over the face, for several models or clubs, and what they differ by.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_face_map(CaseFile& file);

}  // namespace hosel::app
