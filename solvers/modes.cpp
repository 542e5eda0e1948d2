#include "hosel/solvers/modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "hosel/solvers/errors.hpp"
#include "hosel/solvers/linear.hpp"

namespace hosel::solvers {

Modes modes(const fem::System& system, const fem::State& state, int count) {
  SparseTangent tangent(system);
  tangent.assemble(system, state, {1, 0, 0});
  Eigen::MatrixXd K = tangent.dense();
  K = (0.5 * (K + K.transpose())).eval();
  tangent.assemble(system, state, {0, 0, 1});
  Eigen::MatrixXd M = tangent.dense();
  M = (0.5 * (M + M.transpose())).eval();
  // Scaled by the mass diagonal: forces and moments differ by orders of magnitude.
  if (M.diagonal().minCoeff() <= 0)
    throw NonConvergence("modes need a positive mass at every degree of freedom: give the body a rotary inertia");
  const Vector scale = M.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd Ks = scale.asDiagonal() * K * scale.asDiagonal();
  const Eigen::MatrixXd Ms = scale.asDiagonal() * M * scale.asDiagonal();
  // Inverted, so that the lowest modes come out best: M phi = mu (K + shift M) phi. The shift keeps free
  // bodies; it lies far below the stiffest mode and costs no digits that matter.
  const double shift = 1e-12 * Ks.diagonal().maxCoeff();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(Ms, Ks + shift * Ms);
  if (solver.info() != Eigen::Success)
    throw NonConvergence("the eigenvalue problem was not solved: is the mass matrix positive definite?");
  const Index n = std::min<Index>(count, K.rows());
  Modes out;
  out.shapes = Eigen::MatrixXd::Zero(system.dof_map.size(), n);
  for (Index i = 0; i < n; ++i) {
    const Index at = K.rows() - 1 - i;
    const Vector phi = solver.eigenvectors().col(at);  // phi' (K + shift M) phi = 1, phi' M phi = mu
    const double mu = solver.eigenvalues()[at];
    if (!(mu > 0)) throw NonConvergence("the mass matrix is not positive definite: modes need inertia everywhere");
    out.omega.push_back(std::sqrt(std::max(0.0, 1 / mu - shift)));
    Vector full = Vector::Zero(system.dof_map.size());
    tangent.scatter(scale.cwiseProduct(phi) / std::sqrt(mu), full);
    out.shapes.col(i) = full;
  }
  return out;
}

}  // namespace hosel::solvers
