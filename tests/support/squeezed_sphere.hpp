/// Exact linear elasticity of a sphere between two plates, for comparison.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

namespace hosel::test {

struct Squeezed {
  double force = 0, over_hertz = 0;      ///< on each plate, and over Hertz's at that approach [-]
  std::vector<double> cosine, pressure;  ///< of the middles of equal rings that touch; per reference area
};

/// Two rigid frictionless plates come nearer to the centre of a sphere by `approach`. Radius and Young's modulus 1;
/// small strain; the exact profile of the sphere, pressure along the axis.
///
/// Surface displacement of degree l (U P_l radially, V dP_l/dtheta along the meridian) under a traction of the same
/// shape: a combination of r^(l-1) (l, 1) and the solution of order r^(l+1) of Navier's equations (Love, Treatise on
/// the Mathematical Theory of Elasticity, art. 172-173). Rings of uniform axial pressure; contact where it is positive.
inline Squeezed squeezed(double nu, double approach, int rings = 60) {
  constexpr double pi = std::numbers::pi;
  const double lambda = nu / ((1 + nu) * (1 - 2 * nu)), mu = 0.5 / (1 + nu);  // E = 1
  const double outer = 1.15 * std::asin(std::sqrt(approach));
  const int degrees = 2 * static_cast<int>(2 * rings / outer);

  const Eigen::VectorXd x = (Eigen::ArrayXd::LinSpaced(rings + 1, 0, outer)).cos();
  const Eigen::VectorXd area = x.head(rings) - x.tail(rings);  // over 2 pi
  // Integrals of P_n(cos theta) d(cos theta) over the rings, for three successive n.
  Eigen::VectorXd before = Eigen::VectorXd::Ones(rings + 1), P = x;  // P_n, P_(n+1)
  const auto over_rings = [&](const Eigen::VectorXd& primitive) -> Eigen::VectorXd {
    return primitive.head(rings) - primitive.tail(rings);
  };
  std::vector<Eigen::VectorXd> integral{area};
  for (int n = 1; n <= degrees + 1; ++n) {
    const Eigen::VectorXd next = ((2 * n + 1) * x.cwiseProduct(P) - n * before) / (n + 1);
    integral.push_back(over_rings(next - before) / (2 * n + 1));
    before = P;
    P = next;
  }

  Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(rings, rings);
  for (int l = 0; l <= degrees; l += 2) {  // both plates: even degrees alone
    const auto& above = integral[static_cast<std::size_t>(l + 1)];
    if (l == 0) {
      compliance += above * above.transpose() / (3 * lambda + 2 * mu);
      continue;
    }
    const auto& below = integral[static_cast<std::size_t>(l - 1)];
    const double L = l, axial = lambda + 2 * mu;
    Eigen::Matrix2d moved, pulled;  // columns: the two solutions; rows: radial, meridional
    const auto solution = [&](int column, double a, double b, double power) {
      moved.col(column) << a, b;
      pulled.col(column) << lambda * ((power + 2) * a - L * (L + 1) * b) + 2 * mu * power * a,
          mu * ((power - 1) * b + a);
    };
    solution(0, L, 1, L - 1);
    solution(1, (L + 1) * (axial * L - mu * (L + 2)) / L, (axial * (L + 3) - mu * (L + 1)) / L, L + 1);
    Eigen::Matrix2d flexibility = moved * pulled.inverse();
    flexibility.col(1) /= L * (L + 1);  // the norm of dP_l/dtheta over that of P_l, squared
    // Axial unit pressure on each ring, as radial and meridional traction against the two shapes.
    Eigen::MatrixXd shape(rings, 2);
    shape << ((L + 1) * above + L * below) / (2 * L + 1), L * (L + 1) / (2 * L + 1) * (below - above);
    compliance += (2 * L + 1) * shape * flexibility * shape.transpose();
  }

  // Mean over each ring: the sphere's axial place less the plate's equals what the pressure must push back.
  const Eigen::VectorXd overlap = 0.5 * over_rings(x.cwiseProduct(x)) - (1 - approach) * area;
  std::vector<Eigen::Index> active;
  for (Eigen::Index k = 0; k < rings; ++k)
    if (overlap[k] > 0) active.push_back(k);
  for (;;) {
    const Eigen::VectorXd pressure = compliance(active, active).eval().ldlt().solve(overlap(active));
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < active.size(); ++i)
      if (pressure[static_cast<Eigen::Index>(i)] > 0) kept.push_back(active[i]);
    if (kept.size() == active.size()) {
      Squeezed out;
      out.force = 2 * pi * pressure.dot(area(active));
      out.over_hertz = out.force * (1 - nu * nu) / (4.0 / 3 * std::pow(approach, 1.5));
      out.pressure.assign(pressure.begin(), pressure.end());
      for (const Eigen::Index k : active) out.cosine.push_back(0.5 * (x[k] + x[k + 1]));
      return out;
    }
    active = kept;
  }
}

inline double squeezed_over_hertz(double nu, double approach) { return squeezed(nu, approach).over_hertz; }

}  // namespace hosel::test
