/// Least squares of effects' parameters on whitened residuals.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hosel/loop/problem.hpp"

namespace hosel::loop {

/// Loss of a shot with squared Mahalanobis distance s: s up to the knee, knee (1 + log(s / knee)) up to the cap,
/// constant beyond, so that a bad row counts the same whatever a model makes of it. Knee infinite: least squares.
struct Loss {
  double knee = std::numeric_limits<double>::infinity();
  double cap = std::numeric_limits<double>::infinity();
  double operator()(double s) const {
    if (s <= knee) return s;
    return knee * (1 + std::log(std::min(s, cap) / knee));
  }
  double weight(double s) const { return s <= knee ? 1 : s <= cap ? knee / s : 0; }  ///< derivative
  Loss uncapped() const { return {knee, std::numeric_limits<double>::infinity()}; }
};

struct Fit {
  Model model;
  Eigen::VectorXd p;    ///< parameters [SI]
  double deviance = 0;  ///< sum of the losses
  bool converged = false;
  bool at_bound = false;  ///< a parameter at the edge of its plausible range (zero excepted)
  int size() const { return int(p.size()); }
};

/// Whitened residuals of the rows, stacked shot by shot (rows * width); a blow that cannot happen counts 100
/// noise units in every channel.
Eigen::VectorXd whitened(const Problem& problem, const std::vector<int>& rows, const Model& model,
                         const Eigen::VectorXd& p);
/// Their derivative by the parameters, per Parameter::scale.
Eigen::MatrixXd whitened_jacobian(const Problem& problem, const std::vector<int>& rows, const Model& model,
                                  const Eigen::VectorXd& p);
double deviance(const Eigen::VectorXd& whitened, int width, const Loss& loss);

/// Bounded nonlinear least squares from each of the starts (Ceres, trust region), first with the uncapped loss,
/// which sees far, then with the loss itself; the best. Starts in SI; only the `most` of least deviance are followed.
Fit fit(const Problem& problem, const std::vector<int>& rows, const Model& model,
        const std::vector<Eigen::VectorXd>& starts, const Loss& loss, std::size_t most = 2);
/// All combinations of the forms' own starting points, zero first, at most 128.
std::vector<Eigen::VectorXd> starts(const Model& model);

/// Standard deviations of the parameters [SI] from the whitened Jacobian; infinite along null vectors.
/// `sandwich` takes the scatter of the shots' scores in place of the declared noise.
Eigen::MatrixXd covariance(const Problem& problem, const std::vector<int>& rows, const Fit& fit, const Loss& loss,
                           bool sandwich);

}  // namespace hosel::loop
