#include "models/reduced/shaft_impedance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "golf/dense.hpp"
#include "golf/units.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Rule {
  std::vector<double> at, weight;  // on (0, 1)
};

/// Gauss-Legendre by Newton on P_n.
Rule gauss(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 0;
    for (int it = 0; it < 50; ++it) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1);
      const double step = p1 / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    rule.at.push_back((1 - x) / 2);
    rule.weight.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// Functions of xi = x / L, zero at the clamped butt: first the one that carries the tip, xi, then
/// those with a tip at rest, xi (P_k(2 xi - 1) - 1). Values and slopes d/dx.
void functions(double xi, double length, VectorXd& value, VectorXd& slope) {
  const int n = static_cast<int>(value.size());
  const double z = 2 * xi - 1;
  double p0 = 1, p1 = z, d0 = 0, d1 = 2;  // P_k and dP_k / dxi
  value[0] = xi;
  slope[0] = 1 / length;
  for (int k = 1; k < n; ++k) {
    value[k] = xi * (p1 - 1);
    slope[k] = (p1 - 1 + xi * d1) / length;
    const double p2 = ((2 * k + 1) * z * p1 - k * p0) / (k + 1);
    const double d2 = ((2 * k + 1) * (2 * p1 + z * d1) - k * d0) / (k + 1);
    p0 = p1;
    p1 = p2;
    d0 = d1;
    d1 = d2;
  }
}

/// One decoupled motion of the shaft after Craig and Bampton.
struct Condensed {
  MatrixXd mass, stiffness;  // of the tip
  MatrixXd coupling;         // tip x modes
  VectorXd frequency2;
};

/// Splits M, K into the freedoms of the tip that the head carries along and all others, and condenses.
Condensed condense(const MatrixXd& M, const MatrixXd& K, const std::vector<int>& tip, double highest) {
  const int n = static_cast<int>(M.rows()), inner = n - static_cast<int>(tip.size());
  std::vector<int> rest;
  for (int i = 0; i < n; ++i)
    if (std::ranges::find(tip, i) == tip.end()) rest.push_back(i);
  const auto pick = [](const MatrixXd& A, const std::vector<int>& r, const std::vector<int>& c) {
    return MatrixXd(A(r, c));
  };
  const MatrixXd Kii = pick(K, rest, rest), Kib = pick(K, rest, tip), Mii = pick(M, rest, rest),
                 Mib = pick(M, rest, tip);
  const MatrixXd S = -dense::Ldlt(Kii).solve(Kib);  // inner motion that follows the tip at rest
  Condensed out;
  out.stiffness = pick(K, tip, tip) + Kib.transpose() * S;
  out.mass = pick(M, tip, tip) + Mib.transpose() * S + S.transpose() * Mib + dense::congruent(Mii, S);
  const dense::Eigenpairs modes = dense::eigenpairs(Kii, Mii);
  if (!modes.converged)
    throw solvers::NonConvergence("shaft-coupled: the shaft has no modes: its mass is not positive everywhere");
  int kept = 0;
  while (kept < inner && modes.values[kept] < std::pow(2 * kPi * highest, 2)) ++kept;
  const MatrixXd Phi = modes.vectors.leftCols(kept);
  out.frequency2 = modes.values.head(kept);
  out.coupling = (Mib + Mii * S).transpose() * Phi;
  return out;
}

}  // namespace

