/// Scalars over time as CSV: one header with units, one line an instant, on disk at once.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "post/file.hpp"

namespace hosel::post {

class History {
 public:
  /// How far a history has come, and what it holds so far: enough to go on with it or to see that it was changed.
  struct Mark {
    long rows = 0;
    std::string digest = {};  ///< of header and rows
  };

  /// Columns as `name_unit`. An existing file is replaced, but for the rows of `kept`.
  /// Throws std::runtime_error if it cannot be written, or does not hold what `kept` says.
  History(const std::filesystem::path& file, const std::vector<std::string>& columns, const Mark* kept = nullptr);
  /// One value a column, else std::invalid_argument.
  void write(std::span<const double> values);
  const Mark& mark() const { return mark_; }

  /// Whether FILE begins with what the mark was taken of.
  static bool holds(const std::filesystem::path& file, const Mark& mark);

 private:
  std::unique_ptr<GrowingFile> out_;
  std::string file_;
  std::size_t columns_;
  Mark mark_;
};

}  // namespace hosel::post
