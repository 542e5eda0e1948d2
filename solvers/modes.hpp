/// Small vibrations about a state: K phi = omega^2 M phi, from the terms' tangents.
#pragma once

#include <vector>

#include "fem/term.hpp"

namespace hosel::solvers {

struct Modes {
  std::vector<double> omega;  ///< circular frequencies, ascending; rigid motions count, at about zero [rad/s]
  Eigen::MatrixXd shapes;     ///< columns over all equations, phi' M phi = 1; zero on imposed equations
};

/// The `count` lowest modes at `state` (imposed equations held): shift-and-invert Lanczos on CHOLMOD's factors, none
/// missed among equal ones (their number is counted by the inertia of K - omega^2 M); small systems densely.
/// Throws NonConvergence where mass is missing at an equation or the state is unstable.
Modes modes(const fem::System& system, const fem::State& state, int count);

}  // namespace hosel::solvers
