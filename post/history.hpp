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
  /// Columns as `name_unit`. An existing file is replaced, but for its lines up to `resume_after` in the
  /// first column where that is not negative. Throws std::runtime_error if it cannot be written.
  History(const std::filesystem::path& file, const std::vector<std::string>& columns, double resume_after = -1);
  /// One value a column, else std::invalid_argument.
  void write(std::span<const double> values);

 private:
  std::ofstream out_;
  std::string file_;
  std::size_t columns_;
};

}  // namespace hosel::post
