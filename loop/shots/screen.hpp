/// Rows that no fit explains, found at the fitted model, with the recording error that would explain each.
#pragma once

#include <string>
#include <vector>

#include "loop/fit.hpp"
#include "loop/shots/model.hpp"
#include "loop/shots/shots.hpp"

namespace hosel::loop {

struct RowFlag {
  int shot = -1;  ///< of the model; -1 where the row never became one
  int row = 0;    ///< of the file
  std::string column;
  std::string reason;
  std::string doubtful = {};  ///< the reason where the slip is this row's alone; empty: no accident would fit as well
  int finding = 0;
  double distance = 0;   ///< squared Mahalanobis distance
  bool slip = true;      ///< a slip of the record explains it; else only that nothing explains it is known
  bool cluster = false;  ///< one slip explains most of its cluster
};

struct Screening {
  std::vector<RowFlag> flags;  ///< by row
  /// So many shots are far off that they are no exceptions: those that no slip would bring back, or only a slip of a
  /// record in which few slip, are not flagged, and the residual is to be explained. The likeliest column, input or
  /// channel; empty: no such thing.
  std::string widespread;
  int many = 0;  ///< such shots
};

/// Which column of the data holds an input or a channel of the model.
struct ColumnUse {
  const Column* column;
  int input = -1;    ///< Input, or
  int channel = -1;  ///< channel of the model
};

/// Flags shots of the model at a fitted model. A row is flagged where its distance is beyond what the noise
/// allows in so many rows, or somewhat less where one slip (unit, swapped columns, transposed digits, sign,
/// decimal point) brings it back. A slip is told as the reason of a single row only where none of so many would bring
/// it back by accident. `before`: rows that were flagged before they could become shots. A cluster most of whose rows
/// are flagged is one finding, with what stands in its column where another column shows it. `clean`: the fit leaves no
/// structure; else its own misfit has tails, and a row must stand out from those.
Screening screen(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                 const std::vector<ColumnUse>& uses, const Fit& fit, bool clean, const std::vector<RowFlag>& before);

}  // namespace hosel::loop
