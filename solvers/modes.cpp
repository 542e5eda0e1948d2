#include "solvers/modes.hpp"

#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymGEigsShiftSolver.h>
#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "golf/dense.hpp"
#include "solvers/errors.hpp"
#include "solvers/linear.hpp"

namespace hosel::solvers {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
constexpr Index kFew = 120;      // equations up to which all modes at once are cheaper than the lowest alone
constexpr int kDeflations = 12;  // of multiplicity: rigid motions come six at a time

/// lambda [1/s2], ascending, of K phi = lambda M phi; phi' M phi = 1.
struct Pairs {
  Vector lambda;
  Eigen::MatrixXd phi;
  void append(const Vector& l, const Eigen::MatrixXd& p) {
    const Index had = lambda.size(), all = had + l.size();
    Vector values(all);
    values << lambda, l;
    Eigen::MatrixXd vectors(p.rows(), all);
    vectors << phi, p;
    std::vector<Index> order(static_cast<std::size_t>(all));
    for (Index i = 0; i < all; ++i) order[static_cast<std::size_t>(i)] = i;
    std::ranges::sort(order, {}, [&](Index i) { return values[i]; });
    lambda = values(order);
    phi = vectors(Eigen::all, order);
  }
};

Sparse symmetric(const SparseTangent& tangent) {
  const Index n = tangent.size();
  const Sparse a = Eigen::Map<const Sparse>(n, n, static_cast<Index>(tangent.values().size()),
                                            tangent.column_starts().data(), tangent.row_indices().data(),
                                            tangent.values().data());
  return 0.5 * (a + Sparse(a.transpose()));
}

/// x -> (K - shift M)^-1 x by CHOLMOD, without what `known` spans: the operator that Spectra iterates.
class Inverse {
 public:
  using Scalar = double;
  Inverse(const Sparse& K, const Sparse& M, const Eigen::MatrixXd& known)
      : K_(K), M_(M), known_(known), dual_(M * known) {}
  Index rows() const { return K_.rows(); }
  Index cols() const { return K_.cols(); }
  void set_shift(double shift) {
    factors_.compute(K_ - shift * M_);
    if (factors_.info() != Eigen::Success)
      throw NonConvergence("modes need a state at which the stiffness is not negative: this one buckles");
  }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Vector> out(y, rows());
    out = factors_.solve(Eigen::Map<const Vector>(x, rows()));
    out -= known_ * (dual_.transpose() * out);
  }

 private:
  const Sparse &K_, &M_;
  const Eigen::MatrixXd known_, dual_;
  Eigen::CholmodSupernodalLLT<Sparse> factors_;
};

/// How many eigenvalues lie below (Sylvester's law of inertia).
Index below(const Sparse& K, const Sparse& M, double lambda) {
  const Eigen::SimplicialLDLT<Sparse> factors(K - lambda * M);
  if (factors.info() != Eigen::Success) throw NonConvergence("the modes could not be counted");
  return (factors.vectorD().array() < 0).count();
}

Pairs all_modes(const Sparse& K, const Sparse& M, double shift) {
  // Inverted, so that the lowest modes come out best: M phi = mu (K + shift M) phi.
  const dense::Eigenpairs all = dense::eigenpairs(Eigen::MatrixXd(M), Eigen::MatrixXd(K + shift * M));
  if (!all.converged)
    throw NonConvergence("modes need a state at which the stiffness is not negative: this one buckles");
  if (!(all.values.minCoeff() > 0))
    throw NonConvergence("the eigenvalue problem was not solved: is there inertia everywhere?");
  const Vector mu = all.values.reverse();
  return {mu.cwiseInverse().array() - shift,
          all.vectors.rowwise().reverse() * mu.cwiseSqrt().cwiseInverse().asDiagonal()};
}

/// Shift-and-invert Lanczos. One pass may find one mode of several at the same frequency, so it is repeated beside
/// those found until none is missing below the last.
Pairs lowest_modes(const Sparse& K, const Sparse& M, double zero, Index count) {
  double wanted =
      zero;  // the decade of the last mode: rigid motions are not to drown it, so the shift is not far below
  while (below(K, M, wanted) < count)
    if (wanted *= 10; !std::isfinite(wanted)) throw NonConvergence("the modes have no finite frequencies");
  // In units of that decade: Spectra's criterion of convergence has a floor at eps^(2/3), which values of 1 / omega^2
  // in SI units may lie below.
  const Sparse scaled = K / wanted;
  const double shift = std::max(zero / wanted, 1e-2);
  const Index n = K.rows(), ncv = std::min(n, std::max<Index>(2 * count + 1, 40));
  Spectra::SparseSymMatProd<double> mass(M);
  Pairs found{Vector(0), Eigen::MatrixXd(n, 0)};
  for (int pass = 0; pass < kDeflations; ++pass) {
    Inverse inverse(scaled, M, found.phi);
    Spectra::SymGEigsShiftSolver<Inverse, Spectra::SparseSymMatProd<double>, Spectra::GEigsMode::ShiftInvert> lanczos(
        inverse, mass, count, ncv, -shift);
    lanczos.init();
    if (lanczos.compute(Spectra::SortRule::LargestMagn, 1000, 1e-12) < count)
      throw NonConvergence("the lowest modes did not converge");
    found.append(lanczos.eigenvalues(), lanczos.eigenvectors());
    const double last = found.lambda[count - 1] * (1 - 1e-9) - zero / wanted;  // rigid motions are zero to round-off
    if (below(scaled, M, last) <= (found.lambda.array() < last).count()) {
      found.lambda *= wanted;
      return found;
    }
  }
  throw NonConvergence("more modes share a frequency than could be parted");
}

}  // namespace

Modes modes(const fem::System& system, const fem::State& state, int count) {
  SparseTangent tangent(system);
  tangent.assemble(system, state, {1, 0, 0});
  Sparse K = symmetric(tangent);
  tangent.assemble(system, state, {0, 0, 1});
  Sparse M = symmetric(tangent);
  // Scaled by the mass diagonal: forces and moments differ by orders of magnitude.
  const Vector inertia = M.diagonal();
  if (inertia.minCoeff() <= 0)
    throw NonConvergence("modes need a positive mass at every degree of freedom: give the body a rotary inertia");
  const Vector scale = inertia.cwiseSqrt().cwiseInverse();
  K = scale.asDiagonal() * K * scale.asDiagonal();
  M = scale.asDiagonal() * M * scale.asDiagonal();
  // The shift keeps free bodies; it lies far below the stiffest mode and costs no digits that matter.
  const double shift = 1e-12 * Vector(K.diagonal()).maxCoeff();
  const Index n = std::min<Index>(count, K.rows());
  const Pairs pairs = K.rows() <= std::max(kFew, 3 * n) ? all_modes(K, M, shift) : lowest_modes(K, M, shift, n);
  Modes out;
  out.shapes = Eigen::MatrixXd::Zero(system.dof_map.size(), n);
  for (Index i = 0; i < n; ++i) {
    out.omega.push_back(std::sqrt(std::max(0.0, pairs.lambda[i])));
    Vector full = Vector::Zero(system.dof_map.size());
    tangent.scatter(scale.cwiseProduct(pairs.phi.col(i)), full);
    out.shapes.col(i) = full;
  }
  return out;
}

}  // namespace hosel::solvers