ShaftImpedance shaft_impedance(const Club& club, const ShaftImpedanceOptions& options) {
  if (!club.shaft || club.shaft->stations.size() < 2)
    throw std::invalid_argument("shaft-coupled: the club has no shaft");
  if (!std::ranges::all_of(club.shaft->stations, [](const ShaftStation& s) { return s.shear_stiffness > 0; }))
    throw std::invalid_argument("shaft-coupled: the shaft's table has no shear stiffness");
  const Shaft& shaft = *club.shaft;
  for (const ShaftStation& s : shaft.stations)
    if (!s.centres.none())
      throw std::invalid_argument(
          "shaft-coupled: the condensed shaft has its centres on its line; for [shaft.offsets] use fe-full-club");
  const int n = options.functions, pieces = static_cast<int>(shaft.stations.size()) - 1;
  const double start = shaft.stations.front().arc_length, length = shaft.length() - start;
  MatrixXd My = MatrixXd::Zero(2 * n, 2 * n), Ky = My, Mz = My, Kz = My;  // bending: displacement, slope
  MatrixXd Mt = MatrixXd::Zero(n, n), Kt = Mt, Ma = Mt, Ka = Mt;          // torsion, axial
  VectorXd f(n), g(n), shear(2 * n);
  const Rule rule = gauss(4 + (2 * n + 2 + pieces - 1) / pieces);
  for (int e = 0; e < pieces; ++e) {
    const double a = shaft.stations[e].arc_length, b = shaft.stations[e + 1].arc_length;
    for (std::size_t q = 0; q < rule.at.size(); ++q) {
      const double s = a + (b - a) * rule.at[q], w = (b - a) * rule.weight[q];
      const ShaftStation st = shaft.at(s);
      functions((s - start) / length, length, f, g);
      shear << g, -f;  // displacement' - slope
      const MatrixXd ff = w * f * f.transpose(), gg = w * g * g.transpose(),
                     ss = w * st.shear_stiffness * shear * shear.transpose();
      // Along y: slope = rotation about z. Along z: slope = - rotation about y.
      My.topLeftCorner(n, n) += st.mass_per_length * ff;
      My.bottomRightCorner(n, n) += st.rotary_inertia_z * ff;
      Ky += ss;
      Ky.bottomRightCorner(n, n) += st.bending_stiffness_z * gg;
      Mz.topLeftCorner(n, n) += st.mass_per_length * ff;
      Mz.bottomRightCorner(n, n) += st.rotary_inertia_y * ff;
      Kz += ss;
      Kz.bottomRightCorner(n, n) += st.bending_stiffness_y * gg;
      Mt += (st.rotary_inertia_y + st.rotary_inertia_z) * ff;
      Kt += st.torsional_stiffness * gg;
      Ma += st.mass_per_length * ff;
      Ka += st.axial_stiffness * gg;
    }
  }
  // The first function of each field is the one that moves the tip; a hinge leaves the slope along y to the shaft.
  const Condensed along_y = condense(My, Ky, options.hinged ? std::vector{0} : std::vector{0, n}, options.highest),
                  along_z = condense(Mz, Kz, {0, n}, options.highest), torsion = condense(Mt, Kt, {0}, options.highest),
                  axial = condense(Ma, Ka, {0}, options.highest);

  // Tip freedoms in shaft axes: x, y, z, turn about x, y, z. Shaft axes: x towards the tip, y the face's
  // normal made perpendicular to it.
  const Vec3 ex = -club.geometry.shaft_axis.normalized();
  Vec3 ey = Vec3::UnitX() - ex.x() * ex;
  if (ey.norm() < 0.1) ey = Vec3::UnitY() - ex.y() * ex;
  ey.normalize();
  Mat3 axes;
  axes << ex, ey, ex.cross(ey);
  Mat6 to_tip = Mat6::Zero();
  to_tip.topLeftCorner<3, 3>() = axes.transpose();
  to_tip.topRightCorner<3, 3>() = -axes.transpose() * skew(club.geometry.hosel - club.head.cg);
  to_tip.bottomRightCorner<3, 3>() = axes.transpose();
  if (!options.feels_translation) to_tip.leftCols<3>().setZero();
  if (!options.feels_rotation) to_tip.rightCols<3>().setZero();

  ShaftImpedance out;
  out.damping_time = shaft.damping_time;
  const int modes = static_cast<int>(along_y.frequency2.size() + along_z.frequency2.size() + torsion.frequency2.size() +
                                     axial.frequency2.size());
  Mat6 M = Mat6::Zero(), K = Mat6::Zero();
  Eigen::Matrix<double, 6, Eigen::Dynamic> G = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, modes);
  out.frequency2.resize(modes);
  int at = 0;
  const auto place = [&](const Condensed& c, const std::vector<int>& freedom, const std::vector<double>& sign) {
    const int k = static_cast<int>(c.frequency2.size());
    for (std::size_t i = 0; i < freedom.size(); ++i) {
      for (std::size_t j = 0; j < freedom.size(); ++j) {
        M(freedom[i], freedom[j]) += sign[i] * sign[j] * c.mass(i, j);
        K(freedom[i], freedom[j]) += sign[i] * sign[j] * c.stiffness(i, j);
      }
      G.row(freedom[i]).segment(at, k) = sign[i] * c.coupling.row(i);
    }
    out.frequency2.segment(at, k) = c.frequency2;
    at += k;
  };
  place(along_y, options.hinged ? std::vector{1} : std::vector{1, 5}, {1, 1});
  place(along_z, {2, 4}, {1, -1});
  place(torsion, {3}, {1});
  place(axial, {0}, {1});
  out.mass = to_tip.transpose() * M * to_tip;
  out.stiffness = to_tip.transpose() * K * to_tip;
  out.coupling = to_tip.transpose() * G;
  return out;
}

}  // namespace hosel::models
