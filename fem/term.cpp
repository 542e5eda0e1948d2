#include "fem/term.hpp"

#include <limits>

namespace hosel::fem {

void TangentSink::add_all(const std::vector<std::vector<Index>>& equations,
                          const std::vector<Eigen::MatrixXd>& blocks) {
  for (std::size_t i = 0; i < blocks.size(); ++i) add(equations[i], equations[i], blocks[i]);
}

double Term::step_limit(const State&) const { return std::numeric_limits<double>::infinity(); }

}  // namespace hosel::fem
