/// Symmetric tensors as six numbers (11, 22, 33, 12, 23, 13), tensor components throughout.
#pragma once

#include <type_traits>

#include "golf/vector.hpp"

namespace hosel::fem {

using Sym = Eigen::Matrix<double, 6, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

inline constexpr int kSymRow[6] = {0, 1, 2, 0, 1, 0};
inline constexpr int kSymColumn[6] = {0, 1, 2, 1, 2, 2};

inline Sym to_sym(const Mat3& m) { return (Sym() << m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)).finished(); }
inline Mat3 to_matrix(const Sym& s) {
  return (Mat3() << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]).finished();
}
inline Sym sym_identity() { return (Sym() << 1, 1, 1, 0, 0, 0).finished(); }
/// Off-diagonals twice: twice(a).dot(b) = a : b.
inline Sym twice(const Sym& s) { return (Sym() << s[0], s[1], s[2], 2 * s[3], 2 * s[4], 2 * s[5]).finished(); }
/// `S`: a Sym, or one of several points (materials/lanes.hpp).
template <class S>
auto contract(const S& a, const S& b) {
  return std::decay_t<decltype(a[0])>(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] +
                                      2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]));
}
template <class S>
auto determinant(const S& s) {
  return std::decay_t<decltype(s[0])>(s[0] * (s[1] * s[2] - s[4] * s[4]) - s[3] * (s[3] * s[2] - s[4] * s[5]) +
                                      s[5] * (s[3] * s[4] - s[1] * s[5]));
}
/// The inverse times the determinant.
template <class S>
S adjugate(const S& s) {
  S out;
  out[0] = s[1] * s[2] - s[4] * s[4];
  out[1] = s[0] * s[2] - s[5] * s[5];
  out[2] = s[0] * s[1] - s[3] * s[3];
  out[3] = s[5] * s[4] - s[3] * s[2];
  out[4] = s[3] * s[5] - s[0] * s[4];
  out[5] = s[3] * s[4] - s[5] * s[1];
  return out;
}
inline Sym inverse(const Sym& s, double det) { return adjugate(s) / det; }
/// Components (ab, cd) of 1/2 (A_ac A_bd + A_ad A_bc).
inline Mat6 symmetric_product(const Sym& s) {
  const Mat3 a = to_matrix(s);
  Mat6 m;
  for (int v = 0; v < 6; ++v)
    for (int w = v; w < 6; ++w) {
      const int p = kSymRow[v], q = kSymColumn[v], r = kSymRow[w], t = kSymColumn[w];
      m(v, w) = m(w, v) = 0.5 * (a(p, r) * a(q, t) + a(p, t) * a(q, r));
    }
  return m;
}

}  // namespace hosel::fem
