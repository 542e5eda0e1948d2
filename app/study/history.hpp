/// Forces over time of a study's blows.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "app/study/table.hpp"

namespace hosel::app {

nlohmann::json stored(const std::vector<ForceSample>& history);

/// hosel.csv of clubs with a shaft, where no map shows it; histories.csv, and for each model the tangential force and
/// its ratio to the normal force, a line a point.
void report_histories(Output& out, const StudyTable& table, const std::vector<nlohmann::json>& points, bool draw);

}  // namespace hosel::app
