/// Two populations in one set (two balls, two players, two settings) that no column separates.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace hosel::loop {

struct Mixture {
  double gain = 0;           ///< twice the log-likelihood above that of one population, normal or heavy-tailed
  double share = 0;          ///< of the second
  double apart = 0;          ///< their distance in standard deviations of either
  double deviation = 0;      ///< of either
  std::vector<int> rows;     ///< that were looked at
  std::vector<char> second;  ///< of these: whether it belongs to the second rather than to the first
};

/// Looks along every column of `z` and along its principal direction for two normal populations of the same scatter,
/// against one normal or Student population: the likelihood ratio, its largest. `z`: standardised residuals, rows x
/// channels, NaN where nothing was read: such a row is left out along what it lacks. Nothing where a share is below an
/// eighth or the two are not apart.
std::optional<Mixture> mixture(const Eigen::MatrixXd& z);

/// Standardised residuals, rows x channels, all finite, where an effect has that size; false where a blow cannot
/// happen.
using Residuals = std::function<bool(const Eigen::VectorXd& size, Eigen::MatrixXd& z)>;
/// Largest log-likelihood of one population: normal with a scatter per column, or Student.
double one_population(const Eigen::MatrixXd& z);
/// Two populations, of which the second alone has an effect: each row's place follows from the effect, not from one
/// direction common to all. `start` is where its size is searched from, within `low` and `high`; `one`: what one
/// population reaches. The gain has paid for the size. Nothing where more than a seventh of the rows cannot be told.
std::optional<Mixture> mixture(const Eigen::MatrixXd& first, const Residuals& second, const Eigen::VectorXd& start,
                               const Eigen::VectorXd& low, const Eigen::VectorXd& high, double one);

}  // namespace hosel::loop
