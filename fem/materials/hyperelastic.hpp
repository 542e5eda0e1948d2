/// Polynomials of the isochoric invariants: neo-Hooke, Mooney-Rivlin, Yeoh.
#pragma once

#include <cmath>

#include "fem/materials/elastic_law.hpp"
#include "fem/materials/lame.hpp"
#include "fem/materials/lanes.hpp"

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

  /// Adds energy and stress at C, with Ci = C^-1, J, p = J^(-2/3). Of one point (S: Sym, T: double) or several.
  template <class S, class T>
  void add_stress(const S& C, const S& Ci, const T& J, const T& p, T& energy, S& stress) const {
    const T I1 = C[0] + C[1] + C[2], x = p * I1 - 3.0;
    const T W1 = 2.0 * p * (c10 + x * (2.0 * c20 + 3.0 * c30 * x));
    const T by_inverse = bulk * (J - 1.0) * J - W1 * I1 / 3.0;
    energy += x * (c10 + x * (c20 + x * c30)) + 0.5 * bulk * (J - 1.0) * (J - 1.0);
    for (int i = 0; i < 3; ++i) stress[i] += W1;
    for (int i = 0; i < 6; ++i) stress[i] += by_inverse * Ci[i];
    if (c01 == 0) return;
    const T I2 = 0.5 * (I1 * I1 - contract(C, C)), W2 = 2.0 * c01 * p * p;
    energy += c01 * (p * p * I2 - 3.0);
    for (int i = 0; i < 6; ++i) stress[i] += W2 * ((i < 3 ? I1 : T{}) - C[i] - (2.0 / 3) * I2 * Ci[i]);
  }

  void add(const Sym& C, bool tangent, Response& out) const {
    const double det = determinant(C), J = std::sqrt(det);  // NaN for an inverted point: no step accepts it
    const Sym Ci = inverse(C, det);
    const double p = inverse_cbrt(det);  // J^(-2/3)
    add_stress(C, Ci, J, p, out.energy, out.stress);
    if (!tangent) return;
    const double I1 = C[0] + C[1] + C[2], x = p * I1 - 3;
    const double W1 = c10 + x * (2 * c20 + 3 * c30 * x), W11 = 2 * c20 + 6 * c30 * x;
    const Sym D1 = p * (sym_identity() - (I1 / 3) * Ci);
    const Mat6 IC = symmetric_product(Ci);
    const Mat6 mixed = sym_identity() * Ci.transpose();
    Mat6& T = out.tangent;
    T += 4 * W1 * p * (-(mixed + mixed.transpose()) / 3 + (I1 / 9) * Ci * Ci.transpose() + (I1 / 3) * IC);
    if (W11 != 0) T += 4 * W11 * D1 * D1.transpose();
    T += bulk * J * (2 * J - 1) * Ci * Ci.transpose() - 2 * bulk * J * (J - 1) * IC;
    if (c01 != 0) {
      const double I2 = 0.5 * (I1 * I1 - contract(C, C));
      const Sym G = I1 * sym_identity() - C;
      const Mat6 g = G * Ci.transpose();
      Mat6 H = -(2.0 / 3) * (g + g.transpose()) + (4 * I2 / 9) * Ci * Ci.transpose() + (2 * I2 / 3) * IC +
               sym_identity() * sym_identity().transpose();
      H.diagonal() -= (Sym() << 1, 1, 1, 0.5, 0.5, 0.5).finished();
      T += 4 * c01 * p * p * H;
    }
  }
};

}  // namespace hosel::fem
