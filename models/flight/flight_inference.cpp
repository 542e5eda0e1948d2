#include "models/flight/flight_inference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "golf/dense.hpp"
#include "golf/parallel.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

constexpr FlightOptions kExact = {.tolerance = 1e-8};  // differences of paths are taken: they are 1e4 times that

/// Steps of the differences: they move a path by centimetres, far above the integration's error.
constexpr std::array<double, kShotUnknowns> kStep = {1e-3, 1e-3, 1e-3, 1e-3, 1e-2, 1e-4, 1e-4, 2e-2, 2e-2};
constexpr double kWindStep = 0.05, kLawStep = 1e-3;  // [m/s]; of a coefficient's standard deviation

constexpr double kShotSettled = 1e-3;  // of a shot's sum of squares (times its misfit): a step that brings less
constexpr double kShotRough = 0.1;  // the same where no step, however short, brings anything: the integration's jitter
constexpr int kShotSteps = 400;     // of one shot: a law by a table has a corner at each of its lines
constexpr double kSettled = 0.05;   // standard errors: a step of what is shared below that is the estimate
constexpr int kSteps = 60;          // of what is shared
constexpr int kFlat = 3;            // steps that brought no more than the shots' own tolerance
constexpr int kScaling = 5;         // steps after which the robust scale stays: then one sum is brought down
constexpr double kLoss = 6;         // median misfits at which a shot's weight has fallen to a half

/// One shot's residuals and their derivatives by its own unknowns.
struct OwnLinear {
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
  Eigen::VectorXd b;  ///< half the gradient of its sum of squares: about none, once it has settled
};

class Estimate {
 public:
  Estimate(const std::vector<MeasuredPath>& shots, int groups, const PathModel& model, FlightLaw law,
           std::vector<double> law_sd, std::vector<GroupWind> winds, bool hold_winds)
      : shots_(shots), model_(model), law_sd_(std::move(law_sd)), start_(law), hold_winds_(hold_winds) {
    fit_.law = std::move(law);
    fit_.shots.assign(shots.size(), ShotUnknowns::Zero());
    fit_.winds = winds.empty() ? std::vector<GroupWind>(std::size_t(groups), GroupWind::Zero()) : std::move(winds);
    fit_.weight.assign(shots.size(), 1);
    fit_.misfit.assign(shots.size(), 0);
    own_.resize(shots.size());
    for (const MeasuredPath& s : shots) {
      if (s.times.empty() || s.times.size() != s.positions.size())
        throw std::invalid_argument("flight paths: shot " + s.id + " has no readings, or not one a time");
      if (s.group < 0 || s.group >= groups)
        throw std::invalid_argument("flight paths: shot " + s.id + " is of no group");
    }
  }

  PathFit run() {
    settle_shots();
    set_scale();
    if (shared() > 0) {
      double change = 1;
      while (change > kSettled) {
        if (fit_.iterations == kSteps)
          throw solvers::NonConvergence("flight paths: after " + std::to_string(kSteps) +
                                        " steps the estimate still moves by " + std::to_string(change) +
                                        " standard errors");
        change = step();
        if (fit_.iterations < kScaling) change = 1;
        else if (flat_ >= kFlat && change < 10 * kSettled) break;  // nothing is left to bring down
      }
    }
    finish();
    return std::move(fit_);
  }

 private:
  int coefficients() const { return law_sd_.empty() ? 0 : kInferredCoefficients; }
  int winds() const { return hold_winds_ ? 0 : 2 * int(fit_.winds.size()); }
  int shared() const { return winds() + coefficients(); }

  Eigen::VectorXd residual(std::size_t i, const ShotUnknowns& own, const GroupWind& wind, const FlightLaw& law) const {
    const MeasuredPath& s = shots_[i];
    const auto at =
        models::follow(launched(s.launch, own), model_.ball, conditions_of(s, model_, law, own, wind), s.times, kExact);
    Eigen::VectorXd r(3 * Eigen::Index(s.times.size()));
    for (std::size_t k = 0; k < s.times.size(); ++k)
      r.segment<3>(3 * Eigen::Index(k)) = (at[k].position - s.positions[k]) / model_.noise;
    return r;
  }
  const GroupWind& wind_of(std::size_t i) const { return fit_.winds[std::size_t(shots_[i].group)]; }

