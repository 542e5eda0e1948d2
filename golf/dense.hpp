/// Decompositions of dense matrices, compiled once (golf/dense.cpp): Eigen's own cost seconds of compiling in every
/// file that uses one. For what runs once or seldom; inner loops use Eigen's of fixed size.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>

namespace hosel::dense {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A = L L'. Reads the lower half of A.
class Cholesky {
 public:
  explicit Cholesky(const MatrixXd& A);
  /// Whether A is positive definite; where it is not, no other answer means anything.
  bool positive() const;
  /// x of A x = b.
  VectorXd solve(const VectorXd& b) const;
  MatrixXd solve(const MatrixXd& b) const;
  MatrixXd inverse() const;
  MatrixXd lower() const;          ///< L
  MatrixXd lower_inverse() const;  ///< L^-1
  /// Natural logarithm of the determinant of A.
  double log_determinant() const;

 private:
  Eigen::LLT<MatrixXd> of_;
};

/// P A P' = L D L', for a symmetric A that round-off may leave short of positive definite. Reads the lower half of A.
class Ldlt {
 public:
  explicit Ldlt(const MatrixXd& A);
  /// x of A x = b.
  VectorXd solve(const VectorXd& b) const;
  MatrixXd solve(const MatrixXd& b) const;
  MatrixXd inverse() const;

 private:
  Eigen::LDLT<MatrixXd> of_;
};

/// x of A x = b for a square A that has an inverse: by LU with partial pivoting.
VectorXd solve_lu(const MatrixXd& A, const VectorXd& b);
/// Inverse of a square matrix that has one: by LU with partial pivoting.
MatrixXd inverse(const MatrixXd& A);

/// A P = Q R with column pivoting.
class PivotedQr {
 public:
  explicit PivotedQr(const MatrixXd& A);
  /// A pivot counts as zero below `least` of the largest.
  PivotedQr(const MatrixXd& A, double least);
  Eigen::Index rank() const;
  /// An x with the smallest |A x - b|.
  VectorXd solve(const VectorXd& b) const;
  /// Orthonormal columns that span those of A, `rank()` in number.
  MatrixXd basis() const;

 private:
  Eigen::ColPivHouseholderQR<MatrixXd> of_;
};

/// The shortest of all x with the smallest |A x - b|: by a complete orthogonal decomposition.
VectorXd minimum_norm(const MatrixXd& A, const VectorXd& b);
MatrixXd minimum_norm(const MatrixXd& A, const MatrixXd& b);

/// Eigenvalues, ascending, and their vectors in the columns.
struct Eigenpairs {
  VectorXd values;
  MatrixXd vectors;
  bool converged = false;  ///< where not, no other answer means anything
};

/// A v = lambda v, v' v = 1, for a symmetric A, whose lower half is read.
Eigenpairs eigenpairs(const MatrixXd& A);
/// A v = lambda B v, v' B v = 1, for a symmetric A and a positive definite B (else NaN), whose lower halves are read.
Eigenpairs eigenpairs(const MatrixXd& A, const MatrixXd& B);

/// V' A V.
MatrixXd congruent(const MatrixXd& A, const MatrixXd& V);

}  // namespace hosel::dense
