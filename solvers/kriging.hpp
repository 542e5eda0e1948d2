/// A Gaussian process through the answers of a slow model: near a point that was asked its answer counts, far from all
/// of them a plane does, and everywhere the error to be expected is told.
#pragma once

#include <Eigen/Core>

namespace hosel::solvers {

/// Matern's correlation of smoothness 5/2 [@gp-ml], of squares of distances over the length.
Eigen::ArrayXXd matern(const Eigen::ArrayXXd& square);

/// Universal kriging [@gp-ml] of several outputs with one correlation: Matern's of smoothness 5/2 over a distance with
/// a length per input, and a nugget. Under it lies a plane, or a constant where the points are too few for one. Lengths
/// and nugget are those of largest restricted likelihood, by a search along one of them at a time.
class Kriging {
 public:
  /// What the likelihood chooses.
  struct Correlation {
    Eigen::VectorXd length;  ///< of every input
    double nugget = 1e-6;    ///< variance of one point alone over that of the process
  };

  /// How the likeliest is sought.
  struct Search {
    bool plane = true;  ///< below the process, where the points are enough for one; else a constant
    double gain = 0.1;  ///< of log likelihood, that a step along one length must bring
    /// First one length for all inputs and the nugget, over a grid: from points that are mostly noise no step along one
    /// of them alone leads away.
    bool together = false;
    int sweeps = 3;  ///< over all of them; 0: the correlation stays as it is
  };
  /// Of points that are mostly noise: a length of its own must be worth one unit.
  static Search noisy() { return {.plane = false, .gain = 1, .together = true}; }

  Kriging() = default;  ///< says nothing, of no output
  /// `x`: points x inputs, some two units wide; `y`: points x outputs. Throws NonConvergence where no correlation of
  /// the search is positive definite.
  Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y);
  /// `from`: where the search begins, e.g. that of fewer points.
  Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, Correlation from);
  Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const Search& search);
  Kriging(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, Correlation from, const Search& search);

  /// The same through many more points than can be factored together: of all functions that the plane and the
  /// covariances with this process's own points make up, the likeliest (the subset of regressors [@gp-ml, 8.3.1]). Its
  /// errors stay those of this process.
  Kriging through(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) const;

  Eigen::VectorXd operator()(const Eigen::VectorXd& x) const;
  /// Mean square of the error to be expected there, outputs x outputs.
  Eigen::MatrixXd error(const Eigen::VectorXd& x) const;
  /// How the errors of many points (a row each) go together: times `process` the covariance of two points' errors; its
  /// diagonal times that is `error`.
  Eigen::MatrixXd errors_together(const Eigen::MatrixXd& x) const;
  /// Covariance of the outputs about the plane.
  const Eigen::MatrixXd& process() const { return process_; }
  const Correlation& correlation() const { return correlation_; }

  /// What a reader elsewhere needs: the mean is plane^T (1, x) + weight^T matern(|points - x / length|). The plane has
  /// one row where it is a constant.
  struct Parts {
    Eigen::VectorXd length;
    double nugget;
    Eigen::MatrixXd points;         ///< over the lengths, inputs x points
    Eigen::MatrixXd plane, weight;  ///< a column an output
    Eigen::MatrixXd process;
  };
  Parts parts() const { return {correlation_.length, correlation_.nugget, points_, plane_, weight_, process_}; }

 private:
  Eigen::VectorXd covariances(const Eigen::VectorXd& x) const;
  Eigen::VectorXd trend(const Eigen::VectorXd& x) const;

  Correlation correlation_;
  Eigen::MatrixXd points_;    ///< over the lengths, inputs x points
  Eigen::ArrayXd square_;     ///< their squared distances from the origin
  Eigen::MatrixXd inverse_;   ///< of the lower factor of the points' correlation with the nugget: a square cannot round
                              ///< to less than none
  Eigen::MatrixXd of_trend_;  ///< inverse times the points' trend
  Eigen::MatrixXd plane_;     ///< coefficients, terms of the trend x outputs
  Eigen::MatrixXd plane_error_;  ///< their covariance over that of the process
  Eigen::MatrixXd weight_;       ///< points x outputs
  Eigen::MatrixXd process_;
};

}  // namespace hosel::solvers
