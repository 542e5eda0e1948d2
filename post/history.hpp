/// Scalars over time as CSV: one header with units, one line an instant, on disk at once.
#pragma once

#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace hosel::post {

class History {
 public:
  /// Columns as `name_unit`; an existing file is replaced. Throws std::runtime_error if it cannot be.
  History(const std::filesystem::path& file, const std::vector<std::string>& columns);
  /// One value a column, else std::invalid_argument.
  void write(std::span<const double> values);

 private:
  std::ofstream out_;
  std::string file_;
  std::size_t columns_;
};

}  // namespace hosel::post
