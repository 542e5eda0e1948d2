#include "hosel/fem/term.hpp"

#include <limits>

namespace hosel::fem {

double Term::step_limit(const State&) const { return std::numeric_limits<double>::infinity(); }

}  // namespace hosel::fem
