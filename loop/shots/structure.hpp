/// Is anything left in the residual of the shots? The largest statistic over channel x regressor, calibrated by
/// flipping the signs of whole shots: a gate, and a locator.
#pragma once

#include "hosel/loop/fit.hpp"
#include "hosel/loop/shots/model.hpp"
#include "hosel/loop/shots/shots.hpp"
#include "hosel/loop/structure.hpp"

namespace hosel::loop {

struct Regressor {
  std::string column;     ///< header, "shot" for the order, "constant"
  std::string kind;       ///< constant, trend, curvature, interaction, group, step, oscillation, response, lag
  std::string detail;     ///< "with club_speed_mps", "= 7i", "at shot 40"
  bool foreign = false;   ///< see Finding
  Eigen::VectorXd value;  ///< per shot of the model; centred, unit mean square over the rows
  int channel = -1;       ///< the only channel that it is tried on; -1: all
};

/// Regressors from the columns of the data over the rows, and per channel the instrument's own response: dead
/// bands, saturation and lag of what the base model predicts. `row_of[shot]` is the row in `shots`.
std::vector<Regressor> regressors(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                  const ShotModel& model);

/// `z` whitened residuals of the rows, `weights` per row, `nuisance` whitened Jacobian of what was fitted (its
/// span is projected out of every regressor), `directions` whitened candidate directions, each a regressor of its
/// own (channel -1). `noise` are the whitened residuals whose signs are flipped: those of the best model, so that a
/// strong effect does not hide in its own scatter; for a test of what remains the same as `z`. Findings by falling
/// |signal|.
StructureMap structure(const ShotModel& model, const std::vector<int>& rows, const Eigen::VectorXd& z,
                       const Eigen::VectorXd& noise, const Eigen::VectorXd& weights, const Eigen::MatrixXd& nuisance,
                       const std::vector<Regressor>& regressors, const Eigen::MatrixXd& directions, int flips,
                       unsigned long seed);

}  // namespace hosel::loop
