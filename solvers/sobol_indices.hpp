/// Shares of a function's variance over independent inputs: by each input alone, and with all that it does together
/// with others.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace hosel::solvers {

struct SobolIndices {
  Eigen::VectorXd first;  ///< of every input alone
  Eigen::VectorXd total;  ///< of every input, its interactions included: these may add up to more than 1
};

/// First-order indices by the estimator of Saltelli (2010), total ones by that of Jansen (1999) [@sobol-indices], over
/// `points` of Sobol's sequence in twice the inputs. `f` is asked with every input in [0, 1], of which each value is as
/// likely as any other; it is evaluated (inputs + 2) * points times. Zeros where `f` is the same everywhere. Throws
/// std::invalid_argument without inputs or points.
SobolIndices sobol_indices(const std::function<double(const Eigen::VectorXd&)>& f, Eigen::Index inputs,
                           std::size_t points);

}  // namespace hosel::solvers
