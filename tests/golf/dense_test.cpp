#include "golf/dense.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace hosel {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDenseRoundOff = 1e-13;  // of entries near 1 after some ten operations each

/// Symmetric and positive definite, of condition 1e2.
MatrixXd positive() {
  MatrixXd A(4, 4);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) A(i, j) = 1.0 / (1 + std::abs(i - j)) + (i == j ? 0.1 * i : 0);
  return A;
}

/// Five rows, three columns, the last the sum of the others.
MatrixXd dependent() {
  MatrixXd A(5, 3);
  for (int i = 0; i < 5; ++i) A.row(i) << 1, 0.3 * i * i, 1 + 0.3 * i * i;
  return A;
}

void near(const MatrixXd& a, const MatrixXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), kDenseRoundOff);
}

TEST(Dense, CholeskyIsTheMatrixAgain) {
  const MatrixXd A = positive(), I = MatrixXd::Identity(4, 4);
  const dense::Cholesky of(A);
  ASSERT_TRUE(of.positive());
  near(of.lower() * of.lower().transpose(), A);
  near(of.lower_inverse() * of.lower(), I);
  near(A * of.inverse(), I);
  near(A * of.solve(VectorXd(A.col(2) + I.col(0))), A.col(2) + I.col(0));
  near(A * of.solve(MatrixXd(2 * A + I)), 2 * A + I);
  EXPECT_NEAR(of.log_determinant(), std::log(A.determinant()), kDenseRoundOff);
  EXPECT_FALSE(dense::Cholesky(A - 5 * I).positive());
}

TEST(Dense, SquareSystems) {
  const MatrixXd A = positive(), I = MatrixXd::Identity(4, 4);
  const VectorXd b = VectorXd::LinSpaced(4, -1, 2);
  near(A * dense::Ldlt(A).solve(b), b);
  near(A * dense::Ldlt(A).solve(I), I);
  near(A * dense::Ldlt(A).inverse(), I);
  MatrixXd unsymmetric = A;
  unsymmetric(0, 3) = 2;
  near(unsymmetric * dense::solve_lu(unsymmetric, b), b);
  near(unsymmetric * dense::inverse(unsymmetric), I);
}

TEST(Dense, DependentColumns) {
  const MatrixXd A = dependent();
  const VectorXd b = VectorXd::LinSpaced(5, -1, 3).array().cube();
  const dense::PivotedQr qr(A, 1e-8);
  ASSERT_EQ(qr.rank(), 2);
  const MatrixXd Q = qr.basis();
  near(Q.transpose() * Q, MatrixXd::Identity(2, 2));
  EXPECT_LT((A - Q * Q.transpose() * A).norm(), 1e-12);
  const VectorXd shortest = dense::minimum_norm(A, b);
  EXPECT_LT((A.transpose() * (b - A * shortest)).norm(), 1e-10);   // of terms up to 500
  EXPECT_NEAR(shortest.dot(Eigen::Vector3d(1, 1, -1)), 0, 1e-12);  // nothing along what A does not see
  EXPECT_LT((A.transpose() * (b - A * qr.solve(b))).norm(), 1e-10);
  near(dense::minimum_norm(A, MatrixXd(b)), shortest);
}

TEST(Dense, Eigenpairs) {
  MatrixXd A = positive();
  A(1, 1) = -1;
  const dense::Eigenpairs own = dense::eigenpairs(A);
  ASSERT_TRUE(own.converged);
  EXPECT_LT(own.values[0], 0);
  for (int k = 1; k < 4; ++k) EXPECT_LE(own.values[k - 1], own.values[k]);
  near(A * own.vectors, own.vectors * own.values.asDiagonal());
  near(own.vectors.transpose() * own.vectors, MatrixXd::Identity(4, 4));
  const MatrixXd B = positive();
  const dense::Eigenpairs both = dense::eigenpairs(A, B);
  ASSERT_TRUE(both.converged);
  near(A * both.vectors, B * both.vectors * both.values.asDiagonal());
  near(dense::congruent(B, both.vectors), MatrixXd::Identity(4, 4));
  near(dense::congruent(A, both.vectors), both.values.asDiagonal());
  const dense::Eigenpairs none = dense::eigenpairs(B, A);  // A has a negative eigenvalue
  EXPECT_FALSE(none.converged);
  EXPECT_TRUE(none.values.array().isNaN().all());
  EXPECT_TRUE(none.vectors.array().isNaN().all());
}

}  // namespace
}  // namespace hosel
