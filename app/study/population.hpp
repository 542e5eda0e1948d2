/// A study's sample beside a measured population: distributions, not pairs of shots.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/study/table.hpp"

namespace hosel::app {

/// `[[population]]`: rows of a file as columns that match outputs of the study, in the outputs' units; NaN where a row
/// has none.
struct StudyPopulation {
  struct Measured {
    std::size_t output = 0;
    std::vector<double> y;  ///< one a row
  };
  std::string name;
  std::vector<Measured> measured;
  std::size_t given = 0;       ///< column of the design of which both populations are seen as a function
  std::vector<double> x = {};  ///< its measured values, one a row
};

/// All populations, and the first of their files that is not there: nothing of it has then been read.
struct StudyPopulations {
  std::vector<StudyPopulation> all;
  std::filesystem::path missing;
};
StudyPopulations read_populations(Table root, const StudyTable& table);

/// For every population and each of its outputs: five quantiles, computed beside measured; then, by a robust line over
/// the given column, the value at the measured median of that column, the slope with its standard error, the scatter
/// about the line, and the share of the variance that the line explains. Draws figures/NAME with the distribution
/// functions and the points over the given column. For the summary: by name, output and side.
nlohmann::json report_populations(Output& out, const StudyTable& table, const std::vector<StudyPopulation>& all,
                                  bool draw);

}  // namespace hosel::app
