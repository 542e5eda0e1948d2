#include "hosel/solvers/contact_newton.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "hosel/solvers/errors.hpp"

namespace hosel::solvers {
namespace {

/// Pairs of increments and of what they changed in the residual.
class Secants {
 public:
  void clear() { moved_.clear(), changed_.clear(); }
  void add(const Vector& moved, const Vector& changed) {
    moved_.push_back(moved);
    changed_.push_back(changed);
    if (moved_.size() > 10) moved_.pop_front(), changed_.pop_front();
  }
  /// Takes from `r` what the pairs explain of it; returns the increment that takes care of that part.
  Vector explain(Vector& r) const {
    Vector step = Vector::Zero(r.size());
    if (moved_.empty()) return step;
    const auto m = static_cast<Index>(moved_.size());
    Eigen::MatrixXd Z(r.size(), m);
    for (Index i = 0; i < m; ++i) Z.col(i) = changed_[static_cast<std::size_t>(i)];
    const Vector weight = Z.colPivHouseholderQr().solve(r);
    r -= Z * weight;
    for (Index i = 0; i < m; ++i) step -= weight[i] * moved_[static_cast<std::size_t>(i)];
    return step;
  }

 private:
  std::deque<Vector> moved_, changed_;
};

}  // namespace

ContactNewton::ContactNewton(const fem::System& system, SparseTangent& smooth, NewtonOptions options)
    : smooth_(smooth), abrupt_(smooth), options_(options), increments_(system, smooth, options) {}

void ContactNewton::renew(const ContactProblem& problem) {
  for (double inertia = 1;; inertia *= 4) {
    round_off_ = problem.assemble_smooth(inertia);
    if (factors_.factorise(smooth_, abrupt_.touched())) return;
    if (inertia > 1e3) throw NonConvergence("the tangent of the bodies is far from positive definite");
  }
}

void ContactNewton::refresh(const ContactProblem& problem) {
  abrupt_.clear();
  problem.assemble_abrupt(abrupt_);
}

NewtonReport ContactNewton::solve(const ContactProblem& problem) {
  NewtonReport report;
  double increment = INFINITY;
  Vector r;
  Secants secants;
  std::vector<double> shrinking;  // |r| since the factor was made or the solve began
  const auto evaluate = [&] {
    r = problem.residual(report.scale);
    report.residual = r.norm();
  };
  const auto tolerance = [&] {
    return options_.residual_relative * report.scale + options_.residual_absolute + round_off_;
  };
  // Kinks of contact are not the factor's fault: it is judged over several iterations, and blamed for a step that
  // leads away only when it has seen some.
  constexpr std::size_t back = 4;
  constexpr int old = 10;
  const auto slow = [&] {
    const std::size_t n = shrinking.size();
    return n > back && shrinking[n - 1] > options_.renew_above * shrinking[n - 1 - back];
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
      refresh(problem);
      // A small residual needs no better factor: only the increment is still to be confirmed.
      bool fresh = !factors_.ready() || !std::ranges::includes(factors_.kept(), abrupt_.touched()) ||
                   (slow() && report.residual > tolerance());
      const double before = report.residual;
      Vector last;
      const Vector r0 = r;
      for (;;) {
        if (fresh) {
          renew(problem);
          ++report.factorisations;
          age_ = 0;
          secants.clear();
          shrinking = {before};
        }
        factors_.renew_dense(abrupt_.on(factors_.kept()));
        Vector rest = r0;
        last = secants.explain(rest);
        last -= factors_.solve(rest);
        increment = increments_.measure(last);
        problem.advance(last);
        evaluate();
        if (++age_ <= old || report.residual <= std::max(before, tolerance())) break;
        // An old factor that leads away is not worth following.
        problem.advance(-last);
        refresh(problem);
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
      secants.add(last, r - r0);
      shrinking.push_back(report.residual);
    }
  } catch (const NonConvergence& e) { report.reason = e.what(); }
  factors_.forget();
  return report;
}

}  // namespace hosel::solvers
