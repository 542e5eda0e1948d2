/// A fem::System integrated by SUNDIALS IDA (variable-order BDF): an independent check of generalized-alpha.
#pragma once

#include <functional>

#include "fem/term.hpp"

namespace hosel::solvers {

/// Unknowns are q and v, block by block; F = (q' - v, inertia(q, v, v') + force(q, v)), imposed blocks hold
/// to their motion. The Jacobian is banded and differenced by IDA, so nothing of our tangents enters.
/// `initial.a` must be consistent. `observer` sees the state at each of `times` (increasing). The terms'
/// history does not move: for systems without history only. Throws NonConvergence.
void integrate_ida(const fem::System& system, const fem::State& initial, const std::vector<double>& times,
                   const std::function<void(const fem::State&)>& observer);

}  // namespace hosel::solvers
