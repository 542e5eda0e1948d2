/// kind = "restitution-face": restitution and ball speed over the face, against the rigid face.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_restitution_face(CaseFile& file);

}  // namespace hosel::app
