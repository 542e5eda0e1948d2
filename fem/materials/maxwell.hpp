/// Finite-strain viscoelasticity: Maxwell branches in parallel with an elastic law (a Prony series in shear).
#pragma once

#include <cmath>
#include <type_traits>

#include "fem/materials/elastic_law.hpp"
#include "fem/materials/lanes.hpp"

namespace hosel::fem {

/// A branch of free energy mu/2 (C':B^-1 - 3), with C' = J^(-2/3) C and an inner metric B, det B = 1,
/// that flows towards C':   B' = (C' - (C':B^-1 / 3) B) / tau.
/// Its dissipation mu/(2 tau) [tr((B^-1 C')^2) - tr(B^-1 C')^2 / 3] is never negative (Cauchy-Schwarz).
/// For small strains it is the Maxwell element of shear modulus mu and relaxation time tau.
/// Form of the branch: J.C. Simo, Comput. Methods Appl. Mech. Eng. 60 (1987); S. Reese, S. Govindjee,
/// Int. J. Solids Struct. 35 (1998), with a flow rule in the reference configuration.
///
/// One step: X' = (C' - c X)/tau from B_n, solved exactly for C' linear in time, with c = C':B^-1 / 3 at
/// the step's start, and B = X / det(X)^(1/3): the flow along B itself only scales B. Second order;
/// exact for small strains linear in time.
struct MaxwellBranch {
  double modulus = 0;  ///< mu [Pa]
  double time = 0;     ///< tau [s]

  /// Of a step what does not depend on its end: X = base + gain C1'.
  struct Start {
    Sym base;
    double gain = 0;
  };
  /// Of a step of dt from (B0, C0').
  Start start(const Sym& B0, const Sym& C0, double dt) const {
    if (dt == 0) return {B0, 0};
    const double c = contract(C0, adjugate(B0)) / 3;
    const double h = c * dt / time;
    const double lost = -std::expm1(-h), decay = 1 - lost;
    const double mean = h < 1e-6 ? 1 - h / 2 : lost / h;
    return {decay * B0 + ((mean - decay) / c) * C0, (1 - mean) / c};
  }

  /// B at the end of a step, at C1'; `scale`: B over X. Of one point (S: Sym, T: double) or several.
  template <class S, class T>
  static S flow(const S& base, const T& gain, const S& C1, T& scale) {
    S X;
    for (int i = 0; i < 6; ++i) X[i] = base[i] + gain * C1[i];
    inverse_cbrt(determinant(X), scale);
    for (int i = 0; i < 6; ++i) X[i] *= scale;
    return X;
  }

  /// Adds energy and stress at C (with C' = p C, p = J^(-2/3), Ci = C^-1). Leaves B^-1 in `A`.
  template <class S, class T>
  void add_stress(const S& C, const S& Ci, const T& p, const S& base, const T& gain, T& energy, S& stress, S& A,
                  T& scale) const {
    const T by_C = gain * p;
    A = adjugate(flow(base, by_C, C, scale));
    const T q = contract(C, A), factor = modulus * p, third = q / 3.0;
    energy += 0.5 * modulus * (p * q - 3.0);
    for (int i = 0; i < 6; ++i) stress[i] += factor * (A[i] - third * Ci[i]);
  }

  /// Energy, stress and algorithmic tangent there.
  void add(const Sym& C, const Sym& Ci, double p, const Start& from, bool tangent, Response& out) const {
    double scale = 0;
    Sym A;
    add_stress(C, Ci, p, from.base, from.gain, out.energy, out.stress, A, scale);
    if (!tangent) return;
    const double q = contract(C, A);
    const Mat6 mixed = A * Ci.transpose();
    out.tangent += 2 * modulus * p *
                   (-(mixed + mixed.transpose()) / 3 + (q / 9) * Ci * Ci.transpose() + (q / 3) * symmetric_product(Ci));
    if (from.gain == 0) return;
    // dS = (dS/dA) dA, dA = -(A x A - A (A:x)/3), x = scale gain p (dC - C (Ci:dC)/3). In components
    // (ab, cd) of fourth-order tensors with minor symmetry, projected on both sides.
    Mat6 H = -symmetric_product(A) + (1.0 / 3) * A * A.transpose();
    H -= (1.0 / 3) * Ci * (twice(C).transpose() * H);  // left projection
    H -= (1.0 / 3) * (H * twice(C)) * Ci.transpose();  // right projection
    out.tangent += 2 * modulus * p * p * scale * from.gain * H;
  }

  /// Rate of dissipation [W/m^3] at C' and B.
  template <class S>
  auto dissipation(const S& C1, const S& B) const {
    using T = std::decay_t<decltype(C1[0])>;
    const S A = adjugate(B);
    constexpr int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    T M[3][3], square{};  // B^-1 C'
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        M[i][j] = A[at[i][0]] * C1[at[0][j]] + A[at[i][1]] * C1[at[1][j]] + A[at[i][2]] * C1[at[2][j]];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) square += M[i][j] * M[j][i];
    const T trace = M[0][0] + M[1][1] + M[2][2];
    return T(0.5 * modulus / time * (square - trace * trace / 3.0));
  }
};

}  // namespace hosel::fem