  /// Squares of the unknowns over what is told of them.
  double told(std::size_t i, const ShotUnknowns& own) const {
    double sum = 0;
    for (int k = 0; k < kShotUnknowns; ++k)
      if (shots_[i].sd[k] > 0) sum += std::pow(own[k] / shots_[i].sd[k], 2);
    return sum;
  }
  Eigen::MatrixXd normal(std::size_t i, const OwnLinear& l) const {
    Eigen::MatrixXd A = l.J.transpose() * l.J;
    for (int k = 0; k < kShotUnknowns; ++k) A(k, k) += shots_[i].sd[k] > 0 ? 1 / std::pow(shots_[i].sd[k], 2) : 1;
    return A;
  }

  /// The shot's own unknowns at the present winds and law, by Levenberg and Marquardt; its misfit.
  void settle(std::size_t i) {
    ShotUnknowns& u = fit_.shots[i];
    OwnLinear& l = own_[i];
    l.r = residual(i, u, wind_of(i), fit_.law);
    double sum = l.r.squaredNorm() + told(i, u), damping = 1e-3;
    l.J = Eigen::MatrixXd::Zero(l.r.size(), kShotUnknowns);
    for (int n = 0, done = 0; !done; ++n) {
      for (int k = 0; k < kShotUnknowns; ++k) {
        if (!(shots_[i].sd[k] > 0)) continue;
        // Central: the gradient has to be right far from the path too, where residuals are large.
        ShotUnknowns more = u, less = u;
        const double h = kStep[std::size_t(k)];
        more[k] += h, less[k] -= h;
        l.J.col(k) = (residual(i, more, wind_of(i), fit_.law) - residual(i, less, wind_of(i), fit_.law)) / (2 * h);
      }
      const Eigen::MatrixXd A = normal(i, l);
      l.b = l.J.transpose() * l.r;
      for (int k = 0; k < kShotUnknowns; ++k)
        if (shots_[i].sd[k] > 0) l.b[k] += u[k] / std::pow(shots_[i].sd[k], 2);
      const double left = l.b.dot(dense::Cholesky(A).solve(l.b)) / std::max(1.0, sum / double(l.r.size()));
      done = left < kShotSettled;
      for (; !done; damping *= 4) {
        if (damping > 1e12 && left < kShotRough) {
          done = true;
          break;
        }
        if (n == kShotSteps || damping > 1e12)
          throw solvers::NonConvergence("flight paths: shot " + shots_[i].id + " does not settle with the law " +
                                        fit_.law.name);
        Eigen::MatrixXd damped = A;
        damped.diagonal() *= 1 + damping;
        const ShotUnknowns trial = u - dense::Cholesky(damped).solve(l.b);
        const Eigen::VectorXd r = residual(i, trial, wind_of(i), fit_.law);
        const double less = r.squaredNorm() + told(i, trial);
        if (std::isfinite(less) && less <= sum) {
          u = trial, l.r = r, sum = less, damping = std::max(damping / 6, 1e-9);
          break;
        }
      }
    }
    fit_.misfit[i] = sum / double(l.r.size());
  }
  void settle_shots() {
    for_all(std::size_t(0), shots_.size(), [&](std::size_t i) { settle(i); });
  }
  void set_scale() {
    std::vector<double> sorted = fit_.misfit;
    std::ranges::sort(sorted);
    const double median = 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
    scale_ = std::max(kLoss * median, std::numeric_limits<double>::min());
  }
  /// A shot's loss, s atan(m / s) of its misfit m over the scale s, has this derivative: its weight.
  double weight(std::size_t i) const { return 1 / (1 + std::pow(fit_.misfit[i] / scale_, 2)); }

  /// What is brought down: the shots' losses, and what is told of winds and law.
  double loss() const {
    double sum = 0;
    for (std::size_t i = 0; i < shots_.size(); ++i)
      sum += double(own_[i].r.size()) * scale_ * std::atan(fit_.misfit[i] / scale_);
    if (!hold_winds_) {
      const double n = double(fit_.winds.size());
      GroupWind mean = GroupWind::Zero();
      for (const GroupWind& w : fit_.winds) {
        mean += w / n;
        sum += w.squaredNorm() / std::pow(model_.wind_sd, 2);
      }
      sum += mean.squaredNorm() / std::pow(model_.mean_wind_sd, 2);
    }
    FlightLaw now = fit_.law, before = start_;
    for (int k = 0; k < coefficients(); ++k)
      sum += std::pow((inferred_coefficient(now, k) - inferred_coefficient(before, k)) / law_sd_[std::size_t(k)], 2);
    return sum;
  }

