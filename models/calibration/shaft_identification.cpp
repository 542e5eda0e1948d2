#include "models/calibration/shaft_identification.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golf/shaft_library.hpp"
#include "solvers/errors.hpp"
#include "solvers/least_squares.hpp"

namespace hosel::models {
namespace {

/// Simulated minus measured deflection at every sample: leads, then droops.
Eigen::VectorXd errors(const Club& nominal, const SwingOptions& options, const MeasuredSwing& m, double scale,
                       double damping, long& shortened) {
  Club club = nominal;
  club.shaft = scaled(*nominal.shaft, scale, 1);
  club.shaft->damping_time = damping;
  Swing swing(club, options, {.motion = m.motion});
  const std::size_t n = m.times.size();
  Eigen::VectorXd out(static_cast<Eigen::Index>(2 * n));
  std::size_t k = 0;
  SwingSample last;
  bool first = true;
  swing.run(swing.start(m.begin, swing.equilibrium(m.begin)), m.end, [&](const SwingSample& now) {
    while (k < n && m.times[k] <= now.time + 1e-9) {
      const double w = first ? 1 : (m.times[k] - last.time) / (now.time - last.time);
      const auto i = static_cast<Eigen::Index>(k);
      out[i] = (first ? now.lead : (1 - w) * last.lead + w * now.lead) - m.lead[k];
      out[static_cast<Eigen::Index>(n) + i] = (first ? now.droop : (1 - w) * last.droop + w * now.droop) - m.droop[k];
      ++k;
    }
    last = now;
    first = false;
  });
  shortened += swing.counts().rejected;
  if (k < n) throw std::invalid_argument("a measured sample lies beyond the end of its swing");
  return out;
}

}  // namespace

std::vector<std::string> faults(const MeasuredSwing& m) {
  std::vector<std::string> out;
  if (m.times.empty()) out.emplace_back("a measured swing has no samples");
  for (std::size_t k = 1; k < m.times.size() && out.empty(); ++k)
    if (!(m.times[k] > m.times[k - 1])) out.emplace_back("the times of a measured swing do not rise");
  if (out.empty() && (m.times.front() < m.begin - 1e-9 || m.times.back() > m.end + 1e-9))
    out.push_back("a measured swing has samples from " + std::to_string(m.times.front()) + " to " +
                  std::to_string(m.times.back()) + " s, and runs from " + std::to_string(m.begin) + " to " +
                  std::to_string(m.end) + " s");
  return out;
}

ShaftIdentification identify_shaft(const Club& club, SwingOptions options, const std::vector<MeasuredSwing>& swings) {
  if (!club.shaft || !(club.shaft->damping_time > 0))
    throw std::invalid_argument("identification starts from a shaft with a damping time above zero");
  int samples = 0;
  for (const MeasuredSwing& m : swings) {
    if (const auto wrong = faults(m); !wrong.empty()) throw std::invalid_argument(wrong.front());
    if (m.train) samples += static_cast<int>(2 * m.times.size());
  }
  if (samples <= 2) throw std::invalid_argument("no swing to train on");
  options.tolerance = std::min(options.tolerance, 1e-9);  // what Newton leaves must not show in differences

  long shortened = 0;
  const auto all = [&](bool train, double scale, double damping) {
    Eigen::VectorXd out(0);
    shortened = 0;
    for (const MeasuredSwing& m : swings)
      if (m.train == train) {
        const Eigen::VectorXd e = errors(club, options, m, scale, damping, shortened);
        out.conservativeResize(out.size() + e.size());
        out.tail(e.size()) = e;
      }
    return out;
  };
  const auto rms = [&](bool train, double scale, double damping) {
    const Eigen::VectorXd e = all(train, scale, damping);
    return e.size() > 0 ? std::sqrt(e.squaredNorm() / static_cast<double>(e.size())) : 0.0;
  };
  const double guess = club.shaft->damping_time;
  ShaftIdentification out;
  out.train_before = rms(true, 1, guess);
  const bool holds_out = std::ranges::any_of(swings, [](const MeasuredSwing& m) { return !m.train; });
  if (holds_out) out.held_out = {.before = rms(false, 1, guess)};

  // In units of the error before, so that the search's tolerances are relative ones.
  const double unit = out.train_before > 0 ? out.train_before : 1;
  const solvers::Residuals residuals = [&](const Eigen::VectorXd& log, Eigen::VectorXd& r) {
    try {
      r = all(true, std::exp(log[0]), guess * std::exp(log[1])) / unit;
      return true;
    } catch (const solvers::NonConvergence&) {
      return false;  // no swing with such a shaft: a shorter step
    }
  };
  const std::vector<solvers::Bounds> bounds{{-std::log(10.0), std::log(10.0)}, {-std::log(1000.0), std::log(1000.0)}};
  const solvers::LeastSquaresFit fit =
      solvers::least_squares(residuals, samples, Eigen::Vector2d::Zero(), bounds, {.starts = 1});
  for (Eigen::Index i = 0; i < 2; ++i)
    if (std::abs(fit.parameters[i]) > 0.99 * bounds[static_cast<std::size_t>(i)].high)
      throw solvers::NonConvergence(
          i == 0 ? "identify-shaft: no stiffness within a factor of 10 of the nominal fits best"
                 : "identify-shaft: no damping within a factor of 1000 of the first guess fits best");
  out.bending_scale = std::exp(fit.parameters[0]);
  out.damping_time = guess * std::exp(fit.parameters[1]);
  const double variance = 2 * fit.cost / static_cast<double>(samples - 2);
  out.log_covariance = variance * solvers::covariance(fit.jacobian, 0);
  out.train_after = rms(true, out.bending_scale, out.damping_time);
  out.shortened_steps = shortened;
  if (holds_out) out.held_out->after = rms(false, out.bending_scale, out.damping_time);
  return out;
}

}  // namespace hosel::models
