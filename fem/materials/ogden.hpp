/// Ogden's elastic law: a sum of powers of the principal stretches.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "fem/materials/elastic_law.hpp"

namespace hosel::fem {

/// W = sum_p 2 mu_p / alpha_p^2 (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3) + K/2 (J - 1)^2 of the stretches
/// l_a = J^(-1/3) lambda_a. One term with alpha = 2 is neo-Hooke; 2 and -2 are Mooney-Rivlin.
/// R.W. Ogden, Proc. R. Soc. A 326 (1972) 565; spectral form of the tangent: J.C. Simo, R.L. Taylor,
/// Comput. Methods Appl. Mech. Eng. 85 (1991) 273.
struct Ogden {
  struct Power {
    double modulus = 0;   ///< mu_p [Pa]; the initial shear modulus is their sum
    double exponent = 2;  ///< alpha_p [-], not zero
  };
  std::vector<Power> powers;
  double bulk = 0;  ///< K [Pa]

  double shear() const {
    double sum = 0;
    for (const Power& p : powers) sum += p.modulus;
    return sum;
  }
  double bulk_modulus() const { return bulk; }
  void stiffen(double factor) {
    for (Power& p : powers) p.modulus *= factor;
  }
  std::vector<std::string> faults() const {
    for (const Power& p : powers)
      if (p.exponent == 0 || !std::isfinite(p.exponent)) return {"an Ogden exponent must be finite and not zero"};
    return {};
  }

  void add(const Sym& C, bool tangent, Response& out) const {
    const Eigen::SelfAdjointEigenSolver<Mat3> spectrum(to_matrix(C));
    const Vec3& square = spectrum.eigenvalues();  // of the stretches
    const Mat3& n = spectrum.eigenvectors();
    const Vec3 x = 0.5 * square.array().log();  // logarithms of the stretches; NaN for an inverted point
    const double J = std::exp(x.sum());
    // First and second derivatives by the logarithms.
    Vec3 tau = Vec3::Constant(bulk * (J - 1) * J);
    Mat3 H = Mat3::Constant(bulk * J * (2 * J - 1));
    out.energy += 0.5 * bulk * (J - 1) * (J - 1);
    for (const auto& [mu, alpha] : powers) {
      const Vec3 e = (alpha * (x.array() - x.sum() / 3)).exp();
      const double mean = e.sum() / 3;
      out.energy += 2 * mu / (alpha * alpha) * (3 * mean - 3);
      tau += 2 * mu / alpha * (e - Vec3::Constant(mean));
      H += 2 * mu *
           (Mat3(e.asDiagonal()) - (e * Vec3::Ones().transpose() + Vec3::Ones() * e.transpose()) / 3 +
            Mat3::Constant(mean / 3));
    }
    const Vec3 s = tau.cwiseQuotient(square);
    for (int a = 0; a < 3; ++a) out.stress += s[a] * to_sym(n.col(a) * n.col(a).transpose());
    if (!tangent) return;
    const auto slope = [&](int a, int b) { return (H(a, b) - (a == b ? 2 * tau[a] : 0)) / (square[a] * square[b]); };
    for (int a = 0; a < 3; ++a) {
      const Sym A = to_sym(n.col(a) * n.col(a).transpose());
      for (int b = 0; b < 3; ++b) out.tangent += slope(a, b) * A * to_sym(n.col(b) * n.col(b).transpose()).transpose();
      for (int b = a + 1; b < 3; ++b) {
        // Equal stretches: the quotient's limit, exact to the square of their difference.
        const double difference = square[b] - square[a];
        const double turn = std::abs(difference) > 1e-5 * square[b]
                                ? (s[b] - s[a]) / difference
                                : 0.25 * (slope(a, a) + slope(b, b)) - 0.5 * slope(a, b);
        const Sym M = to_sym(n.col(a) * n.col(b).transpose() + n.col(b) * n.col(a).transpose());
        out.tangent += turn * M * M.transpose();
      }
    }
  }
};

}  // namespace hosel::fem
