/// A launch monitor's export made into a case of the loop.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hosel::app {

struct ImportOptions {
  std::vector<std::filesystem::path> files;  ///< at least one; the shots of several stand together
  std::filesystem::path out;                 ///< the new case directory
  std::filesystem::path dictionary;          ///< beside the shipped one; empty: none
  std::vector<std::string> columns;  ///< "header=quantity_unit" or "header=club" (a role); "-quantity" turns its sign;
                                     ///< "header=" leaves it out
  std::vector<std::string> keep;     ///< headers of unknown columns that may explain something (a regressor)
  std::string units;                 ///< "imperial" or "metric" where the file names none; empty: refuse
  bool modelled = false;             ///< take what the instrument says it has modelled (spin) as if it were measured
  bool left_handed = false;          ///< every shot is a left-handed player's
  std::string club;  ///< only the shots with this club, or the club where the file names none; empty: all
};

/// Reads separators, decimal commas, byte-order marks, UTF-16 and Latin-1, preambles, unit rows, repeated headers,
/// summary rows, cells with a side or a unit of their own, and JSON (one document or one a line); mirrors left-handed
/// shots, leaves out what the instrument modelled and zeros that no blow has; says what it understood as a table;
/// writes `case.toml`, `shots.csv` and `kept.csv` (results of the monitor's own flight model, and what was not
/// understood). Of several files each is read and judged by itself; a club has one name in all of them, the name of a
/// file is its club where no column is, and a table has mean and standard deviation of every club. Throws InputError in
/// one sentence: what, where, and the option that helps.
void import_shots(const ImportOptions& options);

}  // namespace hosel::app
