/// The loop's results as files: report.json (the stable interface), residuals.csv, report.html.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "loop/result.hpp"

namespace hosel::loop {

nlohmann::json to_json(const LoopResult& result);
/// One row per used row of the table (shots, or samples of records): for every channel the measured value and what the
/// model said before and after.
std::string residuals_csv(const LoopResult& result, const Shots& table);
/// One parameter of an adopted effect, in the unit that it is printed in.
struct AdoptedSize {
  std::string effect, parameter, unit;  ///< unit "1": a plain number
  double value = 0, sd = 0;             ///< sd: infinite where the data do not show it
  bool at_bound = false;                ///< at the edge of its plausible range
};
/// By the fit to all training rows; empty where nothing is adopted.
std::vector<AdoptedSize> adopted_sizes(const LoopResult& result);
/// Of what is tied, the effects that the model behind `after` has beside the adopted ones.
std::vector<std::string> tied_in_after(const LoopResult& result);
/// Of a place whose regressor is the constant: the channel and by how much it is off on the rows held out.
std::string off_in_the_mean(const Location& place, const LoopResult& result);

/// The verdict in a sentence.
std::string sentence(const LoopResult& result);
/// The body of a page with the figures inline.
std::string page(const LoopResult& result, const Shots& table);

}  // namespace hosel::loop
