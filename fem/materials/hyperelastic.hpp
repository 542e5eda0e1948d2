/// Polynomials of the isochoric invariants: neo-Hooke, Mooney-Rivlin, Yeoh.
#pragma once

#include <cmath>

#include "fem/materials/elastic_law.hpp"
#include "fem/materials/lame.hpp"

namespace hosel::fem {

/// W = c10 (I1' - 3) + c01 (I2' - 3) + c20 (I1' - 3)^2 + c30 (I1' - 3)^3 + K/2 (J - 1)^2 of the
/// invariants of C' = J^(-2/3) C: neo-Hooke (c10 = mu/2), Mooney-Rivlin (c10, c01), Yeoh (c10, c20,
/// c30). Initial shear modulus 2 (c10 + c01).
struct Hyperelastic {
  double c10 = 0, c01 = 0, c20 = 0, c30 = 0;  ///< [Pa]
  double bulk = 0;                            ///< K [Pa]

  static Hyperelastic neo_hooke(const Lame& l) { return {.c10 = l.mu / 2, .bulk = l.bulk_modulus()}; }
  double shear() const { return 2 * (c10 + c01); }
  double bulk_modulus() const { return bulk; }
  void stiffen(double factor) {
    for (double* c : {&c10, &c01, &c20, &c30}) *c *= factor;
  }
  std::vector<std::string> faults() const { return {}; }

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
