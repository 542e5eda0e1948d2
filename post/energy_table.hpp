/// The energy balance of a run, as a table.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "post/text_table.hpp"
#include "solvers/generalized_alpha.hpp"

namespace hosel::post {

/// What moves: a club that strikes a ball, or a club alone, which has no contact.
enum class EnergyOf { blow, swing };

/// The energy at the end of each run, a column each: the first two rows are the sum of the others.
TextTable energy_table(const std::vector<std::pair<std::string, solvers::Ledger>>& runs, EnergyOf what);

}  // namespace hosel::post
