/// The residual of a record: level and colour of its noise, and tests for structure in time and in frequency.
#pragma once

#include "loop/history/problem.hpp"
#include "loop/structure.hpp"

namespace hosel::loop {

struct Colour {
  double sigma = 0;  ///< standard deviation
  double rho = 0;    ///< correlation of neighbours, 0 to 0.98
  double count = 0;  ///< of the readings it is found from
};

/// From the training stretches of a channel's residuals (rows of the problem x channels), by the medians of their
/// periodograms' logarithms: an oscillation that a model lacks stands in a few frequencies and moves a median little.
/// `white`: rho held at 0.
Colour colour(const HistoryProblem& problem, const Eigen::MatrixXd& residuals, int channel, bool white);

/// Tests on `z` (whitened training residuals of the problem) for a constant, trend, oscillation, bands and neighbours
/// alike, adjusted for their number; and for each of the directions, adjusted for theirs. By rising p.
StructureMap history_structure(const HistoryProblem& problem, const Eigen::VectorXd& z,
                               const Eigen::MatrixXd& directions);

}  // namespace hosel::loop
