/// What every loop leaves behind, whatever its data are.
#pragma once

#include <string_view>

#include "hosel/app/output.hpp"
#include "hosel/loop/report.hpp"

namespace hosel::app {

/// Writes `report.json` and the summary, and tells the person what came out. `rows`: what a flagged one is called.
void report_loop(Output& out, const loop::LoopResult& result, std::string_view rows);

}  // namespace hosel::app
