#include "hosel/solvers/contact_newton.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <deque>

#include "hosel/solvers/errors.hpp"

namespace hosel::solvers {
namespace {

/// Pairs of moves and of what they changed in the increment that is asked next.
class Secants {
 public:
  void clear() { moved_.clear(), changed_.clear(); }
  void add(const Vector& moved, const Vector& changed) {
    moved_.push_back(moved);
    changed_.push_back(changed);
    if (moved_.size() > 10) moved_.pop_front(), changed_.pop_front();
  }
  /// The move that would make the next increment vanish as far as the pairs can tell.
  Vector accelerate(const Vector& increment) const {
    if (moved_.empty()) return increment;
    const auto m = static_cast<Index>(moved_.size());
    Eigen::MatrixXd Z(increment.size(), m);
    for (Index i = 0; i < m; ++i) Z.col(i) = changed_[static_cast<std::size_t>(i)];
    const Vector weight = Z.colPivHouseholderQr().solve(increment);
    Vector move = increment - Z * weight;
    for (Index i = 0; i < m; ++i) move -= weight[i] * moved_[static_cast<std::size_t>(i)];
    return move;
  }

 private:
  std::deque<Vector> moved_, changed_;
};

}  // namespace

Vector abrupt_residual(const fem::System& system, const fem::State& trial) {
  Vector inertia = Vector::Zero(system.dof_map.size()), force = inertia;
  for (const auto& term : system.terms)
    if (term->abrupt()) term->residual(trial, inertia, force);
  return inertia + force;
}

void abrupt_tangent(const fem::System& system, const fem::State& trial, const fem::Weights& weights,
                    DenseTangent& sink) {
  for (const auto& term : system.terms)
    if (term->abrupt()) term->tangent(trial, weights, sink);
}

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

bool ContactNewton::covered() const {
  return std::ranges::all_of(abrupt_.touched(),
                             [&](int row) { return factors_.places()[static_cast<std::size_t>(row)] >= 0; });
}

Vector ContactNewton::increment(const ContactProblem& problem, const Vector& r, double tolerance) {
  const Vector eliminated = factors_.eliminate(-r);
  const Vector start = factors_.condensed(eliminated);
  const auto kept = factors_.kept();
  const auto m = static_cast<Index>(kept.size());
  Vector x = Vector::Zero(m), move = Vector::Zero(r.size());
  const auto on_kept = [&](const Vector& full) {
    Vector out(m);
    for (Index i = 0; i < m; ++i) out[i] = full[kept[static_cast<std::size_t>(i)]];
    return out;
  };
  const auto go = [&](const Vector& step) {
    for (Index i = 0; i < m; ++i) move[kept[static_cast<std::size_t>(i)]] = step[i];
    problem.advance(move);
    x += step;
  };
  const Vector before = m > 0 ? on_kept(problem.abrupt_residual()) : Vector();
  Vector rest = -start;  // schur x + (abrupt - before) - start
  const double enough = std::max(0.1 * tolerance, 1e-3 * rest.norm());
  for (int i = 0; m > 0 && i < 15 && !(rest.norm() <= enough); ++i) {
    if (i > 0) {
      refresh(problem);
      if (!covered()) break;  // the next iterate keeps more rows
    }
    Vector step = -(factors_.schur() + abrupt_.on(factors_.places(), m)).partialPivLu().solve(rest);
    if (!step.allFinite()) break;
    const double size = rest.norm();
    for (int halvings = 0;; ++halvings) {
      go(step);
      rest = factors_.schur() * x + on_kept(problem.abrupt_residual()) - before - start;
      if (rest.norm() < size || halvings == 8) break;
      go(-step);
      step *= 0.5;
    }
  }
  const Vector found = x;
  go(-x);
  return factors_.recover(eliminated, found);
}

NewtonReport ContactNewton::solve(const ContactProblem& problem) {
  NewtonReport report;
  double size = INFINITY;  // of the last move
  Vector r, last, wanted;  // the last move, and the increment that it was made of
  Secants secants;
  std::vector<double> shrinking;  // |r| since the factor was made or the solve began
  const auto evaluate = [&] {
    r = problem.residual(report.scale);
    report.residual = r.norm();
  };
  const auto tolerance = [&] {
    return options_.residual_relative * report.scale + options_.residual_absolute + round_off_;
  };
  // A factor is judged over several iterations, and blamed for a step that leads away only when it has seen some.
  constexpr std::size_t back = 2;
  constexpr int old = 6;
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
      if (report.residual <= tolerance() && size <= 1) {
        report.converged = true;
        return report;
      }
      if (report.iterations == options_.max_iterations) {
        report.reason = "Newton's method did not converge in the iterations allowed";
        break;
      }
      refresh(problem);
      // A small residual needs no better factor: only the increment is still to be confirmed.
      bool fresh = !factors_.ready() || !covered() || (slow() && report.residual > tolerance());
      const double before = report.residual;
      for (;;) {
        if (fresh) {
          renew(problem);
          ++report.factorisations;
          age_ = 0;
          secants.clear();
          last.resize(0);
          shrinking = {before};
        }
        const Vector asked = wanted;
        wanted = increment(problem, r, tolerance());
        if (last.size() > 0) secants.add(last, wanted - asked);
        last = secants.accelerate(wanted);
        size = increments_.measure(last);
        problem.advance(last);
        const Vector there = r;
        evaluate();
        if (++age_ <= old || report.residual <= std::max(before, tolerance())) break;
        // An old factor that leads away is not worth following.
        problem.advance(-last);
        r = there;
        refresh(problem);
        fresh = true;
      }
      shrinking.push_back(report.residual);
    }
  } catch (const NonConvergence& e) { report.reason = e.what(); }
  factors_.forget();
  return report;
}

}  // namespace hosel::solvers
