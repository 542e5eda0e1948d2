#include "models/shaft_identification.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>

#include "golf/shaft_library.hpp"

namespace hosel::models {
namespace {

/// Simulated minus measured deflection at every sample: leads, then droops.
Eigen::VectorXd errors(const Club& nominal, const SwingOptions& options, const MeasuredSwing& m, double scale, double damping) {
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
  if (k < n) throw std::invalid_argument("a measured sample lies beyond the end of its swing");
  return out;
}

struct Cost {
  const Club& club;
  const SwingOptions& options;
  const MeasuredSwing& swing;
  bool operator()(const double* const* p, double* residual) const {
    const Eigen::VectorXd e = errors(club, options, swing, std::exp(p[0][0] - 1), club.shaft->damping_time * std::exp(p[0][1] - 1));
    Eigen::Map<Eigen::VectorXd>(residual, e.size()) = e;
    return true;
  }
};

}  // namespace

ShaftIdentification identify_shaft(const Club& club, const SwingOptions& options, const std::vector<MeasuredSwing>& swings) {
  if (!club.shaft || !(club.shaft->damping_time > 0))
    throw std::invalid_argument("identification starts from a shaft with a damping time above zero");
  // 1 + log of the ratio to the first guess: away from zero, where relative difference steps would vanish.
  std::array<double, 2> p{1, 1};
  ceres::Problem problem;
  Eigen::Index samples = 0;
  for (const MeasuredSwing& m : swings) {
    if (m.times.empty()) throw std::invalid_argument("a measured swing has no samples");
    if (!m.train) continue;
    ceres::NumericDiffOptions difference;
    difference.relative_step_size = 5e-3;
    auto* cost = new ceres::DynamicNumericDiffCostFunction<Cost, ceres::FORWARD>(new Cost{club, options, m}, ceres::TAKE_OWNERSHIP, difference);
    cost->AddParameterBlock(2);
    cost->SetNumResiduals(static_cast<int>(2 * m.times.size()));
    problem.AddResidualBlock(cost, nullptr, p.data());
    samples += static_cast<Eigen::Index>(2 * m.times.size());
  }
  if (samples == 0) throw std::invalid_argument("no swing to train on");

  ShaftIdentification out;
  const auto rms = [&](bool train, double scale, double damping) {
    double sum = 0;
    Eigen::Index n = 0;
    for (const MeasuredSwing& m : swings)
      if (m.train == train) {
        const Eigen::VectorXd e = errors(club, options, m, scale, damping);
        sum += e.squaredNorm();
        n += e.size();
      }
    return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0.0;
  };
  out.train_before = rms(true, 1, club.shaft->damping_time);
  out.holdout_before = rms(false, 1, club.shaft->damping_time);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  solver.max_num_iterations = 30;
  solver.function_tolerance = 1e-6;
  solver.parameter_tolerance = 1e-4;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  out.iterations = static_cast<int>(summary.iterations.size());
  out.bending_scale = std::exp(p[0] - 1);
  out.damping_time = club.shaft->damping_time * std::exp(p[1] - 1);

  ceres::Covariance covariance{ceres::Covariance::Options()};
  std::array<double, 4> log_covariance{};
  const std::vector<std::pair<const double*, const double*>> blocks{{p.data(), p.data()}};
  if (covariance.Compute(blocks, &problem)) {
    covariance.GetCovarianceBlock(p.data(), p.data(), log_covariance.data());
    const double noise = 2 * summary.final_cost / static_cast<double>(samples - 2);
    const Eigen::Vector2d d(out.bending_scale, out.damping_time);  // d exp(p)
    out.covariance = noise * d.asDiagonal() * Eigen::Map<const Eigen::Matrix2d>(log_covariance.data()) * d.asDiagonal();
  } else {
    out.converged = false;
  }
  out.train_after = rms(true, out.bending_scale, out.damping_time);
  out.holdout_after = rms(false, out.bending_scale, out.damping_time);
  return out;
}

}  // namespace hosel::models
