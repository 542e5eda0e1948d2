/// Scatter of a channel: a first estimate of its noise, and the ratio of scatter to the present noise.
#pragma once

#include "loop/shots/model.hpp"

namespace hosel::loop {

/// Scatter of a channel about a robust linear regression on the inputs (and their squares where rows allow):
/// a first idea of undeclared noise that no effect of smooth form can inflate.
double smooth_scatter(const ShotModel& model, const std::vector<int>& rows, int channel,
                      const Eigen::MatrixXd& residuals);

/// Of readings in units of their own sigma, of which a fit took up `fitted`; no square counts more than `kMostSquare`.
Scatter scatter_of(const std::vector<double>& readings, double fitted);
/// The same of a channel about a fit.
Scatter scatter(const ShotModel& model, const std::vector<int>& rows, int channel, const Eigen::MatrixXd& residuals,
                int fitted);

}  // namespace hosel::loop
