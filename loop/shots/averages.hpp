/// Rows that share a club, compared as their mean.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "loop/shots/shots.hpp"

namespace hosel::loop {

/// Where club speed, attack angle or the point of impact stand once for many shots, what made these shots differ was
/// not recorded, and no model can be asked about it. A loft that is found from every launch angle would take all of it
/// for loft; noise of the single shots would call 36 shots of seven clubs 36 independent facts about the clubs. Their
/// means know what the record explains, and the scatter about them, which needs no model, is the noise of a shot.
struct Averages {
  std::string by;          ///< column
  Shots single;            ///< rows as read
  std::vector<int> count;  ///< readings in every mean: the fewest of an output
  int degrees = 0;         ///< of freedom of the scatter
  /// Covariance of a single row about its mean, pooled over the clusters [SI]: every `Input`, then every `Output`;
  /// zero where nothing is recorded.
  Eigen::MatrixXd scatter;
  std::vector<std::string> notes;
};

inline constexpr int kFewestDegrees = 20;

/// One row for each value of the column, in order of appearance, which is its id; and what it is the mean of. A reading
/// far beyond the others of its cluster is left out, and a note says so. Throws DataError without the column, where
/// fewer than `kFewestDegrees` tell the scatter, or where a mean lacks an output.
std::pair<Shots, Averages> average(Shots shots, const std::string& by);

}  // namespace hosel::loop
