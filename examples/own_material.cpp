// A material of one's own: Gent's rubber, whose chains have a longest stretch. One struct; the compiler says what it
// lacks. Checked here against differences of its own energy, then a ball of it is dropped on a wall.
// A. N. Gent, Rubber Chem. Technol. 69 (1996) 59-61.
#include <cmath>
#include <cstdio>

#include "models/fe/impact.hpp"

namespace {

using namespace hosel;
using fem::Sym;

/// W = -mu/2 Jm ln(1 - (I1' - 3)/Jm) + K/2 (J - 1)^2.
struct Gent {
  double mu = 0;     ///< shear modulus [Pa]
  double limit = 1;  ///< Jm: I1' - 3 of the longest stretch [-]
  double bulk = 0;   ///< K [Pa]

  double shear() const { return mu; }
  double bulk_modulus() const { return bulk; }
  void stiffen(double factor) { mu *= factor; }
  std::vector<std::string> faults() const {
    if (!(limit > 0)) return {"Gent: the limit of I1' - 3 must be positive"};
    return {};
  }

  void add(const Sym& C, bool tangent, fem::Response& out) const {
    const double det = fem::determinant(C), J = std::sqrt(det), p = 1 / std::cbrt(det);
    const Sym Ci = fem::inverse(C, det);
    const double I1 = C[0] + C[1] + C[2], x = p * I1 - 3, room = limit - x;  // NaN energy beyond: no step accepts it
    const double W1 = 0.5 * mu * limit / room, W11 = W1 / room;
    const Sym D1 = p * (fem::sym_identity() - (I1 / 3) * Ci);
    out.energy += -0.5 * mu * limit * std::log(room / limit) + 0.5 * bulk * (J - 1) * (J - 1);
    out.stress += 2 * W1 * D1 + bulk * (J - 1) * J * Ci;
    if (!tangent) return;
    const Mat6 IC = fem::symmetric_product(Ci), mixed = fem::sym_identity() * Ci.transpose();
    out.tangent += 4 * W1 * p * (-(mixed + mixed.transpose()) / 3 + (I1 / 9) * Ci * Ci.transpose() + (I1 / 3) * IC) +
                   4 * W11 * D1 * D1.transpose() + bulk * J * (2 * J - 1) * Ci * Ci.transpose() -
                   2 * bulk * J * (J - 1) * IC;
  }
};

/// Largest error of stress against differences of the energy, and of tangent against differences of the stress.
double worst_error(const fem::Solid& solid) {
  Mat3 F;
  F << 1.1, 0.2, -0.1, 0.05, 0.9, 0.15, -0.2, 0.1, 1.05;
  const double h = 1e-6;
  fem::PointResponse at, plus, minus;
  fem::evaluate(solid, F, Mat3::Identity(), 0, {}, true, at);
  double worst = 0;
  for (int k = 0; k < 9; ++k) {
    Mat3 step = Mat3::Zero();
    step(k % 3, k / 3) = h;
    fem::evaluate(solid, F + step, Mat3::Identity(), 0, {}, false, plus);
    fem::evaluate(solid, F - step, Mat3::Identity(), 0, {}, false, minus);
    const Mat3 slope = (plus.stress - minus.stress) / (2 * h);
    worst =
        std::max(worst, std::abs((plus.energy - minus.energy) / (2 * h) - at.stress(k % 3, k / 3)) / at.stress.norm());
    worst = std::max(worst, (slope.reshaped() - at.tangent.col(k)).norm() / at.tangent.norm());
  }
  return worst;
}

}  // namespace

int main() {
  const fem::Solid rubber{.elastic = Gent{.mu = 25e6, .limit = 8, .bulk = 1e9}, .branches = {}, .density = 1129};
  const double error = worst_error(rubber);
  std::printf("stress and tangent against differences: %.1e\n", error);

  Blow drop;
  drop.club.head.mass = INFINITY;
  drop.delivery.club_speed = 30;
  models::FeImpactOptions options;
  options.ball = models::elastic_ball("gent", rubber);
  options.harmonics = 0;
  options.mesh = {.sector = 3, .rings = 3, .pole = 0.4, .skin = 0.5, .core = 0.4};
  const models::FeOutcome out = models::Impact(options).run(drop);
  const double e = out.launch.velocity.x() / 30 - 1;
  std::printf("restitution %.3f, contact %.3f ms, largest force %.1f kN\n", e, 1e3 * out.result.contact_time,
              1e-3 * out.result.peak_force);
  // No losses but vibration: a ball of rubber gives nearly all of it back.
  return error < 1e-6 && e > 0.9 && e < 1 && out.result.peak_force > 1e3 ? 0 : 1;
}
