/// Keys of the case that are found, point by point, so that an output is what is wanted of it.
///
///     [[solve]]    name, key, range, output, value, set, variants
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/answer.hpp"

namespace hosel::app {

struct StudySolve {
  std::string name;  ///< of the column that holds what was found
  std::string key;   ///< of the case, with its unit
  double low, high;  ///< between which it is sought, in that unit
  StudyOutput output;
  double value;                       ///< wanted, in the output's unit
  std::vector<std::string> set;       ///< keys that hold while it is sought, and not after
  std::vector<std::string> variants;  ///< for which it is sought; empty: all
};

/// In the order in which they are found; each holds while the next is sought.
std::vector<StudySolve> read_solves(Table root, const std::vector<std::string>& variants, bool flies);

/// The key's value at which the output is what is wanted. `answer`: the output [its unit], nothing where the model has
/// none. Throws solvers::NonConvergence where the ends of the range do not enclose it, or the output jumps over it.
double solve(const StudySolve& wanted, const std::function<std::optional<double>(double)>& answer);

}  // namespace hosel::app
