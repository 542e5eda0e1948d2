#include "models/calibration/ball_calibration.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "golf/dense.hpp"
#include "golf/parallel.hpp"
#include "models/fe/impact.hpp"
#include "models/matched_launch.hpp"
#include "models/oblique.hpp"
#include "models/sliding_friction.hpp"
#include "solvers/errors.hpp"
#include "solvers/least_squares.hpp"

namespace hosel::models {
namespace {

using Parameter = FreeParameter;
using What = FreeParameter::What;

constexpr double kLaunchTolerance = 2e-4;  // [rad]; 0.05 % of an iron's spin, small against a step of the Jacobian
constexpr double kStep = 0.05;             // of differences: the contact's discreteness leaves noise of about 1e-4 in e
constexpr int kWallSteps = 120;  // in a normal impact, which is cheap: coarser ones leave jumps in the contact time
constexpr double kHigh = 0.01, kMass = 0.01;  // units of impact_high [m] and head_mass [kg]

/// What a shot answers at its measured launch angle, and how the launch angle moves with the loft.
struct Struck {
  ObliquePoint point;
  double launch_angle = 0;  // reached, within the tolerance
};

class Fit {
 public:
  Fit(const BallCalibrationProblem& problem, const std::function<void(int, double)>& progress)
      : problem_(problem), progress_(progress) {
    for (const ObliqueTarget& shot : problem.shots) {
      lofts_.push_back(shot.blow.delivery.dynamic_loft);
      first_row_.push_back(rows_);
      if (shot.seen) rows_ += shot.ball_speed ? 2 : 1;
    }
    wall_rows_ = Eigen::Index(problem.wall.speeds.size()) + 1 + (problem.bounce ? 1 : 0);
    for (Eigen::Index& row : first_row_) row += wall_rows_;
    rows_ += wall_rows_;
    for (const Parameter& p : problem.free) priors_ += std::isfinite(p.sd);
  }

  Eigen::Index rows() const { return rows_ + priors_; }
  int blows() const { return blows_; }

  /// The ball and how it is solved, with the parameters in place.
  FeImpactOptions options(const Eigen::VectorXd& x) const {
    FeImpactOptions o = problem_.options;
    for (std::size_t k = 0; k < problem_.free.size(); ++k) {
      const Parameter& p = problem_.free[k];
      const double factor = std::exp(x[Eigen::Index(k)]);
      for (std::size_t i = 0; i < o.ball.layers.size(); ++i) {
        fem::Solid& material = o.ball.layers[i].material;
        if (p.what == What::long_term || (p.what == What::layer && p.layer == i))
          material.elastic = material.elastic.stiffened(factor);
        for (auto& branch : material.branches) {
          if (p.what == What::branches || (p.what == What::layer && p.layer == i)) branch.modulus *= factor;
          if (p.what == What::branch_times) branch.time *= factor;
        }
      }
    }
    return o;
  }

  ContactLaw contact(const Eigen::VectorXd& x) const {
    ContactLaw out{.patch = problem_.friction};
    for (std::size_t k = 0; k < problem_.free.size(); ++k)
      if (problem_.free[k].what == What::friction)
        slide(out.patch, out.patch.coefficient * std::exp(x[Eigen::Index(k)]));
    return out;
  }

  /// A shot's blow, with the parameters in place.
  Blow blow_of(const Eigen::VectorXd& x, std::size_t k) const {
    Blow blow = problem_.shots[k].blow;
    blow.contact = contact(x);
    for (std::size_t c = 0; c < problem_.free.size(); ++c) {
      const Parameter& p = problem_.free[c];
      if (!concerns(p, k)) continue;
      if (p.what == What::impact_high) blow.delivery.impact_high += kHigh * x[Eigen::Index(c)];
      if (p.what == What::head_mass) blow.club.head.mass += kMass * x[Eigen::Index(c)];
      if (p.what == What::face_stiffness) blow.club.head.compliance->stiffness *= std::exp(x[Eigen::Index(c)]);
    }
    return blow;
  }

