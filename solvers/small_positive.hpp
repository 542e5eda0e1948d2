/// Small symmetric positive definite systems, of a number or of several side by side.
#pragma once

#include <Eigen/Core>

namespace hosel::solvers {

/// B := A^-1 B by L D L' without pivots, which needs no comparison: Eigen's own cannot go through lanes. Reads the
/// lower half of A, which must be positive definite.
template <class T, int N, int Columns>
void solve_positive(Eigen::Matrix<T, N, N> A, Eigen::Matrix<T, N, Columns>& B) {
  Eigen::Matrix<T, N, 1> inverse;  // of D
  for (int j = 0; j < N; ++j) {
    inverse[j] = 1 / A(j, j);
    for (int i = j + 1; i < N; ++i) {
      const T l = A(i, j) * inverse[j];
      for (int k = j + 1; k <= i; ++k) A(i, k) -= l * A(k, j);
      for (int c = 0; c < Columns; ++c) B(i, c) -= l * B(j, c);
    }
    // The column stays L D until every row has used it.
    for (int i = j + 1; i < N; ++i) A(i, j) *= inverse[j];
  }
  for (int j = N - 1; j >= 0; --j)
    for (int c = 0; c < Columns; ++c) {
      T x = B(j, c) * inverse[j];
      for (int i = j + 1; i < N; ++i) x -= A(i, j) * B(i, c);
      B(j, c) = x;
    }
}

}  // namespace hosel::solvers
