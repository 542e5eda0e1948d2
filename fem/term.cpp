#include "fem/term.hpp"

namespace hosel::fem {

void TangentSink::add_all(const std::vector<std::vector<Index>>& equations,
                          const std::vector<Eigen::MatrixXd>& blocks) {
  for (std::size_t i = 0; i < blocks.size(); ++i) add(equations[i], equations[i], blocks[i]);
}

Vector unbalanced(const System& system, const State& trial, double* scale) {
  Vector inertia = Vector::Zero(system.dof_map.size()), force = inertia;
  for (const auto& term : system.terms) term->residual(trial, inertia, force);
  if (scale) *scale = inertia.norm() + force.norm();
  return inertia + force;
}

void begin_step(const System& system) {
  for (const auto& term : system.terms) term->begin_step();
}

bool augment(const System& system, const State& trial) {
  bool again = false;
  for (const auto& term : system.terms) again = term->augment(trial) || again;
  return again;
}

}  // namespace hosel::fem
