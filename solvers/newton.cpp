#include "hosel/solvers/newton.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>

#include "hosel/solvers/errors.hpp"

namespace hosel::solvers {

std::vector<std::string> NewtonOptions::faults() const {
  std::vector<std::string> out;
  if (!(residual_relative >= 0) || !(residual_absolute >= 0) || residual_relative + residual_absolute == 0)
    out.emplace_back("state a residual tolerance, relative or absolute, above zero");
  if (!(increment_vector > 0) || !(increment_rotation > 0))
    out.emplace_back("state both increment tolerances (infinity switches one off)");
  if (max_iterations < 1) out.emplace_back("allow at least one iteration");
  if (!(renew_above > 0) || !(renew_above <= 1)) out.emplace_back("renew_above lies in (0, 1]");
  return out;
}

Newton::Newton(const fem::System& system, SparseTangent& tangent, NewtonOptions options)
    : tangent_(tangent), options_(options) {
  if (const auto faults = options.faults(); !faults.empty()) throw std::invalid_argument("Newton: " + faults.front());
  std::vector<bool> full(static_cast<std::size_t>(system.layout.size()), false);
  for (const auto& b : system.layout.blocks())
    if (b.rotation)
      for (Index i = 0; i < 3; ++i) full[static_cast<std::size_t>(b.v + i)] = true;
  for (Index e : tangent.free_equations()) rotation_.push_back(full[static_cast<std::size_t>(e)]);
}

double Newton::increment_measure(const Vector& increment) const {
  double largest = 0;
  for (Index i = 0; i < increment.size(); ++i)
    largest = std::max(largest,
                       std::abs(increment[i]) / (rotation_[static_cast<std::size_t>(i)] ? options_.increment_rotation
                                                                                        : options_.increment_vector));
  return largest;
}

NewtonReport Newton::solve(const NewtonProblem& problem) {
  NewtonReport report;
  double increment = INFINITY;
  Vector r, last, direction;
  std::deque<Vector> moved, changed;  // pairs of increment and change of the Newton direction
  std::vector<double> shrinking;      // |r| since the factor was made or the solve began
  const auto evaluate = [&] {
    r = problem.residual(report.scale);
    report.residual = r.norm();
  };
  const auto tolerance = [&] {
    return options_.residual_relative * report.scale + options_.residual_absolute + round_off_;
  };
  const bool guarded = options_.acceleration > 0;
  const auto slow = [&] {
    const std::size_t n = shrinking.size(), back = options_.acceleration > 0 ? 3 : 1;
    return n > back && shrinking[n - 1] > options_.renew_above * shrinking[n - 1 - back];
  };
  const auto renew = [&] {
    round_off_ = problem.assemble();
    factors_.factorise(tangent_);
    ++report.factorisations;
    moved.clear();
    changed.clear();
    shrinking = {report.residual};
  };
  // The increment at the present iterate, from the factor and what its last increments brought about.
  const auto next = [&] {
    const Vector z = -factors_.solve(r);
    if (options_.acceleration > 0 && direction.size() > 0 && last.size() > 0) {
      moved.push_back(last);
      changed.push_back(z - direction);
      if (static_cast<int>(moved.size()) > options_.acceleration) {
        moved.pop_front();
        changed.pop_front();
      }
    }
    direction = z;
    if (moved.empty()) return z;
    const auto m = static_cast<Index>(moved.size());
    Eigen::MatrixXd Z(z.size(), m);
    for (Index i = 0; i < m; ++i) Z.col(i) = changed[static_cast<std::size_t>(i)];
    const Vector weight = Z.colPivHouseholderQr().solve(z);
    Vector step = z - Z * weight;
    for (Index i = 0; i < m; ++i) step -= weight[i] * moved[static_cast<std::size_t>(i)];
    return step;
  };
  try {
    evaluate();
    shrinking = {report.residual};
    for (;; ++report.iterations) {
      if (!std::isfinite(report.residual)) {
        report.reason = "the residual is not finite";
        break;
      }
      if (report.residual <= tolerance() && increment <= 1) {
        report.converged = true;
        return report;
      }
      if (report.iterations == options_.max_iterations) {
        report.reason = "Newton's method did not converge in the iterations allowed";
        break;
      }
      // A small residual needs no better factor: only the increment is still to be confirmed.
      bool fresh = !factors_.ready() || (slow() && report.residual > tolerance());
      const double before = report.residual;
      for (;;) {
        if (fresh) {
          direction.resize(0);
          renew();
        }
        last = next();
        increment = increment_measure(last);
        problem.advance(last);
        evaluate();
        if (fresh || !guarded || report.residual <= std::max(before, tolerance())) break;
        // A kept factor that leads away is not worth following.
        problem.advance(-last);
        evaluate();
        fresh = true;
      }
      // Kinks of contact make a full step overshoot: halve it while that brings the residual down.
      // Slender structures, whose residual must rise before it falls, are left alone.
      for (int halvings = 0; guarded && halvings < 8 && !(report.residual <= std::max(before, tolerance()));
           ++halvings) {
        const double full = report.residual;
        last *= 0.5;
        problem.advance(-last);
        evaluate();
        if (std::isfinite(full) && std::isfinite(report.residual) && report.residual > 0.9 * full) break;
      }
      shrinking.push_back(report.residual);
    }
  } catch (const NonConvergence& e) { report.reason = e.what(); }
  factors_.forget();
  return report;
}

}  // namespace hosel::solvers
