/// What a finite-element solution is doubted for: the same of one blow and of every point of a study.
#pragma once

#include <string>
#include <vector>

#include "golf/blow.hpp"
#include "models/fe/impact.hpp"

namespace hosel::app {

struct SolutionDoubt {
  std::string what;
  double value, limit;
  std::string remedy;
  std::string sentence() const;
};
/// Energy that is unaccounted for, penetration and elastic slip, where they are above their limits.
std::vector<SolutionDoubt> solution_doubts(const Blow& blow, const models::FeOutcome& outcome);

/// What the blow can change: the energy of the relative motion, not that of a head that flies on [J].
double relative_energy(const Blow& blow, const models::FeOutcome& outcome);

}  // namespace hosel::app
