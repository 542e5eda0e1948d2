/// Rows of an export that are statistics of its shots, without a word that says so.
#pragma once

#include <optional>
#include <vector>

#include "app/import/cells.hpp"
#include "app/import/sheet.hpp"

namespace hosel::app {

/// Finds rows that are the mean, the deviation, the least or the greatest of the shots above them.
class Statistics {
 public:
  /// `columns`: whose numbers are compared. `comma`: parts decimals.
  Statistics(std::vector<std::size_t> columns, bool comma) : columns_(std::move(columns)), comma_(comma) {}

  /// Whether `row` is one of all shots so far, or of those since the last `restart`; else it counts as a shot.
  bool take(const Row& row);
  void restart() { run_.clear(); }

 private:
  struct Column {
    double n = 0, first = 0, sum = 0, squares = 0, low = 0, high = 0, step = 1;  ///< sums of what exceeds the first
  };
  using Columns = std::vector<Column>;
  using Cells = std::vector<std::optional<Cell>>;

  double step(const std::string& cell) const;
  void add(Columns& to, const Cells& cells, const Row& row) const;
  bool of(const Columns& above, const Cells& cells, const Row& row) const;

  std::vector<std::size_t> columns_;
  bool comma_;
  Columns all_, run_;
};

}  // namespace hosel::app
