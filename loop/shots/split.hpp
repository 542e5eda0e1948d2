/// Which shots train and which are held out.
#pragma once

#include <random>

#include "loop/shots/case.hpp"
#include "loop/shots/model.hpp"

namespace hosel::loop {

struct Rows {
  std::vector<int> train, holdout;  ///< shots of the model

  std::vector<int> all() const;  ///< the former, then the latter
};

/// Whole clusters, by a seeded shuffle of their names in order of appearance, or single rows; never the most oblique
/// ones. `row_of[shot]` is the row of the file, `usable` the shots to be divided.
Rows split_rows(const ShotCase& c, const ShotModel& model, const std::vector<int>& row_of,
                const std::vector<int>& usable);

/// Whole clusters by a shuffle, until about this fraction of `all` is held: one that would overshoot by more than half
/// of it is left. Per member whether it is held.
std::vector<char> hold_out(const std::vector<std::vector<std::size_t>>& clusters, std::size_t all, double fraction,
                           std::mt19937_64& random);

}  // namespace hosel::loop