  Eigen::MatrixXd by_shared(std::size_t i) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(own_[i].r.size(), shared());
    const ShotUnknowns& u = fit_.shots[i];
    for (int k = 0; k < 2 && !hold_winds_; ++k) {
      GroupWind more = wind_of(i), less = more;
      more[k] += kWindStep, less[k] -= kWindStep;
      out.col(2 * shots_[i].group + k) = (residual(i, u, more, fit_.law) - residual(i, u, less, fit_.law)) /
                                         (2 * kWindStep);
    }
    for (int k = 0; k < coefficients(); ++k) {
      FlightLaw more = fit_.law, less = more;
      const double h = kLawStep * law_sd_[std::size_t(k)];
      inferred_coefficient(more, k) += h;
      inferred_coefficient(less, k) -= h;
      out.col(winds() + k) = (residual(i, u, wind_of(i), more) - residual(i, u, wind_of(i), less)) / (2 * h);
    }
    return out;
  }

  /// One Gauss-Newton step of what is shared, each shot's own unknowns at their best for it (variable projection);
  /// halved until the loss falls. Returns the largest change in standard errors.
  double step() {
    ++fit_.iterations;
    const int n = shared();
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::MatrixXd> follow(shots_.size()), part(shots_.size());
    std::vector<Eigen::VectorXd> pull(shots_.size());
    for_all(std::size_t(0), shots_.size(), [&](std::size_t i) {
      const OwnLinear& l = own_[i];
      const Eigen::MatrixXd S = by_shared(i), C = l.J.transpose() * S;
      follow[i] = dense::Cholesky(normal(i, l)).solve(C);
      part[i] = weight(i) * (S.transpose() * S - C.transpose() * follow[i]);
      pull[i] = weight(i) * (S.transpose() * l.r - follow[i].transpose() * l.b);
    });
    for (std::size_t i = 0; i < shots_.size(); ++i) {
      H += part[i];
      g += pull[i];
    }
    add_priors(H, g);
    const dense::Cholesky solver(H);
    if (!solver.positive()) throw solvers::NonConvergence("flight paths: the normal matrix is not positive");
    const Eigen::VectorXd d = -solver.solve(g);
    covariance_ = solver.inverse();
    const double largest = d.cwiseAbs().cwiseQuotient(covariance_.diagonal().cwiseSqrt()).maxCoeff();
    const double before = loss();
    const PathFit kept = fit_;
    const std::vector<OwnLinear> kept_own = own_;
    for (double share = 1;; share /= 2) {
      if (share < 1e-3) {  // the loss is flat to its round-off
        fit_ = kept;
        own_ = kept_own;
        if (largest > 10 * kSettled)
          throw solvers::NonConvergence("flight paths: no step brings the loss down, though " +
                                        std::to_string(largest) + " standard errors are left");
        return 0;
      }
      for (std::size_t k = 0; !hold_winds_ && k < fit_.winds.size(); ++k)
        fit_.winds[k] = kept.winds[k] + share * d.segment<2>(2 * Eigen::Index(k));
      for (int k = 0; k < coefficients(); ++k) {
        FlightLaw old = kept.law;
        inferred_coefficient(fit_.law, k) = inferred_coefficient(old, k) + share * d[winds() + k];
      }
      for (std::size_t i = 0; i < shots_.size(); ++i) fit_.shots[i] = kept.shots[i] - follow[i] * (share * d);
      settle_shots();
      const double now = loss(), rough = kShotSettled * double(shots_.size());
      if (now > before + rough) continue;
      flat_ = now > before - rough ? flat_ + 1 : 0;
      break;
    }
    if (fit_.iterations < kScaling) set_scale();
    return largest;
  }

  void add_priors(Eigen::MatrixXd& H, Eigen::VectorXd& g) const {
    const double wind = 1 / (model_.wind_sd * model_.wind_sd), n = double(fit_.winds.size()),
                 mean = 1 / (model_.mean_wind_sd * model_.mean_wind_sd * n * n);
    for (int k = 0; k < 2 && !hold_winds_; ++k) {
      double sum = 0;
      for (const GroupWind& w : fit_.winds) sum += w[k];
      for (int a = k; a < winds(); a += 2) {
        H(a, a) += wind;
        g[a] += wind * fit_.winds[std::size_t(a / 2)][k] + mean * sum;
        for (int b = k; b < winds(); b += 2) H(a, b) += mean;
      }
    }
    FlightLaw now = fit_.law, before = start_;
    for (int k = 0; k < coefficients(); ++k) {
      const double sd = law_sd_[std::size_t(k)];
      H(winds() + k, winds() + k) += 1 / (sd * sd);
      g[winds() + k] += (inferred_coefficient(now, k) - inferred_coefficient(before, k)) / (sd * sd);
    }
  }

  void finish() {
    double square = 0, readings = 0;
    for (std::size_t i = 0; i < shots_.size(); ++i) {
      fit_.weight[i] = weight(i);
      square += fit_.weight[i] * own_[i].r.squaredNorm();
      readings += fit_.weight[i] * double(own_[i].r.size());
    }
    fit_.rms = model_.noise * std::sqrt(square / readings);
    fit_.wind_sd.assign(fit_.winds.size(), Eigen::Vector2d::Zero());
    for (std::size_t k = 0; !hold_winds_ && k < fit_.winds.size(); ++k)
      fit_.wind_sd[k] = covariance_.diagonal().segment<2>(2 * Eigen::Index(k)).cwiseSqrt();
    if (coefficients() > 0) {
      const Eigen::MatrixXd of_law = covariance_.bottomRightCorner(kInferredCoefficients, kInferredCoefficients);
      fit_.law.covariance.assign(of_law.data(), of_law.data() + of_law.size());
    }
  }

  const std::vector<MeasuredPath>& shots_;
  const PathModel& model_;
  const std::vector<double> law_sd_;
  const FlightLaw start_;
  const bool hold_winds_;
  PathFit fit_;
  std::vector<OwnLinear> own_;
  double scale_ = 1;
  int flat_ = 0;  ///< steps in a row that brought nothing
  Eigen::MatrixXd covariance_;
};

}  // namespace

