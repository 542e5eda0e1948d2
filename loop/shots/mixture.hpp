/// Two populations in one set (two balls, two players, two settings) that no column tells apart.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hosel::loop {

struct Mixture {
  double gain = 0;           ///< twice the log-likelihood above that of one population, normal or heavy-tailed
  double share = 0;          ///< of the second
  double apart = 0;          ///< their distance in standard deviations of either
  double deviation = 0;      ///< of either
  std::vector<char> second;  ///< rows that belong to it rather than to the first
};

/// Looks along every column of `z` and along its principal direction for two normal populations of the same scatter,
/// against one normal or Student population: the likelihood ratio, its largest. `z`: standardised residuals, rows x
/// channels. Nothing where a share is below an eighth or the two are not apart.
std::optional<Mixture> mixture(const Eigen::MatrixXd& z);

}  // namespace hosel::loop
