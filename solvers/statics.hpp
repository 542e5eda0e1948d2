/// Static equilibrium force(q) = 0 at rest, by load stepping.
#pragma once

#include "solvers/newton.hpp"

namespace hosel::solvers {

struct StaticsOptions {
  NewtonOptions newton;
  int load_steps = 1;  ///< equal steps to begin with, at least 1
};

/// Equilibrium at `start.time`, from `start.q`, with v and a as in `start` (zero for statics; a steady
/// rotation may be given). The load is what is out of balance at the start, r0: step k solves
/// r(q) = (1 - k/n) r0, so every term takes part without knowing it. The terms' history is not moved, but
/// multipliers are those of the equilibrium.
/// Throws std::invalid_argument on fewer than one load step, NonConvergence.
fem::State solve_static(const fem::System& system, const fem::State& start, const StaticsOptions& options);

/// The same equilibrium by SUNDIALS KINSOL (Newton with line search, dense tangent): an independent check
/// for small systems.
fem::State solve_static_kinsol(const fem::System& system, const fem::State& start, double residual_tolerance);

}  // namespace hosel::solvers
