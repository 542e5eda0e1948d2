/// What the residual of a record is made of: the level and colour of its noise, and what is left in it, by time and
/// by frequency.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hosel/loop/history/problem.hpp"

namespace hosel::loop {

struct Colour {
  double sigma = 0;  ///< standard deviation
  double rho = 0;    ///< correlation of neighbours, 0 to 0.98
};

/// From the training stretches of a channel's residuals, by the medians of their periodograms' logarithms: an
/// oscillation that a model lacks stands in a few frequencies and moves a median little. `white`: rho held at 0.
Colour colour(const HistoryProblem& problem, const std::vector<Eigen::MatrixXd>& residuals, int channel, bool white);

/// One statistic on the whitened residual of one channel, with its probability under white noise.
struct HistoryFinding {
  int channel = 0;
  std::string kind;    ///< constant, trend, oscillation, band, neighbours
  std::string detail;  ///< "at 4.1 Hz"
  double signal = 0;   ///< amplitude in units of its standard deviation
  double p = 1;        ///< of one test, before correction
  double p_adjusted = 1;
};

/// All tests on `z` (as HistoryProblem::whitened gives it), by rising p; adjusted for their number.
std::vector<HistoryFinding> history_structure(const HistoryProblem& problem, const Eigen::VectorXd& z);

}  // namespace hosel::loop
