/// The parameters at which an answer of a study is largest or least: sought on the emulator, confirmed by the model.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/study/effects.hpp"
#include "app/study/table.hpp"

namespace hosel::app {

/// `[optimum]` of a study over one [sample].
struct StudyOptimum {
  std::size_t output = 0;
  bool largest = true;
  std::string where;  ///< a formula of columns and outputs that is true at what is allowed; empty: all of it
};
std::optional<StudyOptimum> read_optimum(Table root, const StudyTable& table);

/// What a model answers, number or nothing an output, with these overrides.
using AnswersAt =
    std::function<std::vector<std::optional<double>>(const std::vector<std::string>& set, std::size_t model)>;

/// Seeks within the ranges of the sample, of a normal distribution within two standard deviations, where the condition
/// holds with two standard deviations of the emulator's error to spare; says the place,
/// what the emulator expects there, what the model answers, and which parameters end at their range. For the summary:
/// one entry a model, or the entry itself where another case answers.
nlohmann::json report_optimum(Output& out, const StudyTable& table, const StudyEffects& effects,
                              const StudyOptimum& optimum, const AnswersAt& answers);

}  // namespace hosel::app
