/// An elastic law from its stored energy alone: stress and tangent by automatic differentiation.
#pragma once

#include <array>
#include <boost/math/differentiation/autodiff.hpp>
#include <cmath>
#include <tuple>
#include <utility>

#include "fem/materials/elastic_law.hpp"

namespace hosel::fem {

/// What an energy states: moduli and faults as every law, and W(I1', I2', J) [J/m^3] of the invariants of
/// C' = J^(-2/3) C and of the volume ratio, as a template of three scalar types.
template <class W>
concept StoredEnergy = NamedModuli<W> && requires(const W& w) {
  { w.energy(3.0, 3.0, 1.0) } -> std::convertible_to<double>;
};

/// The law of a stored energy: S = 2 dW/dC and 4 d2W/dC2 by Boost's automatic differentiation over the invariants.
template <StoredEnergy W>
struct EnergyLaw : W {
  EnergyLaw(W law) : W(std::move(law)) {}  // NOLINT: an energy is a law

  void add(const Sym& C, bool tangent, Response& out) const {
    const double det = determinant(C), J = std::sqrt(det);  // NaN for an inverted point: no step accepts it
    const Sym Ci = inverse(C, det), one = sym_identity();
    const double p = 1 / std::cbrt(det), I1 = C[0] + C[1] + C[2], I2 = 0.5 * (I1 * I1 - contract(C, C));
    const Sym G = I1 * one - C;
    const std::array<Sym, 3> first = {p * (one - (I1 / 3) * Ci), p * p * (G - (2 * I2 / 3) * Ci), J / 2 * Ci};

    const auto [x, y, z] = boost::math::differentiation::make_ftuple<double, 2, 2, 2>(p * I1, p * p * I2, J);
    const auto w = this->energy(x, y, z) + 0.0 * (x + y + z);  // of second order in all three, whatever W depends on
    const Vec3 slope(w.derivative(1, 0, 0), w.derivative(0, 1, 0), w.derivative(0, 0, 1));
    out.energy += w.derivative(0, 0, 0);
    for (std::size_t i = 0; i < 3; ++i) out.stress += 2 * slope[Eigen::Index(i)] * first[i];
    if (!tangent) return;

    const Mat6 IC = symmetric_product(Ci), CC = Ci * Ci.transpose();
    const Mat6 one_C = one * Ci.transpose(), G_C = G * Ci.transpose();
    Mat6 of_I2 = -(2.0 / 3) * (G_C + G_C.transpose()) + (4 * I2 / 9) * CC + (2 * I2 / 3) * IC + one * one.transpose();
    of_I2.diagonal() -= (Sym() << 1, 1, 1, 0.5, 0.5, 0.5).finished();
    const std::array<Mat6, 3> second = {p * (-(one_C + one_C.transpose()) / 3 + (I1 / 9) * CC + (I1 / 3) * IC),
                                        p * p * of_I2, J / 4 * CC - J / 2 * IC};
    Mat3 curvature;
    curvature << w.derivative(2, 0, 0), w.derivative(1, 1, 0), w.derivative(1, 0, 1), w.derivative(1, 1, 0),
        w.derivative(0, 2, 0), w.derivative(0, 1, 1), w.derivative(1, 0, 1), w.derivative(0, 1, 1),
        w.derivative(0, 0, 2);
    for (std::size_t i = 0; i < 3; ++i) {
      out.tangent += 4 * slope[Eigen::Index(i)] * second[i];
      for (std::size_t j = 0; j < 3; ++j)
        out.tangent += 4 * curvature(Eigen::Index(i), Eigen::Index(j)) * first[i] * first[j].transpose();
    }
  }
};

}  // namespace hosel::fem
