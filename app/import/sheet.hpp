/// A launch monitor's file as rows of cells, whatever its encoding, separators and decoration.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/import/dictionary.hpp"

namespace hosel::app {

using Row = std::vector<std::string>;

struct Sheet {
  Row names;
  std::vector<Row> rows;  ///< as long as `names`, or longer
  Row units;              ///< of a row of units; empty: there is none
  std::string layout;     ///< of the dictionary; empty: none that is known
  std::string family;     ///< units of that layout: imperial, metric
  std::string delimiter = "JSON";
  std::vector<Row> before;                                                      ///< rows above the header
  std::vector<std::string> notes;                                               ///< lines of text below it
  std::size_t summaries = 0, headers_again = 0, units_again = 0, messages = 0;  ///< rows passed over
  std::size_t speedless = 0;                                                    ///< rows without any speed, likewise
};

/// Throws InputError in one sentence.
Sheet read_sheet(const std::filesystem::path& file, const Dictionary& dictionary);

/// Prints columns and what stands in them, as options to fill in.
void list_columns(const Row& names, const Row& cells, const Dictionary& dictionary);

}  // namespace hosel::app
