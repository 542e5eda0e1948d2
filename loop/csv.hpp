/// A strict reader of comma-separated files: a header, then rows of as many cells.
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hosel::loop {

/// One line a person can act on: `file:line: what is wrong`.
class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Cells as text, quotes removed. Row numbers count data rows from 0; `lines` gives their place in the file.
struct Sheet {
  std::string file;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> columns;  ///< columns[c][row]
  std::vector<std::size_t> lines;

  std::size_t rows() const { return lines.size(); }
};

/// Reads RFC-4180 text: quoted cells may hold commas, quotes (doubled) and line breaks; blank lines are
/// passed over. Throws DataError on a missing file or one that is none (a pipe), text that is not UTF-8, an empty or
/// doubled header, a row of the wrong length, an open quote.
Sheet read_csv(const std::filesystem::path& file);

}  // namespace hosel::loop
