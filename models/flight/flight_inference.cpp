#include "models/flight/flight_inference.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golf/parallel.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

constexpr FlightOptions kExact = {.tolerance = 1e-8};  // differences of paths are taken: they are 1e4 times that

/// Steps of the differences: they move a path by centimetres, far above the integration's error.
constexpr std::array<double, kShotUnknowns> kStep = {1e-3, 1e-3, 1e-3, 1e-3, 1e-2, 1e-4, 1e-4, 2e-2, 2e-2};
constexpr double kWindStep = 0.05, kLawStep = 1e-3;  // [m/s]; of a coefficient's standard deviation

constexpr double kFarthest = 1;   // of a shot's step, standard deviations told of an unknown
constexpr double kSettled = 0.1;  // standard errors: a step below that is the estimate
constexpr int kFullSteps = 6;     // of the search, before half ones
constexpr int kWeighing = 16;     // steps after which the weights stay: then one sum is brought down

/// Student weight of a shot by its misfit over the median one: half at six times it.
double student(double over_median) { return 1 / (1 + std::pow(over_median / 6, 2)); }

/// One shot about the present estimate: residuals and their derivatives by its own unknowns, the wind, the law.
struct Linear {
  Eigen::VectorXd r;
  Eigen::MatrixXd own, shared;
};

