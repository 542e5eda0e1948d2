/// Bounded nonlinear least squares from several starts, and what the data say about the parameters.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace hosel::solvers {

/// Whitened residuals of the parameters; false where there are none (the model has no answer there).
using Residuals = std::function<bool(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals)>;

struct Bounds {
  double low, high;  ///< finite, low < high; their distance is the parameter's scale
};

struct LeastSquaresOptions {
  int starts = 8;  ///< the given one and starts - 1 at random inside the bounds
  unsigned seed = 1;
  int iterations = 60;  ///< at most, per start
  double huber = 0;     ///< knee of the robust loss in units of noise per residual; 0: least squares
  double step = 1e-3;   ///< of the central differences, share of the bounds' distance
};

struct LeastSquaresFit {
  Eigen::VectorXd parameters;
  double cost = 0;  ///< half the sum of the squared (robust: rho'd) residuals
  bool converged = false;
  std::vector<double> costs;  ///< of every start, the best first
  Eigen::MatrixXd jacobian;   ///< whitened, at the solution
};

/// Ceres, trust region. Throws NonConvergence where no start has residuals or none converges, and
/// std::invalid_argument on bounds that are none.
LeastSquaresFit least_squares(const Residuals& residuals, int count, const Eigen::VectorXd& start,
                              const std::vector<Bounds>& bounds, const LeastSquaresOptions& options = {});

/// Covariance from the singular values of the whitened Jacobian, with the columns scaled to the bounds.
struct Identifiability {
  Eigen::VectorXd sd;  ///< infinite along what the data do not see
  Eigen::MatrixXd correlation;
  double condition = 0;                ///< of the Jacobian with columns of unit length
  std::vector<Eigen::VectorXd> blind;  ///< directions (scaled by the bounds) that the data leave free
};

/// A direction is blind where its standard deviation exceeds the bounds' distance.
Identifiability identifiability(const Eigen::MatrixXd& whitened_jacobian, const std::vector<Bounds>& bounds);

}  // namespace hosel::solvers
