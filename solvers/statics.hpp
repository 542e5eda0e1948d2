/// Static equilibrium force(q) = 0 at rest, by load stepping.
#pragma once

#include "solvers/newton.hpp"

namespace hosel::solvers {

struct StaticsOptions {
  NewtonOptions newton;
  int load_steps = 1;      ///< equal steps to begin with
  int max_bisections = 8;  ///< of a failing load step
};

struct StaticsReport {
  fem::State state;
  Vector reactions;  ///< the residual: on imposed equations what holds them there
  int iterations = 0, load_steps = 0;
};

/// Equilibrium at `start.time`, from `start.q`, with v and a as in `start` (zero for statics; a steady
/// rotation may be given). The load is what is out of balance at the start, r0: step k solves
/// r(q) = (1 - k/n) r0, so every term takes part without knowing it. The terms' history is not moved, but
/// multipliers are those of the equilibrium.
/// Throws NonConvergence.
StaticsReport solve_static(const fem::System& system, const fem::State& start, const StaticsOptions& options);

/// The same equilibrium by SUNDIALS KINSOL (Newton with line search, dense tangent): an independent check
/// for small systems.
StaticsReport solve_static_kinsol(const fem::System& system, const fem::State& start, double residual_tolerance);

}  // namespace hosel::solvers
