/// Rows that no model of the family can explain: found at the fitted model, with the slip that would explain them.
#pragma once

#include <string>
#include <vector>

#include "loop/fit.hpp"

namespace hosel::loop {

struct RowFlag {
  int shot = 0;         ///< of the problem; or the row of the file where the row never became a shot
  std::string column;
  std::string reason;
  int finding = 0;
  double distance = 0;  ///< squared Mahalanobis distance
};

/// Which column of the data holds an input or a channel of the problem.
struct ColumnUse {
  const Column* column;
  int input = -1;    ///< Input, or
  int channel = -1;  ///< channel of the problem
};

/// Flags shots of the problem at a fitted model. A row is flagged where its distance is beyond what the noise
/// allows in so many rows, or somewhat less where one slip (unit, swapped columns, transposed digits, sign,
/// decimal point) brings it back. A cluster most of whose rows are flagged is one finding.
std::vector<RowFlag> screen(const Problem& problem, const Shots& shots, const std::vector<int>& row_of,
                            const std::vector<ColumnUse>& uses, const Fit& fit);

}  // namespace hosel::loop
