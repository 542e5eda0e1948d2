#include "models/calibration/reduced_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <optional>
#include <stdexcept>

#include "golf/parallel.hpp"
#include "golf/units.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "models/rigid/stick_slip.hpp"
#include "solvers/errors.hpp"
#include "solvers/least_squares.hpp"

namespace hosel::models {
namespace {

/// A model as a function of its parameters, each inside its bounds.
struct Reduced {
  std::string name;
  std::vector<const char*> parameters;
  std::vector<solvers::Bounds> bounds;
  std::vector<Eigen::VectorXd> starts;  // the best of what they lead to is taken
  std::function<std::vector<Answer>(const Eigen::VectorXd&, const std::vector<Blow>&)> launches;
};

/// Which parameters end at a bound is added to `at_bound`.
Eigen::VectorXd fitted(const Reduced& model, const std::vector<Blow>& blows, const std::vector<Launch>& target,
                       std::vector<std::string>& at_bound) {
  constexpr double kTimeSd = 0.03;  // relative
  double speed = 0, spin = 0;
  for (const Launch& l : target) speed += l.ball_speed(), spin += l.spin_rate();
  // Of blows without spin, what rounding leaves of it says nothing.
  const double n = double(target.size()), speed_sd = 0.005 * speed / n, angle_sd = radians(0.3),
               least_spin_sd = 1e-3 * speed / n / blows.front().ball.radius,
               spin_sd = std::max(0.03 * spin / n, least_spin_sd);
  const auto residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    r.resize(Eigen::Index(7 * target.size()));
    const std::vector<Answer> answers = model.launches(x, blows);
    for (std::size_t k = 0; k < target.size(); ++k) {
      Launch l;
      try {
        l = answers[k].value();
      } catch (const solvers::NonConvergence&) { return false; } catch (const std::invalid_argument&) {
        return false;  // a law that no contact can have
      }
      const Launch& t = target[k];
      // A rigid model has no contact time.
      const double time = l.contact_time ? (*l.contact_time / t.contact_time.value() - 1) / kTimeSd : 0;
      r.segment<7>(Eigen::Index(7 * k)) << (l.ball_speed() - t.ball_speed()) / speed_sd,
          (l.launch_angle() - t.launch_angle()) / angle_sd, (l.azimuth() - t.azimuth()) / angle_sd,
          (l.spin - t.spin) / spin_sd, time;
    }
    return true;
  };
  std::optional<solvers::LeastSquaresFit> best;
  std::exception_ptr failed;
  for (const Eigen::VectorXd& start : model.starts) {
    try {
      const auto found = solvers::least_squares(residuals, int(7 * target.size()), start, model.bounds,
                                                {.starts = 1, .iterations = 400});
      if (!best || found.cost < best->cost) best = found;
    } catch (const solvers::NonConvergence&) { failed = std::current_exception(); }
  }
  if (!best) std::rethrow_exception(failed);
  const std::vector<bool> at_end = solvers::at_bounds(best->parameters, model.bounds);
  for (std::size_t k = 0; k < at_end.size(); ++k)
    if (at_end[k]) at_bound.push_back(model.name + ": " + model.parameters[k]);
  return best->parameters;
}

ReducedBand band(const std::string& name, const ImpactModel& model, const std::vector<Blow>& blows,
                 const std::vector<Launch>& target) {
  ReducedBand b{.model = name};
  const auto add = [&](double difference, double& rms, double& max) {
    rms += difference * difference / double(blows.size());
    max = std::max(max, std::abs(difference));
  };
  for (std::size_t k = 0; k < blows.size(); ++k) {
    const Launch l = model.launch(blows[k]), &t = target[k];
    add(l.ball_speed() - t.ball_speed(), b.ball_speed_rms, b.ball_speed_max);
    add(l.launch_angle() - t.launch_angle(), b.launch_angle_rms, b.launch_angle_max);
    add(l.azimuth() - t.azimuth(), b.azimuth_rms, b.azimuth_max);
    add((l.spin - t.spin).norm(), b.spin_rms, b.spin_max);
  }
  for (double* rms : {&b.ball_speed_rms, &b.launch_angle_rms, &b.azimuth_rms, &b.spin_rms}) *rms = std::sqrt(*rms);
  return b;
}

}  // namespace

