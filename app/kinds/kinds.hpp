/// The readers of the kinds of case, each in the file of its name: app/job.cpp says what each kind is.
#pragma once

#include "app/job.hpp"

namespace hosel::app {

std::unique_ptr<Job> read_calibrate_ball(CaseFile& file);
std::unique_ptr<Job> read_calibrate_face(CaseFile& file);
std::unique_ptr<Job> read_calibrate_reduced(CaseFile& file);
std::unique_ptr<Job> read_flight_law(CaseFile& file);
std::unique_ptr<Job> read_identify_shaft(CaseFile& file);
std::unique_ptr<Job> read_impact(CaseFile& file);
std::unique_ptr<Job> read_landing_times(CaseFile& file);
std::unique_ptr<Job> read_loop(CaseFile& file);
std::unique_ptr<Job> read_material_point(CaseFile& file);
std::unique_ptr<Job> read_plate_face(CaseFile& file);
std::unique_ptr<Job> read_study(CaseFile& file);
std::unique_ptr<Job> read_swing(CaseFile& file);
std::unique_ptr<Job> read_tune(CaseFile& file);

/// `modes` of a ball, and of a case with a `[shaft]`.
std::unique_ptr<Job> read_modes(CaseFile& file);
std::unique_ptr<Job> read_shaft_modes(CaseFile& file);
/// `loop` with `[model] base = "flight"`: measured flights, from launches that were seen.
std::unique_ptr<Job> read_loop_flight(CaseFile& file);
/// `loop` with `[model] base = "shaft"`: time histories of a bench test, or of a swing where there is a `[motion]`.
std::unique_ptr<Job> read_loop_history(CaseFile& file);

}  // namespace hosel::app
