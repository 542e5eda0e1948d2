/// Is anything left in the residual of the shots? The largest statistic over channel x regressor, calibrated by
/// flipping the signs of whole shots: a gate, and a locator.
#pragma once

#include <functional>

#include "loop/fit.hpp"
#include "loop/shots/model.hpp"
#include "loop/shots/shots.hpp"
#include "loop/structure.hpp"

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

/// A column that may drive a residual: standardised over the rows when it is used.
struct Line {
  std::string name;
  bool foreign;       ///< see Finding
  Eigen::VectorXd x;  ///< per shot of the model, any unit
};
/// Of the shots' data: inputs as a fit sees them, columns that no model knows, the place in the session last.
std::vector<Line> columns_of(const Shots& shots, const std::vector<int>& row_of, const ShotModel& model);
/// Regressors from such columns: trends, curvatures, products of two, groups of the text columns, steps and
/// oscillations over the session (`order` per shot, 0 to 1).
std::vector<Regressor> regressors(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                  const std::vector<Line>& lines, const Eigen::VectorXd& order);

/// What the test needs of whitened residuals in blocks of `width`, one a row.
struct Whitened {
  int width;
  std::vector<double> order;  ///< per row, place in the session
  /// A residual of `value` per row in one channel and none in the others, whitened.
  std::function<Eigen::VectorXd(int channel, const Eigen::VectorXd& value)> column;
  std::function<const Channel&(int)> channel;
};
/// As below, of any such residuals; `rows[i]`: shot of the model in block i, by which regressors are read.
StructureMap structure(const Whitened& view, const std::vector<int>& rows, const Eigen::VectorXd& z,
                       const Eigen::VectorXd& noise, const Eigen::VectorXd& weights, const Eigen::MatrixXd& nuisance,
                       const std::vector<Regressor>& regressors, const Eigen::MatrixXd& directions, int flips,
                       unsigned long seed);

/// `z` whitened residuals of the rows, `weights` per row, `nuisance` whitened Jacobian of what was fitted (its
/// span is projected out of every regressor), `directions` whitened candidate directions, each a regressor of its
/// own (channel -1). `noise` are the whitened residuals whose signs are flipped: those of the best model, so that a
/// strong effect does not hide in its own scatter; for a test of what remains the same as `z`. Findings by falling
/// |signal|.
StructureMap structure(const ShotModel& model, const std::vector<int>& rows, const Eigen::VectorXd& z,
                       const Eigen::VectorXd& noise, const Eigen::VectorXd& weights, const Eigen::MatrixXd& nuisance,
                       const std::vector<Regressor>& regressors, const Eigen::MatrixXd& directions, int flips,
                       unsigned long seed);

/// Where structure sits: what remains after the best model if a foreign column drives it, else the map of the base,
/// before anything was fitted to it.
std::vector<Location> plainest_places(const Problem& problem, const Selection& selection);

}  // namespace hosel::loop
