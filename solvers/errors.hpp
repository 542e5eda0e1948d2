/// What a solver says when it finds no answer.
#pragma once

#include <stdexcept>

namespace hosel::solvers {

/// No convergence; the message is one sentence a person can act on. The command exits with status 3.
class NonConvergence : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hosel::solvers