  /// Everything at x. False where a blow has no answer.
  bool residuals(const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    if (at_.size() == x.size() && at_ == x) return r = r_, true;
    std::vector<NormalImpactPoint> points;
    std::vector<Struck> shots(problem_.shots.size());
    std::vector<double> lofts = lofts_;
    std::optional<double> bounce;
    try {
      points = wall(x);
      if (problem_.bounce) bounce = thrown(x);
      for_all(std::size_t{0}, shots.size(), [&](std::size_t k) {
        if (problem_.shots[k].seen) shots[k] = matched(x, k, lofts[k]);
      });
    } catch (const solvers::NonConvergence&) { return false; }  // the search takes a shorter step
    lofts_ = lofts;
    points_ = points;
    bounce_ = bounce;
    r.resize(rows());
    put_wall(points, bounce, r);
    for (std::size_t k = 0; k < shots.size(); ++k)
      if (problem_.shots[k].seen) put_shot(k, shots[k].point.spin_rate, shots[k].point.ball_speed, r);
    put_priors(x, r);
    at_ = x;
    r_ = r;
    shots_ = shots;
    if (progress_) progress_(blows_, 0.5 * r.squaredNorm());
    return true;
  }

  /// One-sided differences. A shot is struck at a fixed loft; what the launch angle moves by is taken back along the
  /// loft's own derivative, so that a column costs one blow a shot.
  bool linearised(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
    if (!residuals(x, r)) return false;
    const Eigen::Index n = x.size();
    J = Eigen::MatrixXd::Zero(rows(), n);
    std::atomic<bool> answered = true;
    const auto guarded = [&](const auto& work) {
      try {
        work();
      } catch (const solvers::NonConvergence&) { answered = false; }
    };
    for_all(Eigen::Index{0}, n, [&](Eigen::Index c) {
      if (problem_.free[std::size_t(c)].of_shots() || problem_.free[std::size_t(c)].what == What::friction) return;
      guarded([&] {
        const Eigen::VectorXd moved = x + kStep * Eigen::VectorXd::Unit(n, c);
        Eigen::VectorXd there = r;
        put_wall(wall(moved), problem_.bounce ? std::optional(thrown(moved)) : std::nullopt, there);
        J.col(c).head(wall_rows_) = (there - r).head(wall_rows_) / kStep;
      });
    });
    for (Eigen::Index c = 0; c < n && problem_.bounce; ++c)
      if (problem_.free[std::size_t(c)].what == What::friction)
        guarded([&] {
          const double moved = thrown(x + kStep * Eigen::VectorXd::Unit(n, c));
          J(wall_rows_ - 1, c) = (moved - *bounce_) / kStep / problem_.bounce->sigma;
        });
    for_all(std::size_t{0}, shots_.size(), [&](std::size_t k) {
      if (problem_.shots[k].seen) guarded([&] { shot_rows(x, k, J); });
    });
    Eigen::Index row = rows_;
    for (Eigen::Index c = 0; c < n; ++c)
      if (std::isfinite(problem_.free[std::size_t(c)].sd)) J(row++, c) = 1 / problem_.free[std::size_t(c)].sd;
    return answered;
  }

  /// A shot at its measured launch angle, seen or not; `loft` is where the search begins, and what it finds.
  Struck matched(const Eigen::VectorXd& x, std::size_t k, double& loft) {
    const ObliqueTarget& shot = problem_.shots[k];
    Blow blow = blow_of(x, k);
    blow.delivery.dynamic_loft = loft;
    const MatchedLaunch found = match_launch_angle(model(x, blow), blow, shot.launch_angle, kLaunchTolerance);
    blows_ += found.blows;
    loft = found.blow.delivery.dynamic_loft;
    return {{shot.name, shot.seen, loft, shot.spin_rate, found.launch.spin_rate(), found.launch.ball_speed(),
             tangential_restitution(found.blow, found.launch).value_or(NAN),
             launch_ratio(found.blow, found.launch).value_or(NAN)},
            found.launch.launch_angle()};
  }

  double loft(std::size_t k) const { return lofts_[k]; }
  const std::vector<NormalImpactPoint>& points() const { return points_; }
  std::optional<double> bounce() const { return bounce_; }
  const ObliquePoint& point(std::size_t k) const { return shots_[k].point; }
  Eigen::Index first_row(std::size_t k) const { return first_row_[k]; }
  Eigen::Index shot_rows(std::size_t k) const { return problem_.shots[k].ball_speed ? 2 : 1; }

