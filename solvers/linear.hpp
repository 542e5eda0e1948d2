/// One sparse matrix of fixed pattern for the whole system, and its LU factors (KLU where they hardly fill, else
/// UMFPACK).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "fem/term.hpp"

namespace hosel::solvers {

using fem::Index;
using fem::Vector;

/// The assembled tangent on the free equations (those that no fem::Prescribed imposes), compressed by
/// columns. The pattern is the union of the terms' blocks; where each block goes is worked out the
/// first time it is added and remembered by its turn in the assembly.
class SparseTangent final : public fem::TangentSink {
 public:
  enum class Terms { all, smooth };  ///< smooth: those that are not fem::Term::abrupt
  explicit SparseTangent(const fem::System& system, Terms terms = Terms::all);

  Index size() const { return static_cast<Index>(free_.size()); }
  /// Equation number of each row.
  const std::vector<Index>& free_dofs() const { return free_; }
  /// Row of an equation; -1 where it is imposed.
  int row(Index equation) const { return reduced_[static_cast<std::size_t>(equation)]; }
  Vector gather(const Vector& full) const;                  ///< entries of the free equations
  void scatter(const Vector& reduced, Vector& full) const;  ///< writes the free equations only

  /// Assembles weights.stiffness K + weights.damping C + weights.mass M, derivatives by increments from `trial`.
  void assemble(const fem::System& system, const fem::State& trial, const fem::Weights& weights);

  void add(const std::vector<Index>& rows, const std::vector<Index>& columns,
           const Eigen::Ref<const Eigen::MatrixXd>& block) override;
  /// On all cores, each with columns of its own: sums do not depend on how many there are.
  void add_all(const std::vector<std::vector<Index>>& equations, const std::vector<Eigen::MatrixXd>& blocks) override;

  /// Norm of the residual that round-off alone may leave: eps | |A| |x| |, with x the configuration's
  /// numbers (1 for rotations).
  double round_off(const fem::System& system, const fem::State& state) const;
  Eigen::MatrixXd dense() const;
  std::span<const int> column_starts() const { return starts_; }
  std::span<const int> row_indices() const { return rows_; }
  std::span<const double> values() const { return values_; }
  std::span<double> values() { return values_; }

 private:
  struct Scatter {
    std::vector<Index> rows, columns;
    std::vector<int> to;  // place in values_, -1 where imposed
  };
  Scatter make_scatter(const std::vector<Index>& rows, const std::vector<Index>& columns) const;

  Terms terms_;
  std::vector<Index> free_;
  std::vector<int> reduced_;  // equation -> free row, or -1
  std::vector<int> starts_, rows_;
  std::vector<double> values_;
  std::vector<Scatter> scatters_;
  std::size_t turn_ = 0;
};

/// LU of a SparseTangent: ordered once, factorised again whenever asked, kept while wanted.
class Factorisation {
 public:
  Factorisation();
  ~Factorisation();
  Factorisation(Factorisation&&) noexcept;
  Factorisation& operator=(Factorisation&&) noexcept;

  /// Throws NonConvergence where the matrix is singular to working precision or not finite, or memory is short.
  void factorise(const SparseTangent& matrix);
  bool ready() const;
  void forget();  ///< the factors, not the ordering
  Vector solve(const Vector& right) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hosel::solvers
