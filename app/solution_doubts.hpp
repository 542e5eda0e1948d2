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

/// Doubts of many blows: of each kind how many, and the worst. Kinds in the order in which they came.
struct WorstDoubt {
  std::string kind;
  std::size_t count = 0, blow = 0;  ///< the worst one's blow
  double size = 0;                  ///< without sign
  std::string sentence;
};
void note_doubt(std::vector<WorstDoubt>& worst, const std::string& kind, std::size_t blow, double size,
                const std::string& sentence);

/// What the blow can change: the energy of the relative motion, not that of a head that flies on [J].
double relative_energy(const Blow& blow, const models::FeOutcome& outcome);

}  // namespace hosel::app
