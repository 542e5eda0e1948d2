/// kind = "characteristic-time": the rules' pendulum test: contact time of a steel sphere against speed, and its
/// intercept.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_characteristic_time(CaseFile& file);

}  // namespace hosel::app
