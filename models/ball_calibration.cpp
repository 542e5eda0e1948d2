#include "hosel/models/ball_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "hosel/solvers/errors.hpp"
#include "hosel/solvers/least_squares.hpp"

namespace hosel::models {
namespace {

/// `logs` of the factors on long-term moduli, branch moduli and, the third if there is one, branch times.
FeBall scaled(FeBall ball, const Eigen::VectorXd& logs) {
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
  const auto points = [&](const Eigen::VectorXd& logs) {
    FeImpactOptions o = options;
    o.ball = scaled(options.ball, logs);
    std::vector<NormalImpactPoint> all;
    for (const double v : target.speeds) {
      all.push_back(normal_impact(o, ball, v));
      all.back().target = target.restitution + target.restitution_slope * v;
    }
    return all;
  };
  int evaluations = 0;
  const auto residuals = [&](const Eigen::VectorXd& logs, Eigen::VectorXd& r) {
    try {
      Eigen::Index i = 0;
      for (const NormalImpactPoint& p : points(logs)) {
        r[i++] = (p.restitution - p.target) / target.restitution_sigma;
        if (p.speed == target.contact_speed)
          r[r.size() - 1] = (p.contact_time - target.contact_time) / target.contact_time_sigma;
      }
    } catch (const solvers::NonConvergence&) {
      return false;  // the search takes a shorter step
    }
    ++evaluations;
    if (progress) progress(evaluations, 0.5 * r.squaredNorm());
    return true;
  };
  // One-sided differences: the contact's discreteness leaves noise of about 1e-4 in e, so the step is large.
  const auto linearised = [&](const Eigen::VectorXd& logs, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
    constexpr double h = 0.05;
    if (!residuals(logs, r)) return false;
    J.resize(r.size(), logs.size());
    Eigen::VectorXd moved(r.size());
    for (Eigen::Index p = 0; p < logs.size(); ++p) {
      if (!residuals(logs + h * Eigen::VectorXd::Unit(logs.size(), p), moved)) return false;
      J.col(p) = (moved - r) / h;
    }
    return true;
  };
  const Eigen::Index parameters = hold_times ? 2 : 3, count = Eigen::Index(target.speeds.size()) + 1;
  const std::optional<solvers::Minimum> best =
      solvers::minimise({.residuals = int(count),
                         .bounds = std::vector<solvers::Bounds>(std::size_t(parameters), {-3, 3, 1}),
                         .value = residuals,
                         .linearised = linearised},
                        Eigen::VectorXd::Zero(parameters),
                        {.iterations = 12, .cost = 1e-2, .parameters = 1e-2});  // where the noise of e begins
  if (!best) throw solvers::NonConvergence("calibration: no impact of the ball to begin with");

  BallCalibration out;
  const Eigen::VectorXd& logs = best->parameters;
  out.ball = scaled(options.ball, logs);
  const fem::Solid& first = options.ball.layers.front().material;
  const fem::MaxwellBranch& branch0 = first.branches.front();
  out.names = {"long-term shear modulus [Pa]", "branch shear modulus [Pa]", "branch time [s]"};
  out.start = {first.shear(), branch0.modulus, branch0.time};
  out.names.resize(std::size_t(parameters));
  out.start.resize(std::size_t(parameters));
  for (Eigen::Index p = 0; p < parameters; ++p) out.values.push_back(out.start[std::size_t(p)] * std::exp(logs[p]));
  out.points = points(logs);
  Eigen::VectorXd r(count);
  Eigen::MatrixXd J;
  if (!linearised(logs, r, J))
    throw solvers::NonConvergence("calibration: the impact does not converge at the fitted parameters");
  out.covariance = solvers::covariance(J, 0);
  out.cost = 0.5 * r.squaredNorm();
  out.evaluations = evaluations;
  out.converged = best->converged;
  out.report = best->report;
  return out;
}

}  // namespace hosel::models
