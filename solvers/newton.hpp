/// Newton's method on the manifold of the degrees of freedom, with factors kept while they work.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solvers/linear.hpp"

namespace hosel::solvers {

/// When an iterate is a solution. Both criteria must hold; every tolerance is stated by the caller.
struct NewtonOptions {
  double residual_relative = 0;   ///< |r| <= relative * scale + absolute, scale as the problem gives it [-]
  double residual_absolute = 0;   ///< [N] (forces; moments in N m count alike)
  double increment_vector = 0;    ///< largest last increment of a plain number [m]; inf: not asked for
  double increment_rotation = 0;  ///< largest last increment of a rotation [rad]; inf: not asked for
  int max_iterations = 25;
  /// A kept factor is renewed when |r| shrinks by less than this factor in one iteration (with contact: in two).
  double renew_above = 0.2;

  /// Sentences naming what is missing or cannot be; empty if all is well.
  std::vector<std::string> faults() const;
};

struct NewtonReport {
  bool converged = false;
  int iterations = 0, factorisations = 0;
  int dense_factorisations = 0;    ///< of the small problem of what is abrupt (contact_newton.hpp)
  double residual = 0, scale = 0;  ///< at the last iterate
  std::string reason;              ///< why not, in one sentence
};

/// The largest entry of an increment against what the options allow.
class IncrementTest {
 public:
  IncrementTest(const fem::System& system, const SparseTangent& tangent, const NewtonOptions& options);
  double measure(const Vector& increment) const;  ///< 1 at the tolerance

 private:
  double vector_, rotation_;
  std::vector<bool> is_rotation_;  // of each free equation
};

/// What Newton asks of a problem; vectors are on the free equations.
struct NewtonProblem {
  /// The residual at the present iterate; writes the scale that it is small against.
  std::function<Vector(double& scale)> residual;
  /// The tangent at the present iterate; returns the residual that round-off alone may leave.
  std::function<double()> assemble;
  std::function<void(const Vector&)> advance;  ///< moves the iterate by an increment
  /// How far all bodies have turned at the present iterate, from anywhere: kept factors turn with them. The solution
  /// does not depend on it. Empty: factors stay as they are.
  std::function<Mat3()> attitude = {};
};

/// Solves residual = 0. `factors` may come from earlier calls and are kept for later ones. Never
/// throws on failure to converge: the report says so and the caller rejects the step.
class Newton {
 public:
  Newton(const fem::System& system, SparseTangent& tangent, NewtonOptions options);
  NewtonReport solve(const NewtonProblem& problem);
  void forget() { factors_.forget(); }  ///< the next solve assembles afresh

 private:
  SparseTangent& tangent_;
  NewtonOptions options_;
  IncrementTest increments_;
  Factorisation factors_;
  double round_off_ = 0;              // as of the last assembly; no residual can be smaller
  std::vector<Index> vectors_;        // rows at which three components of a global vector begin
  Mat3 attitude_ = Mat3::Identity();  // at the last assembly
};

}  // namespace hosel::solvers
