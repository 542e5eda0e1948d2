/// Attenuation: a noisy record is in the mean too far from the mean of all records, by the share of noise in its
/// variance.
#pragma once

#include <vector>

#include "loop/problem.hpp"
#include "loop/shots/model.hpp"
#include "loop/shots/shots.hpp"

namespace hosel::loop {

/// The forms of a fit that draw the records of an input to their mean and leave the mean where it is, to two errors:
/// noise of the records does so too. `covariance`: of the parameters [SI]; the rest as in `mechanisms`.
std::vector<Attenuation> attenuations(const ShotModel& model, const Shots& shots, const std::vector<int>& rows,
                                      const Fit& fit, const Eigen::MatrixXd& covariance);

}  // namespace hosel::loop
