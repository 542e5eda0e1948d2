/// A launch monitor's export made into a case of the loop.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hosel::app {

struct ImportOptions {
  std::filesystem::path file;
  std::filesystem::path out;         ///< the new case directory
  std::filesystem::path dictionary;  ///< beside the shipped one; empty: none
  std::vector<std::string> columns;  ///< "header=quantity_unit", by hand; "header=" leaves a column out
  std::vector<std::string> keep;     ///< headers of unknown columns that may explain something (a regressor)
  std::string units;                 ///< "imperial" or "metric" where the file names none; empty: refuse
  std::string club;  ///< only the shots with this club, or the club where the file names none; empty: all
};

/// Reads separators, decimal commas, byte-order marks, UTF-16 and Latin-1, preambles, unit rows, repeated headers,
/// summary rows, cells with L and R, and JSON; says what it understood as a table; writes `case.toml`, `shots.csv` and
/// `kept.csv` (results of the monitor's own flight model, and what was not understood). Throws InputError in one
/// sentence: what, where, and the option that helps.
void import_shots(const ImportOptions& options);

}  // namespace hosel::app
