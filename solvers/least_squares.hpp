/// Bounded robust nonlinear least squares, and what the data say about the parameters. Whoever fits anything
/// (tune, calibrations, the loop) calls this.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace hosel::solvers {

/// Whitened residuals of the parameters; false where there are none (the model has no answer there).
using Residuals = std::function<bool(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals)>;
/// The same with their derivatives, residuals x parameters.
using Linearised =
    std::function<bool(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals, Eigen::MatrixXd& jacobian)>;

struct Bounds {
  double low, high;           ///< finite, low < high
  double scale = high - low;  ///< a size that matters: unit of the search, measure of difference steps
};

/// Loss of a block of residuals with squared length s: s up to the knee. Beyond it linear in the length (Huber), or
/// logarithmic up to the cap and constant from there, so that a bad block counts the same whatever a model makes of it.
struct Loss {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  enum class Tail { linear, logarithmic };

  Tail tail = Tail::linear;
  double knee = kNever;  ///< squared length; infinite: least squares
  double cap = kNever;   ///< squared length; of a logarithmic tail
  int block = 1;         ///< residuals that are judged together

  double operator()(double s) const;
  double weight(double s) const;  ///< derivative: 1 up to the knee
  Loss uncapped() const { return {tail, knee, kNever, block}; }
  /// Sum over the blocks.
  double sum(const Eigen::VectorXd& residuals) const;
};

struct LeastSquares {
  int residuals = 0;  ///< their number
  std::vector<Bounds> bounds;
  Residuals value;
  Linearised linearised = {};  ///< empty: central differences of `value`
  double step = 1e-3;          ///< of those, in scales; kept inside the bounds
  Loss loss = {};
  int plain = 0;  ///< of the last residuals, which are squared whatever the loss
};

struct Tolerances {
  int iterations = 60;
  double cost = 1e-9;        ///< relative
  double parameters = 1e-8;  ///< relative
};

struct Minimum {
  Eigen::VectorXd parameters;
  double cost = 0;  ///< half the sum of the losses
  bool converged = false;
  std::string report;  ///< of the solver, one line
};

/// Trust region (Ceres) from one start, which is brought inside the bounds; nothing where there are no residuals at it.
/// Throws std::invalid_argument on bounds that are none.
std::optional<Minimum> minimise(const LeastSquares& problem, const Eigen::VectorXd& start, const Tolerances& until);

struct LeastSquaresOptions {
  int starts = 8;  ///< the given one and starts - 1 at random inside the bounds
  unsigned seed = 1;
  int iterations = 60;  ///< at most, per start
  double huber = 0;     ///< knee of the robust loss in units of noise per residual; 0: least squares
  double step = 1e-3;   ///< of the central differences, share of the bounds' scale
};

struct LeastSquaresFit {
  Eigen::VectorXd parameters;
  double cost = 0;            ///< half the sum of the losses
  std::vector<double> costs;  ///< of every start, the best first
  Eigen::MatrixXd jacobian;   ///< whitened, at the solution, without the loss
};

/// The best of several starts. Throws NonConvergence where no start has residuals or the best has not converged.
LeastSquaresFit least_squares(const Residuals& residuals, int count, const Eigen::VectorXd& start,
                              const std::vector<Bounds>& bounds, const LeastSquaresOptions& options = {});

/// Whether each parameter stands at an end of its bounds: within a thousandth of their distance.
std::vector<bool> at_bounds(const Eigen::VectorXd& parameters, const std::vector<Bounds>& bounds);

/// Covariance of parameters by the singular values of their whitened Jacobian. Along directions whose singular value
/// is not above `least` nothing is known: every parameter with a part in one is infinitely uncertain. `scores`: the
/// covariance of J^T r where it is not J^T J (the data scatter otherwise than whitened).
Eigen::MatrixXd covariance(const Eigen::MatrixXd& jacobian, double least, const Eigen::MatrixXd* scores = nullptr);

struct Identifiability {
  Eigen::VectorXd sd;  ///< infinite along what the data do not see
  Eigen::MatrixXd correlation;
  double condition = 0;                ///< of the Jacobian with columns of unit length
  std::vector<Eigen::VectorXd> blind;  ///< directions (in scales) that the data leave free
};

/// A direction is blind where its standard deviation exceeds the bounds' scale.
Identifiability identifiability(const Eigen::MatrixXd& whitened_jacobian, const std::vector<Bounds>& bounds);

}  // namespace hosel::solvers
