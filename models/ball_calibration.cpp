#include "hosel/models/ball_calibration.hpp"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hosel/solvers/errors.hpp"

namespace hosel::models {
namespace {

/// Logarithms of the factors on long-term moduli, branch moduli and, the third if there is one, branch times.
using Logs = std::vector<double>;

FeBall scaled(FeBall ball, const Logs& logs) {
  const double elastic = std::exp(logs[0]), viscous = std::exp(logs[1]), time = logs.size() > 2 ? std::exp(logs[2]) : 1;
  for (BallLayer& layer : ball.layers) {
    if (layer.material.branches.empty())
      throw std::invalid_argument("calibration needs layers with relaxation branches");
    layer.material.elastic = layer.material.elastic.stiffened(elastic);
    for (auto& b : layer.material.branches) {
      b.modulus *= viscous;
      b.time *= time;
    }
  }
  return ball;
}

/// Residuals over sigmas with a one-sided difference Jacobian: the contact's discreteness leaves noise of
/// about 1e-4 in e, so the step is large.
class Residuals final : public ceres::CostFunction {
 public:
  Residuals(const FeImpactOptions& options, const Ball& ball, const NormalImpactTarget& target, int parameters,
            const std::function<void(int, double)>& progress)
      : options_(options), ball_(ball), target_(target), progress_(progress) {
    set_num_residuals(static_cast<int>(target.speeds.size()) + 1);
    mutable_parameter_block_sizes()->push_back(parameters);
  }

  std::vector<NormalImpactPoint> points(const Logs& logs) const {
    FeImpactOptions o = options_;
    o.ball = scaled(options_.ball, logs);
    std::vector<NormalImpactPoint> out;
    for (const double v : target_.speeds) {
      out.push_back(normal_impact(o, ball_, v));
      out.back().target = target_.restitution + target_.restitution_slope * v;
    }
    return out;
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    try {
      const int parameters = parameter_block_sizes().front();
      const Logs at(x[0], x[0] + parameters);
      values(at, residuals);
      if (!jacobians || !jacobians[0]) return true;
      std::vector<double> moved(static_cast<std::size_t>(num_residuals()));
      for (int p = 0; p < parameters; ++p) {
        Logs y = at;
        constexpr double h = 0.05;
        y[static_cast<std::size_t>(p)] += h;
        values(y, moved.data());
        for (int i = 0; i < num_residuals(); ++i)
          jacobians[0][i * parameters + p] = (moved[static_cast<std::size_t>(i)] - residuals[i]) / h;
      }
      return true;
    } catch (const solvers::NonConvergence&) {
      return false;  // Ceres takes a shorter step
    }
  }

  int evaluations() const { return evaluations_; }

 private:
  void values(const Logs& x, double* residuals) const {
    const auto all = points(x);
    double cost = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      residuals[i] = (all[i].restitution - all[i].target) / target_.restitution_sigma;
      if (all[i].speed == target_.contact_speed)
        residuals[all.size()] = (all[i].contact_time - target_.contact_time) / target_.contact_time_sigma;
    }
    for (int i = 0; i < num_residuals(); ++i) cost += 0.5 * residuals[i] * residuals[i];
    ++evaluations_;
    if (progress_) progress_(evaluations_, cost);
  }

  const FeImpactOptions& options_;
  const Ball& ball_;
  const NormalImpactTarget& target_;
  const std::function<void(int, double)>& progress_;
  mutable int evaluations_ = 0;
};

}  // namespace

NormalImpactPoint normal_impact(const FeImpactOptions& options, const Ball& ball, double speed) {
  Blow blow;
  blow.ball = ball;
  blow.club.head.mass = INFINITY;
  blow.delivery.club_speed = speed;
  const FeOutcome out = solve_free_body(blow, options);
  return {speed, 0, (out.launch.velocity.x() - speed) / speed, out.result.contact_time, out.result.peak_force};
}

BallCalibration calibrate_ball(const FeImpactOptions& options, const Ball& ball, const NormalImpactTarget& target,
                               bool hold_times, const std::function<void(int, double)>& progress) {
  if (std::find(target.speeds.begin(), target.speeds.end(), target.contact_speed) == target.speeds.end())
    throw std::invalid_argument("calibration: the speed of the contact time must be one of the speeds");
  const int parameters = hold_times ? 2 : 3;
  Logs logs(static_cast<std::size_t>(parameters), 0.0);
  Residuals residuals(options, ball, target, parameters, progress);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&residuals, nullptr, logs.data());
  for (int p = 0; p < parameters; ++p) {
    problem.SetParameterLowerBound(logs.data(), p, -3);
    problem.SetParameterUpperBound(logs.data(), p, 3);
  }
  ceres::Solver::Options solver;
  solver.max_num_iterations = 12;
  solver.function_tolerance = solver.parameter_tolerance = 1e-2;  // where the noise of e begins
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);

  BallCalibration out;
  out.ball = scaled(options.ball, logs);
  const fem::Solid& first = options.ball.layers.front().material;
  const fem::MaxwellBranch& branch0 = first.branches.front();
  out.names = {"long-term shear modulus [Pa]", "branch shear modulus [Pa]", "branch time [s]"};
  out.start = {first.shear(), branch0.modulus, branch0.time};
  out.names.resize(logs.size());
  out.start.resize(logs.size());
  for (std::size_t p = 0; p < logs.size(); ++p) out.values.push_back(out.start[p] * std::exp(logs[p]));
  out.points = residuals.points(logs);
  const int rows = residuals.num_residuals();
  std::vector<double> r(static_cast<std::size_t>(rows));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> J(rows, parameters);
  const double* x = logs.data();
  double* jacobian = J.data();
  if (!residuals.Evaluate(&x, r.data(), &jacobian))
    throw solvers::NonConvergence("calibration: the impact does not converge at the fitted parameters");
  out.covariance = (J.transpose() * J).inverse();
  for (double v : r) out.cost += 0.5 * v * v;
  out.evaluations = residuals.evaluations();
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  out.report = summary.BriefReport();
  return out;
}

}  // namespace hosel::models
