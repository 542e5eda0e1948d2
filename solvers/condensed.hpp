/// Direct solution of a system that is smooth and symmetric but for a small, abrupt, unsymmetric part.
#pragma once

#include <memory>
#include <vector>

#include "hosel/solvers/linear.hpp"

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
  /// The sum on the rows `kept` (ascending), which must hold all that is touched.
  Eigen::MatrixXd on(const std::vector<int>& kept) const;

 private:
  struct Block {
    std::vector<int> rows, columns;
    Eigen::MatrixXd values;
  };
  const SparseTangent& rows_;
  std::vector<Block> blocks_;
};

/// Factors of A + P C P^T: A sparse, symmetric and positive definite, factorised seldom by CHOLMOD with the rows
/// `kept` last; C dense on those rows, any, renewed often: its system with the Schur complement of A is dense.
class CondensedFactorisation {
 public:
  CondensedFactorisation();
  ~CondensedFactorisation();
  CondensedFactorisation(CondensedFactorisation&&) noexcept;
  CondensedFactorisation& operator=(CondensedFactorisation&&) noexcept;

  /// Takes `smooth` for symmetric. False where it is not positive definite; C is zero again.
  bool factorise(const SparseTangent& smooth, std::vector<int> kept);
  bool ready() const;
  void forget();                         ///< the factors, not the ordering
  const std::vector<int>& kept() const;  ///< ascending
  void renew_dense(const Eigen::MatrixXd& c);
  /// Throws NonConvergence where the sum is singular.
  Vector solve(const Vector& right) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hosel::solvers