ReducedCalibration calibrate_reduced(const FeImpactOptions& fe, const std::vector<Blow>& blows) {
  if (blows.size() < 4) throw std::invalid_argument("reduced models: fewer than four blows tell nothing");
  ReducedCalibration out;
  out.launches.resize(blows.size());
  const Impact model(fe);
  const double friction = blows.front().contact.patch.coefficient;
  for_all(std::size_t{0}, blows.size(), [&](std::size_t k) { out.launches[k] = model.launch(blows[k]); });

  const auto law = [&](const Eigen::VectorXd& x) {
    return ContactLaw{
        .restitution = x[0], .restitution_slope = x[1], .tangential_restitution = x[2], .friction = friction};
  };
  const Reduced rigid{"rigid-eccentric",
                      {"restitution", "slope of restitution", "tangential restitution"},
                      {{0.3, 1, 0.1}, {-0.02, 0.01, 0.002}, {-0.5, 1, 0.2}},
                      {Eigen::Vector3d(0.86, -0.0029, 0.2)},
                      [&](const Eigen::VectorXd& x, std::vector<Blow> ruled) {
                        for (Blow& b : ruled) b.contact = law(x);
                        return RigidEccentric().launches(ruled);
                      }};
  out.law = law(fitted(rigid, blows, out.launches, out.at_bound));

  const auto volume = [&](const Eigen::VectorXd& x) {
    VolumetricLaw v;
    v.volume_exponent = 0.6;  // the finite-element ball pushes like depth^1.2
    v.friction = v.static_friction = friction;
    v.stiffness = std::exp(x[0]);
    v.damping = x[1];
    v.joint_stiffness = std::exp(x[2]);
    v.joint_damping = std::exp(x[3]);
    v.cover_thickness = x[4];
    return v;
  };
  const Reduced volumetric{
      "volumetric",
      {"stiffness", "damping", "joint stiffness", "joint damping", "cover thickness"},
      {{std::log(1e8), std::log(1e11), 1},
       {0, 0.05, 0.005},
       {std::log(0.5), std::log(1e4), 1},
       {std::log(1e-4), std::log(1.0), 1},
       {3e-4, 8e-3, 1e-3}},
      // A joint slow against the contact, and one that swings back within it: either can be the local minimum.
      {Eigen::VectorXd{{std::log(6e9), 6e-3, std::log(30.0), std::log(5e-3), 2e-3}},
       Eigen::VectorXd{{std::log(9e9), 12e-3, std::log(500.0), std::log(15e-3), 1.5e-3}}},
      [&](const Eigen::VectorXd& x, const std::vector<Blow>& all) { return Volumetric(volume(x)).launches(all); }};
  out.volume = volume(fitted(volumetric, blows, out.launches, out.at_bound));

  const auto hertz = [&](const Eigen::VectorXd& x) {
    return HertzMawLaw{.modulus = std::exp(x[0]), .poisson = x[1], .friction = friction, .damping = x[2]};
  };
  const Reduced maw{
      "hertz-maw",
      {"modulus", "Poisson's ratio", "damping"},
      {{std::log(1e6), std::log(1e9), 1}, {0, 0.499, 0.1}, {0, 0.05, 0.005}},
      {Eigen::Vector3d(std::log(85e6), 0.4, 6e-3)},
      [&](const Eigen::VectorXd& x, const std::vector<Blow>& all) { return HertzMaw(hertz(x)).launches(all); }};
  out.hertz = hertz(fitted(maw, blows, out.launches, out.at_bound));

  std::vector<Blow> ruled = blows;
  for (Blow& b : ruled) b.contact = out.law;
  out.bands = {band("rigid-eccentric", RigidEccentric(), ruled, out.launches),
               band("stick-slip", StickSlip(), ruled, out.launches),
               band("volumetric", Volumetric(out.volume), blows, out.launches),
               band("hertz-maw", HertzMaw(out.hertz), blows, out.launches)};
  return out;
}

}  // namespace hosel::models
