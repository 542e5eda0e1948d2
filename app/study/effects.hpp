/// What of a design moves a study's answers most.
#pragma once

#include <functional>
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
  std::vector<std::vector<bool>> idle;  ///< by model and of the columns: no answer of the model changes with it
};
StudyEffects effects_of(const StudyTable& table);

/// To the last digits of a double.
bool same_answer(double a, double b);

/// Which columns change no answer of a model, where points differ in one of them alone. Elsewhere `alone` tells it of a
/// column and a model, asked where the column has no share that is surely one; nothing: it is not known.
void find_idle(StudyEffects& effects, const StudyTable& table,
               const std::function<std::optional<bool>(std::size_t column, std::size_t model)>& alone);

/// "Ball speed [m/s] goes most with club speed [m/s]: 97 % of its variance (95 % interval 96 to 98 %), from 57 to 76."
std::string sentence(const StudyTable& table, const StudyEffects& effects, std::size_t series);

/// Lowest, mean and highest of every series, and where there are several columns the one with which it goes most: said,
/// the page's first sentence and table, sensitivity.csv, and the summary's `range`, `mean`, `main_effects`, `emulator`.
void tell_effects(Output& out, const StudyTable& table, const StudyEffects& effects, nlohmann::json& summary);

/// A panel for each series: from the mean answer at a column's lowest value to that at its highest, or where no grid
/// has them, of the curve fitted to all points; the longest bar first. A column that is idle has no bar.
post::Figure tornado(const StudyTable& table, const StudyEffects& effects, const std::vector<std::size_t>& series);

}  // namespace hosel::app
