/// Elastic laws at a point: a free energy per reference volume, its stress and its tangent.
#pragma once

#include <cmath>

#include "hosel/fem/materials/symmetric.hpp"

namespace hosel::fem {

/// Second Piola-Kirchhoff stress S = 2 dW/dC [Pa] and tangent 4 d2W/dC2 [Pa] at the right
/// Cauchy-Green tensor C.
struct Response {
  double energy = 0;  ///< [J/m^3]
  Sym stress = Sym::Zero();
  Mat6 tangent = Mat6::Zero();
};

/// First Lame parameter and shear modulus of linear elasticity [Pa].
struct Lame {
  double lambda = 0, mu = 0;
  static Lame of(double young, double poisson) {
    return {young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))};
  }
  double bulk() const { return lambda + 2 * mu / 3; }
};

/// Linear elasticity: stress lambda tr(e) + 2 mu e of the small strain e = sym(R^T F) - 1, where R is
/// the body's mean rotation. Only for comparison with small-strain theory; a solid keeps R.
struct LinearElastic : Lame {};

/// W = lambda/2 tr(E)^2 + mu E:E of the Green strain E: softens and collapses in strong compression.
struct StVenantKirchhoff : Lame {
  void add(const Sym& C, bool tangent, Response& out) const {
    const Sym E = 0.5 * (C - sym_identity());
    const double trace = E[0] + E[1] + E[2];
    out.energy += 0.5 * lambda * trace * trace + mu * contract(E, E);
    out.stress += lambda * trace * sym_identity() + 2 * mu * E;
    if (!tangent) return;
    out.tangent.topLeftCorner<3, 3>().array() += lambda;
    out.tangent.diagonal() += (Sym() << 2 * mu, 2 * mu, 2 * mu, mu, mu, mu).finished();
  }
};

/// W = c10 (I1' - 3) + c01 (I2' - 3) + c20 (I1' - 3)^2 + c30 (I1' - 3)^3 + K/2 (J - 1)^2 of the
/// invariants of C' = J^(-2/3) C: neo-Hooke (c10 = mu/2), Mooney-Rivlin (c10, c01), Yeoh (c10, c20,
/// c30). Initial shear modulus 2 (c10 + c01).
struct Hyperelastic {
  double c10 = 0, c01 = 0, c20 = 0, c30 = 0;  ///< [Pa]
  double bulk = 0;                            ///< K [Pa]

  static Hyperelastic neo_hooke(const Lame& l) { return {.c10 = l.mu / 2, .bulk = l.bulk()}; }
  double shear() const { return 2 * (c10 + c01); }

  void add(const Sym& C, bool tangent, Response& out) const {
    const double det = determinant(C), J = std::sqrt(det);  // NaN for an inverted point: no step accepts it
    const Sym Ci = inverse(C, det);
    const double p = 1 / std::cbrt(det);  // J^(-2/3)
    const double I1 = C[0] + C[1] + C[2];
    const double x = p * I1 - 3;
    const double W1 = c10 + x * (2 * c20 + 3 * c30 * x), W11 = 2 * c20 + 6 * c30 * x;
    const Sym D1 = p * (sym_identity() - (I1 / 3) * Ci);
    out.energy += x * (c10 + x * (c20 + x * c30)) + 0.5 * bulk * (J - 1) * (J - 1);
    out.stress += 2 * W1 * D1 + bulk * (J - 1) * J * Ci;
    double I2 = 0;
    Sym G;
    if (c01 != 0) {
      I2 = 0.5 * (I1 * I1 - contract(C, C));
      G = I1 * sym_identity() - C;
      out.energy += c01 * (p * p * I2 - 3);
      out.stress += 2 * c01 * p * p * (G - (2 * I2 / 3) * Ci);
    }
    if (!tangent) return;
    const Mat6 IC = symmetric_product(Ci);
    const Mat6 mixed = sym_identity() * Ci.transpose();
    Mat6& T = out.tangent;
    T += 4 * W1 * p * (-(mixed + mixed.transpose()) / 3 + (I1 / 9) * Ci * Ci.transpose() + (I1 / 3) * IC);
    if (W11 != 0) T += 4 * W11 * D1 * D1.transpose();
    T += bulk * J * (2 * J - 1) * Ci * Ci.transpose() - 2 * bulk * J * (J - 1) * IC;
    if (c01 != 0) {
      const Mat6 g = G * Ci.transpose();
      Mat6 H = -(2.0 / 3) * (g + g.transpose()) + (4 * I2 / 9) * Ci * Ci.transpose() + (2 * I2 / 3) * IC +
               sym_identity() * sym_identity().transpose();
      H.diagonal() -= (Sym() << 1, 1, 1, 0.5, 0.5, 0.5).finished();
      T += 4 * c01 * p * p * H;
    }
  }
};

}  // namespace hosel::fem
