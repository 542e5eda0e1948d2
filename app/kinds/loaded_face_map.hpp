/// `kind = "loaded-face-map"`: what the club of a swing changes over the face, part by part, over several swings.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_loaded_face_map(CaseFile& file);

}  // namespace hosel::app