Launch launched(const Launch& seen, const ShotUnknowns& own) {
  const double speed = seen.ball_speed() + own[kOwnSpeed], up = seen.launch_angle() + own[kOwnAngle],
               right = seen.azimuth() + own[kOwnAzimuth];
  Launch l = seen;
  l.velocity = speed * Vec3(std::cos(up) * std::cos(right), -std::cos(up) * std::sin(right), std::sin(up));
  const Vec3 ahead(std::cos(right), -std::sin(right), 0);
  const Eigen::AngleAxisd turn(-own[kOwnAzimuth], Vec3::UnitZ()), tilt(own[kAxis], ahead);
  l.spin = std::exp(own[kLogSpin]) * (tilt * (turn * seen.spin));
  return l;
}

FlightConditions with_own(FlightConditions c, const ShotUnknowns& own, const GroupWind& group) {
  const GroupWind more = group + own.segment<2>(kGustAlong);
  if (!more.isZero(0)) {
    const GroupWind wind = more + c.wind.speed * GroupWind(std::cos(c.wind.towards), std::sin(c.wind.towards));
    c.wind.speed = wind.norm();
    c.wind.towards = std::atan2(wind[1], wind[0]);
  }
  c.law.drag_scale *= 1 + own[kOwnDrag];
  c.law.lift_scale *= 1 + own[kOwnLift];
  return c;
}

FlightConditions conditions_of(const MeasuredPath& s, const PathModel& model, const FlightLaw& law,
                               const ShotUnknowns& own, const GroupWind& group) {
  FlightConditions c{.law = law, .air = s.air, .wind = model.profile};
  c.wind.speed = 0;
  return with_own(std::move(c), own, group);
}

PathFit fit_paths(const std::vector<MeasuredPath>& shots, int groups, const PathModel& model, const FlightLaw& start,
                  const std::vector<double>& law_sd, std::vector<GroupWind> winds, bool hold_winds) {
  if (shots.empty()) throw std::invalid_argument("flight paths: there are none");
  if (!law_sd.empty() && law_sd.size() != kInferredCoefficients)
    throw std::invalid_argument("flight paths: " + std::to_string(law_sd.size()) + " standard deviations for the " +
                                std::to_string(kInferredCoefficients) + " coefficients of a law");
  return Estimate(shots, groups, model, start, law_sd, std::move(winds), hold_winds).run();
}

}  // namespace hosel::models
