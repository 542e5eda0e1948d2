#include "solvers/newton.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solvers/errors.hpp"

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
    largest = std::max(largest, std::abs(increment[i]) / (rotation_[static_cast<std::size_t>(i)]
                                                              ? options_.increment_rotation
                                                              : options_.increment_vector));
  return largest;
}

NewtonReport Newton::solve(const NewtonProblem& problem) {
  NewtonReport report;
  double increment = INFINITY, before = INFINITY;
  Vector r, last;
  const auto evaluate = [&] {
    r = problem.residual(report.scale);
    report.residual = r.norm();
  };
  const auto tolerance = [&] { return options_.residual_relative * report.scale + options_.residual_absolute; };
  try {
    evaluate();
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
      const bool slow = report.residual > options_.renew_above * before && report.residual > tolerance();
      bool fresh = !factors_.ready() || slow;
      const Vector start = r;
      before = report.residual;
      for (;;) {
        if (fresh) {
          problem.assemble();
          factors_.factorise(tangent_);
          ++report.factorisations;
        }
        last = -factors_.solve(start);
        increment = increment_measure(last);
        problem.advance(last);
        evaluate();
        if (fresh || report.residual <= std::max(before, tolerance())) break;
        // A kept factor that leads away is not worth following.
        problem.advance(-last);
        evaluate();
        fresh = true;
      }
      // Kinks of contact make a full step overshoot: halve it while that brings the residual down.
      for (int halvings = 0; halvings < 8 && !(report.residual <= std::max(before, tolerance())); ++halvings) {
        const double full = report.residual;
        last *= 0.5;
        problem.advance(-last);
        evaluate();
        if (std::isfinite(full) && std::isfinite(report.residual) && report.residual > 0.9 * full) break;
      }
    }
  } catch (const NonConvergence& e) {
    report.reason = e.what();
  }
  factors_.forget();
  return report;
}

}  // namespace hosel::solvers
