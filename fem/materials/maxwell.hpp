/// Finite-strain viscoelasticity: Maxwell branches beside an elastic law (a Prony series in shear).
#pragma once

#include <cmath>

#include "fem/materials/elastic_law.hpp"

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

  /// B after a step of dt from (B0, C0') at its start to C1' at its end; also dX/dC1' (a number).
  Sym flow(const Sym& B0, const Sym& C0, const Sym& C1, double dt, double* gain = nullptr,
           double* scale = nullptr) const {
    const double c = contract(C0, inverse(B0, 1.0)) / 3;
    const double h = c * dt / time;
    const double lost = -std::expm1(-h), decay = 1 - lost;
    const double mean = h < 1e-6 ? 1 - h / 2 : lost / h;
    const Sym X = decay * B0 + ((mean - decay) / c) * C0 + ((1 - mean) / c) * C1;
    const double s = 1 / std::cbrt(determinant(X));
    if (gain) *gain = (1 - mean) / c;
    if (scale) *scale = s;
    return s * X;
  }

  /// Energy, stress and algorithmic tangent at C (with C' = p C, p = J^(-2/3), Ci = C^-1).
  void add(const Sym& C, const Sym& Ci, double p, const Sym& B0, const Sym& C0, double dt, bool tangent,
           Response& out) const {
    double gain = 0, scale = 0;
    const Sym B = flow(B0, C0, p * C, dt, &gain, &scale);
    const Sym A = inverse(B, 1.0);
    const double q = contract(C, A);
    out.energy += 0.5 * modulus * (p * q - 3);
    out.stress += modulus * p * (A - (q / 3) * Ci);
    if (!tangent) return;
    const Mat6 mixed = A * Ci.transpose();
    out.tangent += 2 * modulus * p *
                   (-(mixed + mixed.transpose()) / 3 + (q / 9) * Ci * Ci.transpose() + (q / 3) * symmetric_product(Ci));
    if (gain == 0) return;
    // dS = (dS/dA) dA, dA = -(A x A - A (A:x)/3), x = scale gain p (dC - C (Ci:dC)/3). In components
    // (ab, cd) of fourth-order tensors with minor symmetry, projected on both sides.
    Mat6 H = -symmetric_product(A) + (1.0 / 3) * A * A.transpose();
    H -= (1.0 / 3) * Ci * (twice(C).transpose() * H);  // left projection
    H -= (1.0 / 3) * (H * twice(C)) * Ci.transpose();  // right projection
    out.tangent += 2 * modulus * p * p * scale * gain * H;
  }

  /// Rate of dissipation [W/m^3] at C' and B.
  double dissipation(const Sym& C1, const Sym& B) const {
    const Mat3 M = to_matrix(inverse(B, 1.0)) * to_matrix(C1);
    const double trace = M.trace();
    return 0.5 * modulus / time * ((M * M).trace() - trace * trace / 3);
  }
};

}  // namespace hosel::fem
