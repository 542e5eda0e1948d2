/// Newton's method for systems with contact: what is smooth keeps its factors, contact is always up to date.
#pragma once

#include <Eigen/LU>
#include <functional>
#include <vector>

#include "solvers/condensed.hpp"
#include "solvers/newton.hpp"

namespace hosel::solvers {

/// The share of the abrupt terms in residual and tangent.
Vector abrupt_residual(const fem::System& system, const fem::State& trial);
void abrupt_tangent(const fem::System& system, const fem::State& trial, const fem::Weights& weights,
                    DenseTangent& sink);

/// What the method asks of a problem; vectors are on the free equations.
struct ContactProblem {
  /// The residual at the present iterate; writes the scale that it is small against, and the share of the abrupt terms.
  std::function<Vector(double& scale, Vector& abrupt)> residual;
  /// The tangent of the smooth terms at the present iterate, its mass (in statics: what stands for it) `inertia` times
  /// as heavy where 1 is not positive definite; returns the residual that round-off alone may leave.
  std::function<double(double inertia)> assemble_smooth;
  std::function<Vector()> abrupt_residual;             ///< that share alone
  std::function<void(DenseTangent&)> assemble_abrupt;  ///< and its tangent
  std::function<void(const Vector&)> advance;          ///< moves the iterate by an increment
};

/// Marks the rows of the equations that terms say are weakly coupled to the others.
std::vector<char> weakly_coupled(const fem::System& system, const SparseTangent& rows);

/// Solves residual = 0. The smooth terms' factors come from earlier calls and are kept while they work. Each increment
/// solves contact exactly against the smooth terms so linearised: a dense problem on the few equations that it touches,
/// by Newton's method with a line search, so that its kinks trouble nothing else. What is weakly coupled is factorised
/// apart. Increments are accelerated by what the last ones brought about (Anderson's mixing; M.H. Scott, G.L. Fenves,
/// J. Struct. Eng. 136 (2010)). Never throws on failure to converge: the report says so.
class ContactNewton {
 public:
  ContactNewton(const fem::System& system, SparseTangent& smooth, NewtonOptions options);
  NewtonReport solve(const ContactProblem& problem);
  void forget() { factors_.forget(); }  ///< the next solve assembles afresh

 private:
  void renew(const ContactProblem& problem);
  void refresh(const ContactProblem& problem);
  /// Whether the kept rows hold all of an abrupt residual.
  bool covered(const Vector& abrupt) const;
  /// The increment from an iterate with residual `r`, of it `abrupt`; the iterate is where it was.
  Vector increment(const ContactProblem& problem, const Vector& r, const Vector& abrupt, double tolerance,
                   NewtonReport& report);

  SparseTangent& smooth_;
  DenseTangent abrupt_;
  NewtonOptions options_;
  IncrementTest increments_;
  std::vector<char> apart_;  // rows of weakly coupled equations
  CondensedFactorisation factors_;
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_;  // of the kept rows, contact included
  bool dense_ready_ = false;
  double round_off_ = 0;
  int age_ = 0;  // iterations that the smooth factors have served
};

}  // namespace hosel::solvers
