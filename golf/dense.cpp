// Decompositions of dense matrices, and Eigen's heaviest templates for them, compiled here once for the whole project.
#include "golf/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <limits>
#define HOSEL_DENSE template
#include "dense_templates.hpp"

namespace hosel::dense {

Cholesky::Cholesky(const MatrixXd& A) : of_(A) {}

bool Cholesky::positive() const { return of_.info() == Eigen::Success; }

VectorXd Cholesky::solve(const VectorXd& b) const { return of_.solve(b); }

MatrixXd Cholesky::solve(const MatrixXd& b) const { return of_.solve(b); }

MatrixXd Cholesky::inverse() const { return solve(MatrixXd(MatrixXd::Identity(of_.rows(), of_.cols()))); }

MatrixXd Cholesky::lower() const { return of_.matrixL(); }

MatrixXd Cholesky::lower_inverse() const {
  MatrixXd x = MatrixXd::Identity(of_.rows(), of_.cols());
  of_.matrixL().solveInPlace(x);
  return x;
}

double Cholesky::log_determinant() const { return 2 * of_.matrixLLT().diagonal().array().log().sum(); }

Ldlt::Ldlt(const MatrixXd& A) : of_(A) {}

VectorXd Ldlt::solve(const VectorXd& b) const { return of_.solve(b); }

MatrixXd Ldlt::solve(const MatrixXd& b) const { return of_.solve(b); }

MatrixXd Ldlt::inverse() const { return solve(MatrixXd(MatrixXd::Identity(of_.rows(), of_.cols()))); }

VectorXd solve_lu(const MatrixXd& A, const VectorXd& b) { return A.partialPivLu().solve(b); }

MatrixXd inverse(const MatrixXd& A) { return A.inverse(); }

PivotedQr::PivotedQr(const MatrixXd& A) : of_(A) {}

PivotedQr::PivotedQr(const MatrixXd& A, double least) : of_(A) { of_.setThreshold(least); }

Eigen::Index PivotedQr::rank() const { return of_.rank(); }

VectorXd PivotedQr::solve(const VectorXd& b) const { return of_.solve(b); }

MatrixXd PivotedQr::basis() const { return of_.householderQ() * MatrixXd::Identity(of_.rows(), rank()); }

VectorXd minimum_norm(const MatrixXd& A, const VectorXd& b) { return A.completeOrthogonalDecomposition().solve(b); }

MatrixXd minimum_norm(const MatrixXd& A, const MatrixXd& b) { return A.completeOrthogonalDecomposition().solve(b); }

Eigenpairs eigenpairs(const MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> of(A);
  return {of.eigenvalues(), of.eigenvectors(), of.info() == Eigen::Success};
}

Eigenpairs eigenpairs(const MatrixXd& A, const MatrixXd& B) {
  // Eigen's solver goes on with whatever the factors of B are.
  if (!Cholesky(B).positive()) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {VectorXd::Constant(A.rows(), nan), MatrixXd::Constant(A.rows(), A.cols(), nan), false};
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> of(A, B);
  return {of.eigenvalues(), of.eigenvectors(), of.info() == Eigen::Success};
}

MatrixXd congruent(const MatrixXd& A, const MatrixXd& V) { return V.transpose() * A * V; }

}  // namespace hosel::dense
