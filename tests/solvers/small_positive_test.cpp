// Small positive definite systems against Eigen's Cholesky factors.
#include "solvers/small_positive.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "golf/lanes.hpp"

namespace hosel::solvers {
namespace {

TEST(SmallPositive, NumbersAndLanesAgreeWithEigen) {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  using Columns = Eigen::Matrix<double, 6, 3>;
  Eigen::Matrix<Pack, 6, 6> A;
  Eigen::Matrix<Pack, 6, 3> B;
  std::array<Matrix, kLanes> each;
  std::array<Columns, kLanes> expected;
  for (int l = 0; l < kLanes; ++l) {
    Matrix half;
    Columns b;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) half(i, j) = std::sin(1 + 3.7 * l + 6.1 * i + j * j);
      for (int c = 0; c < 3; ++c) b(i, c) = std::cos(l + 2.3 * i + c);
    }
    each[std::size_t(l)] = half * half.transpose() + 0.1 * Matrix::Identity();
    expected[std::size_t(l)] = each[std::size_t(l)].llt().solve(b);
    set_lane(A, l, each[std::size_t(l)]);
    set_lane(B, l, b);
    solve_positive(each[std::size_t(l)], b);
    EXPECT_LT((b - expected[std::size_t(l)]).norm(), 1e-12 * expected[std::size_t(l)].norm());
  }
  solve_positive(A, B);
  for (int l = 0; l < kLanes; ++l)
    EXPECT_LT((lane(B, l) - expected[std::size_t(l)]).norm(), 1e-12 * expected[std::size_t(l)].norm());
}

}  // namespace
}  // namespace hosel::solvers