  static bool concerns(const Parameter& p, std::size_t shot) {
    return std::ranges::find(p.shots, shot) != p.shots.end();
  }
  /// A parameter that no other seen shot tells anything of.
  bool own(const Parameter& p, std::size_t shot) const {
    return p.of_shots() && concerns(p, shot) &&
           std::ranges::count_if(p.shots, [&](std::size_t s) { return problem_.shots[s].seen; }) == 1;
  }

 private:
  Impact model(const Eigen::VectorXd& x, const Blow& blow) const {
    return blow.club.shaft ? Impact(options(x), ShaftMount{}) : Impact(options(x));
  }

  std::vector<NormalImpactPoint> wall(const Eigen::VectorXd& x) {
    FeImpactOptions o = options(x);
    o.harmonics = 0;
    o.steps_per_contact = std::max(o.steps_per_contact, kWallSteps);
    std::vector<NormalImpactPoint> all;
    for (std::size_t k = 0; k < problem_.wall.speeds.size(); ++k) {
      all.push_back(normal_impact(o, problem_.ball, problem_.wall.speeds[k]));
      all.back().target = problem_.wall.wanted(k);
      ++blows_;
    }
    return all;
  }

  double thrown(const Eigen::VectorXd& x) {
    ++blows_;
    return models::bounce(Impact(options(x)), problem_.ball, problem_.bounce->speed, problem_.bounce->angle, contact(x))
        .tangential_restitution;
  }

  Launch struck(const Eigen::VectorXd& x, std::size_t k, double loft) {
    ++blows_;
    Blow blow = blow_of(x, k);
    blow.delivery.dynamic_loft = loft;
    return model(x, blow).launch(blow);
  }

  void shot_rows(const Eigen::VectorXd& x, std::size_t k, Eigen::MatrixXd& J) {
    constexpr double kLoft = 0.01;  // [rad]
    const Struck& here = shots_[k];
    const auto difference = [&](const Launch& l, double step) -> Eigen::Vector3d {
      return Eigen::Vector3d(l.spin_rate() - here.point.spin_rate, l.ball_speed() - here.point.ball_speed,
                             l.launch_angle() - here.launch_angle) /
             step;
    };
    const Eigen::Vector3d by_loft = difference(struck(x, k, lofts_[k] + kLoft), kLoft);
    const ObliqueTarget& shot = problem_.shots[k];
    for (Eigen::Index c = 0; c < x.size(); ++c) {
      const Parameter& p = problem_.free[std::size_t(c)];
      if (p.of_shots() && !concerns(p, k)) continue;
      Eigen::Vector3d d = difference(struck(x + kStep * Eigen::VectorXd::Unit(x.size(), c), k, lofts_[k]), kStep);
      d -= by_loft * (d[2] / by_loft[2]);
      J(first_row_[k], c) = d[0] / shot.spin_rate / shot.spin_sigma;
      if (shot.ball_speed) J(first_row_[k] + 1, c) = d[1] / *shot.ball_speed / shot.ball_speed_sigma;
    }
  }

  void put_wall(const std::vector<NormalImpactPoint>& points, std::optional<double> bounce, Eigen::VectorXd& r) const {
    const NormalImpactTarget& target = problem_.wall;
    const auto n = Eigen::Index(points.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const NormalImpactPoint& p = points[std::size_t(i)];
      r[i] = (p.restitution - p.target) / target.restitution_sigma;
      if (p.speed == target.contact_speed) r[n] = (p.contact_time - target.contact_time) / target.contact_time_sigma;
    }
    if (bounce) r[n + 1] = (*bounce - problem_.bounce->tangential_restitution) / problem_.bounce->sigma;
  }

  void put_shot(std::size_t k, double spin_rate, double ball_speed, Eigen::VectorXd& r) const {
    const ObliqueTarget& shot = problem_.shots[k];
    r[first_row_[k]] = (spin_rate / shot.spin_rate - 1) / shot.spin_sigma;
    if (shot.ball_speed) r[first_row_[k] + 1] = (ball_speed / *shot.ball_speed - 1) / shot.ball_speed_sigma;
  }

  void put_priors(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    Eigen::Index row = rows_;
    for (std::size_t c = 0; c < problem_.free.size(); ++c)
      if (const Parameter& p = problem_.free[c]; std::isfinite(p.sd)) r[row++] = (x[Eigen::Index(c)] - p.prior) / p.sd;
  }

