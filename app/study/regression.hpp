/// What measured shots say of the slopes over what their blows differ in, beside the answers of a study.
///
///     [regression]   shots, first_shot, last_shot, of, on
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/output.hpp"
#include "app/reader.hpp"

namespace hosel::app {

struct StudyRegression {
  std::filesystem::path file;             ///< where it is not there, nothing else is here
  std::string repeated;                   ///< a sentence where shots stand in the file more than once
  std::vector<std::string> of, on;        ///< quantities of the launch, inputs of the blow, each with its unit
  std::size_t rows = 0;                   ///< of the range of numbers, whole or not
  std::vector<std::vector<double>> y, x;  ///< one each of `of` and `on`: their numbers in the whole rows, in that unit
};
std::optional<StudyRegression> read_regression(Table root);

/// Each quantity over all inputs at once, from their medians: slopes at equal other inputs, robust against bad rows,
/// with 95 % intervals by the scatter of the scores. regression.csv, a table, and the summary's entry.
nlohmann::json report_regression(Output& out, const StudyRegression& regression);

}  // namespace hosel::app