/// A shot's own unknowns in terms of the shared ones: u = -(constant + slope d), d the change of what is shared.
struct Eliminated {
  Eigen::VectorXd constant;
  Eigen::MatrixXd slope;
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
    for (const MeasuredPath& s : shots) {
      if (s.times.empty() || s.times.size() != s.positions.size())
        throw std::invalid_argument("flight paths: shot " + s.id + " has no readings, or not one a time");
      if (s.group < 0 || s.group >= groups)
        throw std::invalid_argument("flight paths: shot " + s.id + " is of no group");
    }
  }

  PathFit run() {
    // The law is let free once the shots lie about right: far from them its slopes mean nothing.
    for (int i = 0; i < 4; ++i) step(false);
    constexpr int most = 80;
    const bool law = !law_sd_.empty();
    for (double change = 1; change > kSettled;) {
      if (fit_.iterations == most)
        throw solvers::NonConvergence("flight paths: after " + std::to_string(most) +
                                      " steps the estimate still moves by " + std::to_string(change) +
                                      " standard errors");
      change = step(law);
    }
    return std::move(fit_);
  }

 private:
  int coefficients(bool law) const { return law ? kInferredCoefficients : 0; }
  int winds() const { return 2 * int(fit_.winds.size()); }

  Eigen::VectorXd residual(std::size_t i, const ShotUnknowns& own, const GroupWind& wind, const FlightLaw& law) const {
    const MeasuredPath& s = shots_[i];
    const auto at =
        models::follow(launched(s.launch, own), model_.ball, conditions_of(s, model_, law, own, wind), s.times, kExact);
    Eigen::VectorXd r(3 * Eigen::Index(s.times.size()));
    for (std::size_t k = 0; k < s.times.size(); ++k)
      r.segment<3>(3 * Eigen::Index(k)) = (at[k].position - s.positions[k]) / model_.noise;
    return r;
  }

  Linear linear(std::size_t i, bool law) const {
    const MeasuredPath& s = shots_[i];
    const GroupWind& wind = fit_.winds[std::size_t(s.group)];
    Linear out{.r = residual(i, fit_.shots[i], wind, fit_.law), .own = {}, .shared = {}};
    out.own = Eigen::MatrixXd::Zero(out.r.size(), kShotUnknowns);
    out.shared = Eigen::MatrixXd::Zero(out.r.size(), winds() + coefficients(law));
    for (int k = 0; k < kShotUnknowns; ++k) {
      if (!(s.sd[k] > 0)) continue;
      ShotUnknowns moved = fit_.shots[i];
      moved[k] += kStep[std::size_t(k)];
      out.own.col(k) = (residual(i, moved, wind, fit_.law) - out.r) / kStep[std::size_t(k)];
    }
    for (int k = 0; k < 2 && !hold_winds_; ++k) {
      GroupWind moved = wind;
      moved[k] += kWindStep;
      out.shared.col(2 * s.group + k) = (residual(i, fit_.shots[i], moved, fit_.law) - out.r) / kWindStep;
    }
    for (int k = 0; k < coefficients(law); ++k) {
      FlightLaw moved = fit_.law;
      const double h = kLawStep * law_sd_[std::size_t(k)];
      inferred_coefficient(moved, k) += h;
      out.shared.col(winds() + k) = (residual(i, fit_.shots[i], wind, moved) - out.r) / h;
    }
    return out;
  }

  /// One Gauss-Newton step of everything; returns the largest change of what is shared, in its standard errors, or a
  /// fifth of that of what a shot has of its own, in the standard deviations told of it.
  double step(bool law) {
    const int shared = winds() + coefficients(law);
    std::vector<Linear> at(shots_.size());
    for_all(std::size_t(0), shots_.size(), [&](std::size_t i) { at[i] = linear(i, law); });
    reweigh(at);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(shared, shared);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(shared);
    std::vector<Eliminated> own(shots_.size());
    for (std::size_t i = 0; i < shots_.size(); ++i) {
      const double w = fit_.weight[i];
      const Linear& l = at[i];
      Eigen::MatrixXd A = w * (l.own.transpose() * l.own);
      Eigen::VectorXd b = w * (l.own.transpose() * l.r);
      for (int k = 0; k < kShotUnknowns; ++k) {
        const double sd = shots_[i].sd[k];
        A(k, k) += sd > 0 ? 1 / (sd * sd) : 1;
        b[k] += sd > 0 ? fit_.shots[i][k] / (sd * sd) : 0;
      }
      const Eigen::LLT<Eigen::MatrixXd> solver(A);
      const Eigen::MatrixXd C = w * (l.own.transpose() * l.shared);
      own[i] = {solver.solve(b), solver.solve(C)};
      H += w * (l.shared.transpose() * l.shared) - C.transpose() * own[i].slope;
      g += w * (l.shared.transpose() * l.r) - C.transpose() * own[i].constant;
    }
    add_priors(H, g, law);
    const Eigen::LLT<Eigen::MatrixXd> solver(H);
    if (solver.info() != Eigen::Success)
      throw solvers::NonConvergence("flight paths: the normal matrix is not positive");
    // Full steps overshoot where shots go on to bend as the law moves: they end in two points by turns.
    const double share = fit_.iterations < kFullSteps ? 1 : 0.5;
    const Eigen::VectorXd d = -solver.solve(g) * share;
    const Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(shared, shared));
    double largest = d.cwiseAbs().cwiseQuotient(covariance.diagonal().cwiseSqrt()).maxCoeff();
    for (std::size_t i = 0; i < shots_.size(); ++i) {
      ShotUnknowns change = share * own[i].constant + own[i].slope * d;
      // A trust region: far from its path a shot's slopes say little of where it would go.
      double far = 0;
      for (int k = 0; k < kShotUnknowns; ++k)
        if (shots_[i].sd[k] > 0) far = std::max(far, std::abs(change[k]) / shots_[i].sd[k]);
      if (far > kFarthest) change *= kFarthest / far;
      fit_.shots[i] -= change;
      for (int k = 0; k < kShotUnknowns && fit_.weight[i] > 0.5; ++k)
        if (shots_[i].sd[k] > 0) largest = std::max(largest, 0.2 * std::abs(change[k]) / shots_[i].sd[k]);
    }
    fit_.wind_sd.clear();
    for (std::size_t k = 0; k < fit_.winds.size(); ++k) {
      if (!hold_winds_) fit_.winds[k] += d.segment<2>(2 * Eigen::Index(k));
      fit_.wind_sd.emplace_back(covariance.diagonal().segment<2>(2 * Eigen::Index(k)).cwiseSqrt());
    }
    for (int k = 0; k < coefficients(law); ++k) inferred_coefficient(fit_.law, k) += d[winds() + k];
    if (law) {
      const Eigen::MatrixXd of_law = covariance.bottomRightCorner(kInferredCoefficients, kInferredCoefficients);
      fit_.law.covariance.assign(of_law.data(), of_law.data() + of_law.size());
    }
    ++fit_.iterations;
    return largest;
  }

  void reweigh(const std::vector<Linear>& at) {
    double square = 0, readings = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      double sum = at[i].r.squaredNorm();
      for (int k = 0; k < kShotUnknowns; ++k)
        if (shots_[i].sd[k] > 0) sum += std::pow(fit_.shots[i][k] / shots_[i].sd[k], 2);
      fit_.misfit[i] = sum / double(at[i].r.size());
    }
    std::vector<double> sorted = fit_.misfit;
    std::ranges::nth_element(sorted, sorted.begin() + std::ptrdiff_t(sorted.size() / 2));
    const double median = sorted[sorted.size() / 2];
    for (std::size_t i = 0; i < at.size(); ++i) {
      // Below the noise a misfit is no reason to doubt a shot more than another.
      if (fit_.iterations < kWeighing) fit_.weight[i] = median > 0 ? student(fit_.misfit[i] / median) : 1;
      square += fit_.weight[i] * at[i].r.squaredNorm();
      readings += fit_.weight[i] * double(at[i].r.size());
    }
    fit_.rms = model_.noise * std::sqrt(square / readings);
  }

  void add_priors(Eigen::MatrixXd& H, Eigen::VectorXd& g, bool law) const {
    if (hold_winds_) {
      H.diagonal().head(winds()).setOnes();
      g.head(winds()).setZero();
    } else {
      const double wind = 1 / (model_.wind_sd * model_.wind_sd), n = double(fit_.winds.size()),
                   mean = 1 / (model_.mean_wind_sd * model_.mean_wind_sd * n * n);
      for (int k = 0; k < 2; ++k) {
        double sum = 0;
        for (const GroupWind& w : fit_.winds) sum += w[k];
        for (int a = k; a < winds(); a += 2) {
          H(a, a) += wind;
          g[a] += wind * fit_.winds[std::size_t(a / 2)][k] + mean * sum;
          for (int b = k; b < winds(); b += 2) H(a, b) += mean;
        }
      }
    }
    FlightLaw now = fit_.law, before = start_;
    for (int k = 0; k < coefficients(law); ++k) {
      const double sd = law_sd_[std::size_t(k)];
      H(winds() + k, winds() + k) += 1 / (sd * sd);
      g[winds() + k] += (inferred_coefficient(now, k) - inferred_coefficient(before, k)) / (sd * sd);
    }
  }

  const std::vector<MeasuredPath>& shots_;
  const PathModel& model_;
  const std::vector<double> law_sd_;
  const FlightLaw start_;
  const bool hold_winds_;
  PathFit fit_;
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
