/// Direct solution of a system that is linear and symmetric but for what acts on a few of its rows.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solvers/linear.hpp"

namespace hosel::solvers {

/// What terms add, as a dense matrix on the rows that they touch.
class DenseTangent final : public fem::TangentSink {
 public:
  /// `rows` numbers the free equations; must outlive this.
  explicit DenseTangent(const SparseTangent& rows) : rows_(rows) {}
  void clear() { blocks_.clear(); }
  void add(const std::vector<Index>& rows, const std::vector<Index>& columns,
           const Eigen::Ref<const Eigen::MatrixXd>& block) override;
  std::vector<int> touched() const;  ///< rows and columns that anything was added to, ascending
  /// The sum on the kept rows: `places` has the place of each row among them, -1 elsewhere. What is elsewhere is left
  /// out.
  Eigen::MatrixXd on(const std::vector<int>& places, Index kept) const;

 private:
  struct Block {
    std::vector<int> rows, columns;
    Eigen::MatrixXd values;
  };
  const SparseTangent& rows_;
  std::vector<Block> blocks_;
};

/// Cholesky factors (CHOLMOD) of a sparse, symmetric, positive definite matrix A with some rows kept last, so that
/// A x + P f(x_kept) = b is solved in three parts: what the others leave of it on the kept rows, a small dense problem
/// there with A's Schur complement, and the way back.
class CondensedFactorisation {
 public:
  CondensedFactorisation();
  ~CondensedFactorisation();
  CondensedFactorisation(CondensedFactorisation&&) noexcept;
  CondensedFactorisation& operator=(CondensedFactorisation&&) noexcept;

  /// Takes `a` for symmetric; `kept` ascending. What couples the rows marked in `apart` with the others is left out:
  /// two factors half as large, at once where a second core is free. False where it is not positive definite.
  bool factorise(const SparseTangent& a, const std::vector<int>& kept, const std::vector<char>& apart);
  bool ready() const;
  void forget();  ///< the factors, not the ordering
  /// Rows in the order of the dense problem, and the place there of each row of A (-1: not kept).
  std::span<const int> kept() const;
  const std::vector<int>& places() const;
  const Eigen::MatrixXd& schur() const;  ///< complement on the kept rows
  double operations() const;             ///< multiplications and additions of a factorisation
  std::size_t entries() const;           ///< of the factors, stored zeros included

  /// First half of a solution: what recover() goes on from. Solutions are in single precision, a Newton method's
  /// increments; the factors and the complement are made in double.
  Eigen::VectorXf eliminate(const Vector& right) const;
  /// The right side of the dense problem.
  Vector condensed(const Eigen::VectorXf& eliminated) const;
  /// The whole solution from that of the dense problem. Throws NonConvergence where it is not finite.
  Vector recover(Eigen::VectorXf eliminated, const Vector& kept) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hosel::solvers
