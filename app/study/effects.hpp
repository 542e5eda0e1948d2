/// What of a design moves a study's answers most.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/study/emulator.hpp"
#include "app/study/table.hpp"
#include "solvers/main_effects.hpp"

namespace hosel::app {

/// The columns of a design that take more than one value, and what they do to each series.
struct StudyEffects {
  std::vector<std::size_t> columns;
  std::vector<std::optional<solvers::MainEffects>> of;      ///< one a series; shares by its emulator where there is one
  std::vector<std::optional<StudyEmulator>> emulators;      ///< the same, of a sample
  std::vector<std::vector<StudyEmulator::Share>> together;  ///< one a column, where there is an emulator
};
StudyEffects effects_of(const StudyTable& table);

/// "Ball speed [m/s] goes most with club speed [m/s]: 97 % of its variance (95 % interval 96 to 98 %), from 57 to 76."
std::string sentence(const StudyTable& table, const StudyEffects& effects, std::size_t series);

/// Lowest, mean and highest of every series, and where there are several columns the one with which it goes most: said,
/// the page's first sentence and table, sensitivity.csv, and the summary's `range`, `mean`, `main_effects`, `emulator`.
void tell_effects(Output& out, const StudyTable& table, const StudyEffects& effects, nlohmann::json& summary);

/// A panel for each series: from the answer at a column's lowest value to that at its highest, the others at their
/// means, the longest bar first.
post::Figure tornado(const StudyTable& table, const StudyEffects& effects, const std::vector<std::size_t>& series);

}  // namespace hosel::app
