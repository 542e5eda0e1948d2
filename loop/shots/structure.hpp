/// The test for structure in the residual of shots: the largest statistic over channel x regressor, calibrated by
/// flipping the signs of whole shots. It decides whether effects are tried, and names channel and regressor.
#pragma once

#include <functional>

#include "loop/fit.hpp"
#include "loop/shots/model.hpp"
#include "loop/shots/shots.hpp"
#include "loop/structure.hpp"

namespace hosel::loop {

struct Regressor {
  std::string column;  ///< header, "shot" for the order, "constant"
  std::string kind;    ///< constant, trend, curvature, interaction, group, step, oscillation, turn, response, gain, lag
  std::string detail;  ///< "with club_speed_mps", "= 7i", "at 8 % of the session"
  bool foreign = false;   ///< see Finding
  Eigen::VectorXd value;  ///< per shot of the model; centred, unit mean square over the rows
  int channel = -1;       ///< the only channel that it is tried on; -1: all
};

/// Regressors from the columns of the data over the rows, and per channel the instrument's own response: dead
/// bands, saturation, gain and lag of what the base model predicts. `row_of[shot]` is the row in `shots`.
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
/// oscillations over the session (`order` per shot, 0 to 1), shots in turn.
std::vector<Regressor> regressors(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                  const std::vector<Line>& lines, const Eigen::VectorXd& order);

/// What effects are selected on: whitened residuals in blocks of all channels, one a row.
struct Whitened {
  std::vector<int> rows;      ///< shot of the model, by which regressors are read
  std::vector<double> order;  ///< per row, place in the session
  /// A residual of `value` per row in one channel and none in the others, whitened.
  std::function<Eigen::VectorXd(int channel, const Eigen::VectorXd& value)> column;
};
/// Of the residual of `fit`, what it fitted projected out of every regressor; `directions`: whitened candidate
/// directions, each a regressor of its own (channel -1). The signs that are flipped are those of `near`'s residual: of
/// the best model, so that a strong effect does not hide in its own scatter; for a test of what remains `fit` itself.
/// Findings by falling |signal|; none where a model has no answer.
StructureMap structure(const Problem& problem, const Whitened& view, const Fit& fit, const Fit& near,
                       const std::vector<Regressor>& regressors, const Eigen::MatrixXd& directions, const Rules& rules);

/// Where structure sits: what remains after the best model if a foreign column drives it, else the map of the base,
/// before anything was fitted to it.
std::vector<Location> plainest_places(const Problem& problem, const Selection& selection);

}  // namespace hosel::loop
