/// Is anything left in the residual? The largest statistic over channel x regressor, calibrated by flipping the
/// signs of whole shots (or whole clusters): a gate, and a locator.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hosel/loop/problem.hpp"

namespace hosel::loop {

struct Regressor {
  std::string column;     ///< header, "shot" for the order, "constant"
  std::string kind;       ///< constant, trend, curvature, interaction, group, step, oscillation, response, lag
  std::string detail;     ///< "with club_speed_mps", "= 7i", "at shot 40"
  bool foreign = false;   ///< no model of the family knows this column (unknown columns, clusters, order)
  Eigen::VectorXd value;  ///< per shot of the problem; centred, unit mean square over the rows
  int channel = -1;       ///< the only channel that it is tried on; -1: all
};

/// Regressors from the columns of the data over the rows, and per channel the instrument's own response: dead
/// bands, saturation and lag of what the base model predicts. `row_of[shot]` is the row in `shots`.
std::vector<Regressor> regressors(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                  const Problem& problem);

struct Finding {
  int channel = 0;        ///< -1: all channels
  int regressor = 0;      ///< -1: autocorrelation
  double statistic = 0;   ///< signed, in units of its standard deviation, self-normalised over the shots
  double signal = 0;      ///< the same in units of the declared noise
  double p_adjusted = 1;  ///< against the largest of all statistics under sign flips
};

struct StructureMap {
  std::vector<Finding> findings;  ///< every channel x regressor, by falling |signal|
  double p = 1;                   ///< of the largest statistic
  double threshold = 0;           ///< 99th percentile of the largest statistic under flips
};

/// `z` whitened residuals of the rows, `weights` per row, `nuisance` whitened Jacobian of what was fitted (its
/// span is projected out of every regressor), `directions` whitened candidate directions, each a regressor of its
/// own (channel -1, regressor index after the others). `cluster` gives whole clusters one sign where not empty.
/// `noise` are the whitened residuals whose signs are flipped: those of the best model, so that a strong effect
/// does not hide in its own scatter; for a test of what remains the same as `z`.
StructureMap structure(const Problem& problem, const std::vector<int>& rows, const Eigen::VectorXd& z,
                       const Eigen::VectorXd& noise, const Eigen::VectorXd& weights, const Eigen::MatrixXd& nuisance,
                       const std::vector<Regressor>& regressors, const Eigen::MatrixXd& directions,
                       const std::vector<int>& cluster, int flips, unsigned long seed);

/// The linear space of some regressors in all channels, whitened: nuisance for a second look.
Eigen::MatrixXd whitened_regressors(const Problem& problem, const std::vector<int>& rows,
                                    const std::vector<const Regressor*>& which);

/// Orthonormal basis of the column space.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

}  // namespace hosel::loop
