#include "hosel/models/ball_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "hosel/models/fe_full_club.hpp"
#include "hosel/models/matched_launch.hpp"
#include "hosel/models/oblique.hpp"
#include "hosel/solvers/errors.hpp"
#include "hosel/solvers/least_squares.hpp"

namespace hosel::models {
namespace {

constexpr double kLaunchTolerance = 2e-4;  // [rad]; 0.05 % of an iron's spin, small against a step of the Jacobian

int count(const Fitted& f) { return 2 + f.branch_times + f.cover + f.friction + f.face; }

/// The options with the factors in place whose `logs` are given: on long-term moduli, branch moduli, then what `fitted`
/// says, in its order.
FeImpactOptions scaled(FeImpactOptions o, const Fitted& fitted, const Eigen::VectorXd& logs) {
  Eigen::Index next = 2;
  const double elastic = std::exp(logs[0]), viscous = std::exp(logs[1]);
  const double time = fitted.branch_times ? std::exp(logs[next++]) : 1;
  const double cover = fitted.cover ? std::exp(logs[next++]) : 1;
  if (fitted.friction) o.friction *= std::exp(logs[next++]);
  if (fitted.face) o.face->stiffness *= std::exp(logs[next++]);
  for (BallLayer& layer : o.ball.layers) {
    if (layer.material.branches.empty())
      throw std::invalid_argument("calibration needs layers with relaxation branches");
    const double own = &layer == &o.ball.layers.back() ? cover : 1;
    layer.material.elastic = layer.material.elastic.stiffened(elastic * own);
    for (auto& b : layer.material.branches) {
      b.modulus *= viscous * own;
      b.time *= time;
    }
  }
  return o;
}

/// The shot at its measured launch angle; `loft` is where the search begins, and what it finds.
ObliquePoint struck(const FeImpactOptions& options, const ObliqueTarget& shot, double& loft) {
  Blow blow = shot.blow;
  blow.delivery.dynamic_loft = loft;
  const FeFreeBody head(options);
  const FeFullClub club({options, {}});
  const ImpactModel& model = blow.club.shaft ? static_cast<const ImpactModel&>(club) : head;
  const MatchedLaunch found = match_launch_angle(model, blow, shot.launch_angle, kLaunchTolerance);
  loft = found.blow.delivery.dynamic_loft;
  return {shot.name,
          loft,
          shot.spin_rate,
          found.launch.spin_rate(),
          found.launch.ball_speed(),
          tangential_restitution(found.blow, found.launch).value_or(NAN)};
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
                               const std::vector<ObliqueTarget>& shots, const Fitted& fitted,
                               const std::function<void(int, double)>& progress) {
  if (std::find(target.speeds.begin(), target.speeds.end(), target.contact_speed) == target.speeds.end())
    throw std::invalid_argument("calibration: the speed of the contact time must be one of the speeds");
  if (shots.empty() && (fitted.cover || fitted.friction || fitted.face))
    throw std::invalid_argument(
        "calibration: a bounce sees neither the cover apart nor friction nor a club's face: give oblique shots");
  if (fitted.face && !options.face) throw std::invalid_argument("calibration: no face to begin with");
  const auto points = [&](const Eigen::VectorXd& logs) {
    FeImpactOptions o = scaled(options, fitted, logs);
    o.harmonics = 0;
    o.face.reset();
    std::vector<NormalImpactPoint> all;
    for (const double v : target.speeds) {
      all.push_back(normal_impact(o, ball, v));
      all.back().target = target.restitution + target.restitution_slope * v;
    }
    return all;
  };
  std::vector<double> lofts;  // the last ones found are the best guess
  for (const ObliqueTarget& shot : shots) lofts.push_back(shot.blow.delivery.dynamic_loft);
  const auto struck_all = [&](const Eigen::VectorXd& logs) {
    const FeImpactOptions o = scaled(options, fitted, logs);
    std::vector<ObliquePoint> all;
    for (std::size_t k = 0; k < shots.size(); ++k) all.push_back(struck(o, shots[k], lofts[k]));
    return all;
  };
  int evaluations = 0;
  const auto residuals = [&](const Eigen::VectorXd& logs, Eigen::VectorXd& r) {
    try {
      Eigen::Index i = 0;
      for (const NormalImpactPoint& p : points(logs)) {
        r[i++] = (p.restitution - p.target) / target.restitution_sigma;
        if (p.speed == target.contact_speed)
          r[Eigen::Index(target.speeds.size())] = (p.contact_time - target.contact_time) / target.contact_time_sigma;
      }
      const std::vector<ObliquePoint> found = struck_all(logs);
      for (std::size_t k = 0; k < shots.size(); ++k) {
        r[++i] = (found[k].spin_rate / found[k].target - 1) / shots[k].spin_sigma;
        if (shots[k].ball_speed) r[++i] = (found[k].ball_speed / *shots[k].ball_speed - 1) / shots[k].ball_speed_sigma;
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
  const auto speeds = std::ranges::count_if(shots, [](const ObliqueTarget& s) { return s.ball_speed.has_value(); });
  const Eigen::Index parameters = count(fitted), rows = Eigen::Index(target.speeds.size() + 1 + shots.size()) + speeds;
  const std::optional<solvers::Minimum> best =
      solvers::minimise({.residuals = int(rows),
                         .bounds = std::vector<solvers::Bounds>(std::size_t(parameters), {-3, 3, 1}),
                         .value = residuals,
                         .linearised = linearised},
                        Eigen::VectorXd::Zero(parameters),
                        {.iterations = 12, .cost = 1e-2, .parameters = 1e-2});  // where the noise of e begins
  if (!best) throw solvers::NonConvergence("calibration: no impact of the ball to begin with");

  BallCalibration out;
  const Eigen::VectorXd& logs = best->parameters;
  const FeImpactOptions fit = scaled(options, fitted, logs);
  out.ball = fit.ball;
  out.friction = fit.friction;
  out.face = fit.face;
  const fem::Solid& first = options.ball.layers.front().material;
  const auto say = [&](const char* name, double start) {
    out.names.emplace_back(name);
    out.start.push_back(start);
    out.values.push_back(start * std::exp(logs[Eigen::Index(out.values.size())]));
  };
  say("long-term shear modulus [Pa]", first.shear());
  say("branch shear modulus [Pa]", first.branches.front().modulus);
  if (fitted.branch_times) say("branch time [s]", first.branches.front().time);
  if (fitted.cover) say("cover over core [-]", options.ball.layers.back().material.shear() / first.shear());
  if (fitted.friction) say("friction [-]", options.friction);
  if (fitted.face) say("face stiffness [N/m]", options.face->stiffness);
  out.points = points(logs);
  out.shots = struck_all(logs);
  Eigen::VectorXd r(rows);
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
