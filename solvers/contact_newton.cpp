#include "solvers/contact_newton.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "solvers/errors.hpp"

namespace hosel::solvers {
namespace {

constexpr double kDenseShrinks = 0.3;  // factors of the dense problem that do less are renewed

/// Moves, and by how much each changed the increment that was asked next; the changes are kept orthonormal.
class Secants {
 public:
  void clear() { pairs_.clear(); }
  void add(Vector moved, Vector changed) {
    const double size = changed.norm();
    for (const Pair& p : pairs_) {
      const double share = p.changed.dot(changed);
      changed -= share * p.changed;
      moved -= share * p.moved;
    }
    const double own = changed.norm();
    if (!(own > 1e-3 * size)) return;  // nothing new
    if (pairs_.size() == kMost) pairs_.pop_front();
    pairs_.push_back({moved / own, changed / own});
  }
  /// The move that would make the next increment vanish as far as the pairs can tell.
  Vector accelerate(const Vector& increment) const {
    Vector move = increment;
    for (const Pair& p : pairs_) move -= p.changed.dot(increment) * (p.changed + p.moved);
    return move;
  }

 private:
  static constexpr std::size_t kMost = 10;
  struct Pair {
    Vector moved, changed;
  };
  std::deque<Pair> pairs_;
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

std::vector<char> weakly_coupled(const fem::System& system, const SparseTangent& rows) {
  std::vector<Index> equations;
  for (const auto& term : system.terms) term->weakly_coupled(equations);
  std::vector<char> out(static_cast<std::size_t>(rows.size()), 0);
  for (Index e : equations)
    if (const int row = rows.row(e); row >= 0) out[static_cast<std::size_t>(row)] = 1;
  return out;
}

ContactNewton::ContactNewton(const fem::System& system, SparseTangent& smooth, NewtonOptions options)
    : smooth_(smooth),
      abrupt_(smooth),
      options_(options),
      increments_(system, smooth, options),
      apart_(weakly_coupled(system, smooth)) {}

void ContactNewton::renew(const ContactProblem& problem) {
  dense_ready_ = false;
  refresh(problem);
  for (double inertia = 1;; inertia *= 4) {
    round_off_ = problem.assemble_smooth(inertia);
    if (factors_.factorise(smooth_, abrupt_.touched(), apart_)) return;
    if (inertia > 1e3) throw NonConvergence("the tangent of the bodies is far from positive definite");
  }
}

void ContactNewton::refresh(const ContactProblem& problem) {
  abrupt_.clear();
  problem.assemble_abrupt(abrupt_);
}

bool ContactNewton::covered(const Vector& abrupt) const {
  for (Index i = 0; i < abrupt.size(); ++i)
    if (abrupt[i] != 0 && factors_.places()[static_cast<std::size_t>(i)] < 0) return false;
  return true;
}

Vector ContactNewton::increment(const ContactProblem& problem, const Vector& r, const Vector& abrupt, double tolerance,
                                NewtonReport& report) {
  const Eigen::VectorXf eliminated = factors_.eliminate(-r);
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
  const Vector before = on_kept(abrupt);
  Vector rest = -start;  // schur x + (abrupt - before) - start
  const double enough = std::max(0.1 * tolerance, 1e-3 * rest.norm());
  bool inside = true;  // else the next iterate keeps more rows
  for (int i = 0; m > 0 && inside && i < 30 && !(rest.norm() <= enough); ++i) {
    const bool fresh = !dense_ready_;
    if (fresh) {
      refresh(problem);
      dense_.compute(factors_.schur() + abrupt_.on(factors_.places(), m));
      ++report.dense_factorisations;
    }
    const Vector there = rest;
    const double size = rest.norm();
    Vector step = -dense_.solve(rest);
    if (!step.allFinite()) break;
    for (int halvings = 0;; ++halvings) {
      go(step);
      const Vector now = problem.abrupt_residual();
      rest = factors_.schur() * x + on_kept(now) - before - start;
      inside = covered(now);
      if (rest.norm() < size || halvings == 8) break;
      go(-step);
      step *= 0.5;
      rest = there;
      inside = true;
      if (!fresh) break;  // old factors that lead away are not worth following
    }
    dense_ready_ = rest.norm() < kDenseShrinks * size;
  }
  const Vector found = x;
  go(-x);
  return factors_.recover(eliminated, found);
}

NewtonReport ContactNewton::solve(const ContactProblem& problem) {
  NewtonReport report;
  double size = INFINITY;          // of the last move
  Vector r, abrupt, last, wanted;  // of r what is abrupt; the last move, and the increment that it was made of
  Secants secants;
  std::vector<double> shrinking;  // |r| since the factor was made or the solve began
  const auto evaluate = [&] {
    r = problem.residual(report.scale, abrupt);
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
      // A small residual needs no better factor: only the increment is still to be confirmed.
      bool fresh = !factors_.ready() || !covered(abrupt) || (slow() && report.residual > tolerance());
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
        wanted = increment(problem, r, abrupt, tolerance(), report);
        if (last.size() > 0) secants.add(last, wanted - asked);
        last = secants.accelerate(wanted);
        size = increments_.measure(last);
        problem.advance(last);
        const Vector there = r, abrupt_there = abrupt;
        evaluate();
        if (++age_ <= old || report.residual <= std::max(before, tolerance())) break;
        // An old factor that leads away is not worth following.
        problem.advance(-last);
        r = there;
        abrupt = abrupt_there;
        fresh = true;
      }
      shrinking.push_back(report.residual);
    }
  } catch (const NonConvergence& e) { report.reason = e.what(); }
  factors_.forget();
  return report;
}

}  // namespace hosel::solvers
