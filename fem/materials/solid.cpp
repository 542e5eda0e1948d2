#include "fem/materials/solid.hpp"

#include <cmath>

namespace hosel::fem {
namespace {

using ConstSym = Eigen::Map<const Sym>;

/// P = F S and its tangent from those of S.
void push(const Mat3& F, const Response& r, bool tangent, PointResponse& out) {
  const Mat3 S = to_matrix(r.stress);
  out.energy = r.energy;
  out.stress.noalias() = F * S;
  if (!tangent) return;
  Eigen::Matrix<double, 9, 6> B;
  for (int v = 0; v < 6; ++v) {
    const int a = kSymRow[v], b = kSymColumn[v];
    B.col(v).setZero();
    B.col(v).segment<3>(3 * a) = F.col(b);
    if (a != b) B.col(v).segment<3>(3 * b) = F.col(a);
  }
  out.tangent.noalias() = (B * r.tangent) * B.transpose();
  for (int I = 0; I < 3; ++I)
    for (int K = 0; K < 3; ++K)
      for (int i = 0; i < 3; ++i) out.tangent(i + 3 * I, i + 3 * K) += S(I, K);
}

}  // namespace

std::vector<std::string> Solid::faults() const {
  std::vector<std::string> out;
  if (!(density > 0)) out.emplace_back("a material needs a positive density");
  if (!(bulk() > 0)) out.emplace_back("a material needs a positive bulk modulus");
  if (!(shear() > 0)) out.emplace_back("a material needs a positive long-term shear modulus");
  if (elastic.corotated() && !branches.empty())
    out.emplace_back(
        "small-strain linear elasticity is for comparison with theory and takes no relaxation: use neo-hooke");
  for (auto& fault : elastic.faults()) out.push_back(std::move(fault));
  for (const auto& b : branches) {
    if (!(b.modulus >= 0)) out.emplace_back("a relaxation branch needs a modulus of at least zero");
    if (!(b.time > 0)) out.emplace_back("a relaxation branch needs a positive time");
  }
  return out;
}

double Solid::instant_shear() const {
  double sum = shear();
  for (const auto& b : branches) sum += b.modulus;
  return sum;
}

void Solid::start(std::span<double> history) const {
  if (branches.empty()) return;
  Eigen::Map<Sym>(history.data()) = sym_identity();
  for (std::size_t b = 0; b < branches.size(); ++b) {
    Eigen::Map<Sym>(history.data() + 6 + 7 * b) = sym_identity();
    history[12 + 7 * b] = 0;
  }
}

void evaluate(const Solid& solid, const Mat3& F, const Mat3& frame, double dt, std::span<const double> history,
              bool tangent, PointResponse& out) {
  if (solid.elastic.corotated()) return solid.elastic.evaluate(F, frame, tangent, out);
  // det C cannot tell an inverted point from an upright one: only F can.
  if (!solid.elastic.bears_inversion() && !(F.determinant() > 0)) {
    out.energy = NAN;
    out.stress.setConstant(NAN);
    if (tangent) out.tangent.setConstant(NAN);
    return;
  }
  const Sym C = to_sym(F.transpose() * F);
  Response r;
  solid.elastic.add(C, tangent, r);
  if (!solid.branches.empty()) {
    const double det = determinant(C), p = 1 / std::cbrt(det);
    const Sym Ci = inverse(C, det);
    const Sym C0 = ConstSym(history.data());
    for (std::size_t b = 0; b < solid.branches.size(); ++b)
      solid.branches[b].add(C, Ci, p, ConstSym(history.data() + 6 + 7 * b), C0, dt, tangent, r);
  }
  push(F, r, tangent, out);
}

double update_internal_variables(const Solid& solid, const Mat3& F, double dt, std::span<double> history) {
  if (solid.branches.empty()) return 0;
  const Sym C = to_sym(F.transpose() * F);
  const Sym C1 = C / std::cbrt(determinant(C));
  Eigen::Map<Sym> C0(history.data());
  double dissipated = 0;
  for (std::size_t b = 0; b < solid.branches.size(); ++b) {
    const MaxwellBranch& branch = solid.branches[b];
    Eigen::Map<Sym> B(history.data() + 6 + 7 * b);
    double& rate = history[12 + 7 * b];
    B = branch.flow(B, C0, C1, dt);
    const double before = rate;
    rate = branch.dissipation(C1, B);
    dissipated += 0.5 * dt * (before + rate);
  }
  C0 = C1;
  return dissipated;
}

}  // namespace hosel::fem
