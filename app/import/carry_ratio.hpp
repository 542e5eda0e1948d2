/// Recorded carry over computed carry: what it says of the units of speed and carry.
#pragma once

#include <optional>
#include <vector>

namespace hosel::app {

/// Of the shots, in a unit; NaN where there is none.
struct Numbers {
  std::vector<double> value;
  double si = 1;
};

/// Recorded over computed carry in the median, of at most 25 shots that have speed and launch; a spin that is
/// missing is that of a middle iron, 5,000 rpm. Nothing where there are none.
std::optional<double> carry_ratio(const Numbers& speed, const Numbers& launch, const Numbers& spin,
                                  const Numbers& carry);

/// Other balls, air and laws change a carry by a tenth or two, a wrong unit by a factor of 1.4 at least: beyond
/// kCarryFits a unit is wrong, beyond kCarryDoubtful where another brings it within kUnitFits.
constexpr double kCarryFits = 1.45, kCarryDoubtful = 1.25, kUnitFits = 1.15;

}  // namespace hosel::app
