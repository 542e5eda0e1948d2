#include "hosel/solvers/least_squares.hpp"

#include <ceres/ceres.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "hosel/solvers/errors.hpp"

namespace hosel::solvers {
namespace {

/// The whole problem as one cost function of parameters scaled to (0, 1), differences taken inside the
/// bounds.
class Cost final : public ceres::CostFunction {
 public:
  Cost(const Residuals& residuals, int count, const std::vector<Bounds>& bounds, double step)
      : residuals_(residuals), bounds_(bounds), step_(step) {
    set_num_residuals(count);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(bounds.size()));
  }

  Eigen::VectorXd physical(const double* x) const {
    Eigen::VectorXd p(bounds_.size());
    for (std::size_t i = 0; i < bounds_.size(); ++i) p[i] = bounds_[i].low + x[i] * (bounds_[i].high - bounds_[i].low);
    return p;
  }

  bool differences(const double* x, Eigen::MatrixXd& jacobian) const {
    const int n = static_cast<int>(bounds_.size());
    jacobian.resize(num_residuals(), n);
    std::vector<double> y(x, x + n);
    Eigen::VectorXd up(num_residuals()), down(num_residuals());
    for (int i = 0; i < n; ++i) {
      // Central, shifted at a bound.
      const double middle = std::clamp(x[i], step_, 1 - step_);
      y[i] = middle + step_;
      if (!residuals_(physical(y.data()), up)) return false;
      y[i] = middle - step_;
      if (!residuals_(physical(y.data()), down)) return false;
      jacobian.col(i) = (up - down) / (2 * step_);
      y[i] = x[i];
    }
    return true;
  }

  bool Evaluate(double const* const* x, double* r, double** J) const override {
    Eigen::VectorXd value(num_residuals());
    if (!residuals_(physical(x[0]), value)) return false;
    Eigen::Map<Eigen::VectorXd>(r, num_residuals()) = value;
    if (J && J[0]) {
      Eigen::MatrixXd jacobian;
      if (!differences(x[0], jacobian)) return false;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          J[0], num_residuals(), static_cast<int>(bounds_.size())) = jacobian;
    }
    return true;
  }

 private:
  const Residuals& residuals_;
  std::vector<Bounds> bounds_;
  double step_;
};

/// Ceres' losses act on a block; here every residual counts for itself, so the loss is applied before.
Residuals robust(const Residuals& plain, double knee) {
  return [&plain, knee](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
    if (!plain(p, r)) return false;
    for (double& v : r)
      if (std::abs(v) > knee) v = std::copysign(std::sqrt(2 * knee * std::abs(v) - knee * knee), v);
    return true;
  };
}

}  // namespace

LeastSquaresFit least_squares(const Residuals& plain, int count, const Eigen::VectorXd& start,
                              const std::vector<Bounds>& bounds, const LeastSquaresOptions& options) {
  const int n = static_cast<int>(bounds.size());
  for (const Bounds& b : bounds)
    if (!(b.low < b.high) || !std::isfinite(b.high - b.low))
      throw std::invalid_argument("least squares: bounds must be finite, low below high");
  const Residuals residuals = options.huber > 0 ? robust(plain, options.huber) : plain;
  Cost cost(residuals, count, bounds, options.step);
  ceres::Problem::Options keep;
  keep.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;

  std::mt19937_64 random(options.seed);
  const auto uniform = [&] { return (random() >> 11) * 0x1.0p-53; };
  struct Run {
    std::vector<double> x;
    double cost;
    bool converged;
  };
  std::vector<Run> runs;
  for (int k = 0; k < options.starts; ++k) {
    std::vector<double> x(n);
    for (int i = 0; i < n; ++i)
      x[i] = k == 0 ? std::clamp((start[i] - bounds[i].low) / (bounds[i].high - bounds[i].low), 0.0, 1.0)
                    : 0.05 + 0.9 * uniform();
    ceres::Problem problem(keep);
    problem.AddResidualBlock(&cost, nullptr, x.data());
    for (int i = 0; i < n; ++i) {
      problem.SetParameterLowerBound(x.data(), i, 0);
      problem.SetParameterUpperBound(x.data(), i, 1);
    }
    ceres::Solver::Options how;
    how.linear_solver_type = ceres::DENSE_QR;
    how.max_num_iterations = options.iterations;
    how.function_tolerance = 1e-9;
    how.parameter_tolerance = 1e-8;
    how.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(how, &problem, &summary);
    if (summary.IsSolutionUsable())
      runs.push_back({x, summary.final_cost, summary.termination_type == ceres::CONVERGENCE});
  }
  if (runs.empty()) throw NonConvergence("least squares: no start has an answer");
  std::ranges::sort(runs, {}, &Run::cost);
  if (!runs.front().converged)
    throw NonConvergence("least squares: the best start has not converged; allow more iterations");
  LeastSquaresFit fit;
  fit.parameters = cost.physical(runs.front().x.data());
  fit.cost = runs.front().cost;
  fit.converged = true;
  for (const Run& r : runs) fit.costs.push_back(r.cost);
  const Cost unrobust(plain, count, bounds, options.step);
  if (!unrobust.differences(runs.front().x.data(), fit.jacobian))
    throw NonConvergence("least squares: no derivative at the solution");
  for (int i = 0; i < n; ++i) fit.jacobian.col(i) /= bounds[i].high - bounds[i].low;
  return fit;
}

Identifiability identifiability(const Eigen::MatrixXd& whitened, const std::vector<Bounds>& bounds) {
  const int n = static_cast<int>(whitened.cols());
  Eigen::VectorXd scale(n);
  for (int i = 0; i < n; ++i) scale[i] = bounds[i].high - bounds[i].low;
  const Eigen::MatrixXd scaled = whitened * scale.asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
  Identifiability out;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n; ++k) {
    const double s = svd.singularValues()[k];
    const Eigen::VectorXd v = svd.matrixV().col(k);
    if (!(s > 1)) out.blind.push_back(v);  // sd along v above the bounds' distance
    const double variance = s > 1e-12 * svd.singularValues()[0] ? 1 / (s * s) : INFINITY;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (const double part = v[i] * v[j]; std::isfinite(variance) || std::abs(part) > 1e-12)
          covariance(i, j) += variance * part;
  }
  out.sd = covariance.diagonal().cwiseSqrt().cwiseProduct(scale);
  out.correlation = Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (i != j) {
        const double c = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
        // Two parameters of one blind direction: wholly tied, with the sign of their product.
        out.correlation(i, j) =
            std::isfinite(c) ? c : (std::isinf(covariance(i, j)) ? std::copysign(1.0, covariance(i, j)) : 0.0);
      }
  Eigen::MatrixXd unit = scaled;
  for (int i = 0; i < n; ++i)
    if (const double length = unit.col(i).norm(); length > 0) unit.col(i) /= length;
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(unit).singularValues();
  out.condition = values[n - 1] > 0 ? values[0] / values[n - 1] : INFINITY;
  return out;
}

}  // namespace hosel::solvers
