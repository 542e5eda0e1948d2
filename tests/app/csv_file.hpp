/// A table that the command wrote, by the names of its columns.
#pragma once

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "post/csv.hpp"

namespace hosel::test {

class CsvFile {
 public:
  /// Throws DataError on a file that is no table.
  explicit CsvFile(const std::filesystem::path& file) : sheet_(post::read_csv(file)) {}

  std::size_t rows() const { return sheet_.rows(); }
  /// Cells of a column; throws std::runtime_error where none has the name, which fails the test.
  const std::vector<std::string>& texts(const std::string& column) const {
    const auto it = std::ranges::find(sheet_.names, column);
    if (it == sheet_.names.end()) throw std::runtime_error(sheet_.file + " has no column " + column);
    return sheet_.columns[std::size_t(it - sheet_.names.begin())];
  }
  std::vector<double> numbers(const std::string& column) const {
    std::vector<double> out;
    for (const std::string& cell : texts(column)) out.push_back(std::stod(cell));
    return out;
  }
  const std::string& text(const std::string& column, std::size_t row) const { return texts(column).at(row); }
  double number(const std::string& column, std::size_t row) const { return std::stod(text(column, row)); }

 private:
  post::Sheet sheet_;
};

}  // namespace hosel::test