  const BallCalibrationProblem& problem_;
  const std::function<void(int, double)>& progress_;
  std::vector<double> lofts_;  // the last ones found are the best guess
  std::vector<Eigen::Index> first_row_;
  Eigen::Index wall_rows_ = 0, rows_ = 0, priors_ = 0;
  std::atomic<int> blows_ = 0;
  Eigen::VectorXd at_, r_;  // the last parameters that were answered, and what was found there
  std::vector<NormalImpactPoint> points_;
  std::optional<double> bounce_;
  std::vector<Struck> shots_;
};

/// Minimum of |r + J d|^2 over the chosen columns and rows.
Eigen::VectorXd gauss_newton(const Eigen::MatrixXd& J, const Eigen::VectorXd& r, const std::vector<Eigen::Index>& rows,
                             const std::vector<Eigen::Index>& columns) {
  const Eigen::MatrixXd A = J(rows, columns);
  return -dense::Ldlt(A.transpose() * A).solve(Eigen::VectorXd(A.transpose() * r(rows)));
}

/// Parameters without a shot: shared ones from all other rows, its own from its rows.
Eigen::VectorXd without(const Fit& fit, const BallCalibrationProblem& problem, std::size_t k, const Eigen::VectorXd& x,
                        const Eigen::VectorXd& r, const Eigen::MatrixXd& J) {
  std::vector<Eigen::Index> shared, own, others, its;
  for (Eigen::Index c = 0; c < x.size(); ++c) (fit.own(problem.free[std::size_t(c)], k) ? own : shared).push_back(c);
  const auto of_shot = [&](Eigen::Index row) {
    return row >= fit.first_row(k) && row < fit.first_row(k) + fit.shot_rows(k);
  };
  for (Eigen::Index row = 0; row < r.size(); ++row) {
    const bool prior_of_own = !own.empty() && (J(row, own).array() != 0).any() && !of_shot(row);
    (of_shot(row) || prior_of_own ? its : others).push_back(row);
  }
  // Against the same step with the shot's rows: where the search ended a little short, that is no part of the change.
  std::vector<Eigen::Index> all = others;
  for (const Eigen::Index row : its)
    if (of_shot(row)) all.push_back(row);
  Eigen::VectorXd moved = x;
  moved(shared) += gauss_newton(J, r, others, shared) - gauss_newton(J, r, all, shared);
  if (!own.empty()) moved(own) += gauss_newton(J, r + J * (moved - x), its, own);
  return moved;
}

void describe(BallCalibration& out, const BallCalibrationProblem& problem, const Eigen::VectorXd& x) {
  const auto& layers = problem.options.ball.layers;
  const fem::Solid& first = layers.front().material;
  for (std::size_t c = 0; c < problem.free.size(); ++c) {
    const Parameter& p = problem.free[c];
    const double v = x[Eigen::Index(c)];
    const auto say = [&](std::string name, double start, double value) {
      out.names.push_back(std::move(name));
      out.start.push_back(start);
      out.values.push_back(value);
    };
    const auto factor = [&](std::string name, double start) { say(std::move(name), start, start * std::exp(v)); };
    const std::string of = p.shots.empty() ? std::string() : " of " + problem.shots[p.shots.front()].name;
    switch (p.what) {
      case What::long_term: factor("long-term shear modulus [Pa]", first.shear()); break;
      case What::branches: factor("branch shear modulus [Pa]", first.branches.front().modulus); break;
      case What::branch_times: factor("branch time [s]", first.branches.front().time); break;
      case What::friction: factor("friction [-]", problem.friction.coefficient); break;
      case What::layer: {
        const double start = layers[p.layer].material.shear() / first.shear();
        const bool cover = p.layer + 1 == layers.size();
        factor((cover ? "cover" : "layer " + std::to_string(p.layer + 1)) + " over core [-]", start);
        break;
      }
      case What::face_stiffness:
        factor("face stiffness" + of + " [N/m]", problem.shots[p.shots.front()].blow.club.head.compliance->stiffness);
        break;
      case What::impact_high: say("struck higher" + of + " [m]", 0, kHigh * v); break;
      case What::head_mass: say("head heavier" + of + " [kg]", 0, kMass * v); break;
    }
    out.internal.push_back(v);
  }
}

}  // namespace

std::vector<std::string> BallCalibrationProblem::faults() const {
  std::vector<std::string> out;
  if (std::ranges::find(wall.speeds, wall.contact_speed) == wall.speeds.end())
    out.emplace_back("the speed of the contact time must be one of the speeds");
  if (!wall.restitutions.empty() && wall.restitutions.size() != wall.speeds.size())
    out.emplace_back("one restitution for each speed");
  for (const BallLayer& layer : options.ball.layers)
    if (layer.material.branches.empty()) out.emplace_back("calibration needs layers with relaxation branches");
  if (free.empty()) out.emplace_back("nothing is free");
  const bool oblique = bounce || std::ranges::any_of(shots, &ObliqueTarget::seen);
  for (const FreeParameter& p : free) {
    if (!oblique && (p.what == What::layer || p.what == What::friction))
      out.emplace_back("a bounce along the normal sees neither a layer apart nor friction: give oblique shots");
    if (p.what == What::layer && p.layer >= options.ball.layers.size()) out.emplace_back("the ball has no such layer");
    if (p.what == What::layer && p.layer == 0)
      out.emplace_back("moduli of layers are over those of the innermost, which long-term-moduli change");
    if (p.of_shots() && p.shots.empty()) out.emplace_back("a face, a strike or a head is some shot's: name it");
    for (const std::size_t s : p.shots)
      if (s >= shots.size() || (p.what == What::face_stiffness && !shots[s].blow.club.head.compliance))
        out.emplace_back("no face to begin with");
    if (!(p.sd > 0)) out.emplace_back("a standard deviation is positive");
  }
  return out;
}

NormalImpactPoint normal_impact(const FeImpactOptions& options, const Ball& ball, double speed) {
  Blow blow;
  blow.ball = ball;
  blow.club.head.mass = INFINITY;
  blow.delivery.club_speed = speed;
  const FeOutcome out = Impact(options).run(blow);
  return {speed, 0, (out.launch.velocity.x() - speed) / speed, out.result.contact_time, out.result.peak_force};
}

BallCalibration calibrate_ball(const BallCalibrationProblem& problem,
                               const std::function<void(int, double)>& progress) {
  if (const auto faults = problem.faults(); !faults.empty())
    throw std::invalid_argument("calibration: " + faults.front());
  Fit fit(problem, progress);
  const auto n = Eigen::Index(problem.free.size());
  Eigen::VectorXd start(n);
  for (Eigen::Index c = 0; c < n; ++c) start[c] = problem.free[std::size_t(c)].prior;
  const std::vector<solvers::Bounds> bounds(std::size_t(n), {-FreeParameter::kReach, FreeParameter::kReach, 1});
  const std::optional<solvers::Minimum> best =
      solvers::minimise({.residuals = int(fit.rows()),
                         .bounds = bounds,
                         .value = [&](const auto& x, auto& r) { return fit.residuals(x, r); },
                         .linearised = [&](const auto& x, auto& r, auto& J) { return fit.linearised(x, r, J); }},
                        start, {.iterations = 8, .cost = 1e-2, .parameters = 1e-2});  // where the noise of e begins
  if (!best) throw solvers::NonConvergence("calibration: no impact of the ball to begin with");

  BallCalibration out;
  const Eigen::VectorXd& x = best->parameters;
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
  if (!fit.linearised(x, r, J))
    throw solvers::NonConvergence("calibration: the impact does not converge at the fitted parameters");
  describe(out, problem, x);
  out.at_bound = solvers::at_bounds(x, bounds);
  const FeImpactOptions found = fit.options(x);
  out.ball = found.ball;
  out.friction = fit.contact(x).patch.coefficient;
  out.covariance = solvers::covariance(J, 0);
  out.cost = 0.5 * r.squaredNorm();
  out.points = fit.points();
  out.bounce = fit.bounce();
  for (std::size_t k = 0; k < problem.shots.size(); ++k) {
    out.faces.push_back(fit.blow_of(x, k).club.head.compliance);
    double loft = fit.loft(k);
    out.shots.push_back(problem.shots[k].seen ? fit.point(k) : fit.matched(x, k, loft).point);
    if (!problem.leave_one_out || !problem.shots[k].seen) continue;
    const Eigen::VectorXd moved = without(fit, problem, k, x, r, J);
    out.left_out.push_back(fit.matched(moved, k, loft).point);
    out.left_out_values.emplace_back(moved.data(), moved.data() + moved.size());
  }
  out.evaluations = fit.blows();
  out.converged = best->converged;
  out.report = best->report;
  return out;
}

}  // namespace hosel::models
