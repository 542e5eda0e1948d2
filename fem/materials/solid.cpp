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
    const double det = determinant(C), p = inverse_cbrt(det);
    const Sym Ci = inverse(C, det);
    const Sym C0 = ConstSym(history.data());
    for (std::size_t b = 0; b < solid.branches.size(); ++b) {
      const MaxwellBranch& branch = solid.branches[b];
      branch.add(C, Ci, p, branch.start(ConstSym(history.data() + 6 + 7 * b), C0, dt), tangent, r);
    }
  }
  push(F, r, tangent, out);
}

namespace {

SymLanes metric(const Mat3Lanes& F) {
  SymLanes C;
  for (std::size_t v = 0; v < 6; ++v) {
    const auto a = static_cast<std::size_t>(3 * kSymRow[v]), b = static_cast<std::size_t>(3 * kSymColumn[v]);
    C[v] = F[a] * F[b] + F[a + 1] * F[b + 1] + F[a + 2] * F[b + 2];
  }
  return C;
}

Lanes volume_ratio(const Mat3Lanes& F) {
  return F[0] * (F[4] * F[8] - F[7] * F[5]) - F[3] * (F[1] * F[8] - F[7] * F[2]) + F[6] * (F[1] * F[5] - F[4] * F[2]);
}

SymLanes base_of(const double* starts, std::ptrdiff_t stride) {
  SymLanes out;
  for (std::size_t i = 0; i < 6; ++i) load(out[i], starts + static_cast<std::ptrdiff_t>(i) * stride);
  return out;
}

}  // namespace

void evaluate(const Solid& solid, const Mat3Lanes& F, const double* starts, std::ptrdiff_t stride, Mat3Lanes& stress,
              Lanes& energy) {
  MetricLanes at{metric(F), {}, volume_ratio(F), {}};
  const Lanes det = at.J * at.J, over = 1.0 / det;
  inverse_cbrt(det, at.p);
  at.inverse = adjugate(at.C);
  for (Lanes& x : at.inverse) x *= over;
  ResponseLanes r;
  solid.elastic.add(at, r);
  for (std::size_t b = 0; b < solid.branches.size(); ++b) {
    const double* own = starts + static_cast<std::ptrdiff_t>(7 * b) * stride;
    Lanes gain, scale;
    load(gain, own + 6 * stride);
    SymLanes A;
    solid.branches[b].add_stress(at.C, at.inverse, at.p, base_of(own, stride), gain, r.energy, r.stress, A, scale);
  }
  for (int l = 0; l < kLanes; ++l)
    if (!(at.J[l] > 0)) r.energy[l] = NAN;
  energy = r.energy;
  const Lanes upright = 0.0 * energy;  // NaN where a point is inverted
  const auto& S = r.stress;
  for (std::size_t i = 0; i < 3; ++i) {
    stress[i] = F[i] * S[0] + F[i + 3] * S[3] + F[i + 6] * S[5] + upright;
    stress[i + 3] = F[i] * S[3] + F[i + 3] * S[1] + F[i + 6] * S[4] + upright;
    stress[i + 6] = F[i] * S[5] + F[i + 3] * S[4] + F[i + 6] * S[2] + upright;
  }
}

void start_step(const Solid& solid, double dt, std::span<const double> history, double* out, std::ptrdiff_t stride) {
  for (std::size_t b = 0; b < solid.branches.size(); ++b) {
    const MaxwellBranch::Start s =
        solid.branches[b].start(ConstSym(history.data() + 6 + 7 * b), ConstSym(history.data()), dt);
    for (Eigen::Index i = 0; i < 6; ++i, out += stride) *out = s.base[i];
    *out = s.gain;
    out += stride;
  }
}

double update_internal_variables(const Solid& solid, const Mat3& F, double dt, std::span<double> history) {
  if (solid.branches.empty()) return 0;
  const Sym C = to_sym(F.transpose() * F);
  const Sym C1 = inverse_cbrt(determinant(C)) * C;
  Eigen::Map<Sym> C0(history.data());
  double dissipated = 0;
  for (std::size_t b = 0; b < solid.branches.size(); ++b) {
    const MaxwellBranch& branch = solid.branches[b];
    Eigen::Map<Sym> B(history.data() + 6 + 7 * b);
    double& rate = history[12 + 7 * b];
    double scale = 0;
    const MaxwellBranch::Start from = branch.start(B, C0, dt);
    B = MaxwellBranch::flow(from.base, from.gain, C1, scale);
    const double before = rate;
    rate = branch.dissipation(C1, Sym(B));
    dissipated += 0.5 * dt * (before + rate);
  }
  C0 = C1;
  return dissipated;
}

double update_internal_variables(const Solid& solid, const Mat3Lanes& F, const double* starts, std::ptrdiff_t stride,
                                 double dt, int count, std::span<double> history) {
  if (solid.branches.empty()) return 0;
  const auto size = static_cast<std::size_t>(solid.history_size());
  SymLanes C1 = metric(F);
  Lanes p;
  inverse_cbrt(determinant(C1), p);
  for (Lanes& x : C1) x *= p;
  double dissipated = 0;
  const auto keep = [&](const SymLanes& value, std::size_t at) {
    for (int l = 0; l < count; ++l)
      for (std::size_t i = 0; i < 6; ++i) history[static_cast<std::size_t>(l) * size + at + i] = value[i][l];
  };
  for (std::size_t b = 0; b < solid.branches.size(); ++b) {
    const MaxwellBranch& branch = solid.branches[b];
    const double* own = starts + static_cast<std::ptrdiff_t>(7 * b) * stride;
    Lanes gain, scale;
    load(gain, own + 6 * stride);
    const SymLanes B = MaxwellBranch::flow(base_of(own, stride), gain, C1, scale);
    const Lanes rates = branch.dissipation(C1, B);
    keep(B, 6 + 7 * b);
    for (int l = 0; l < count; ++l) {
      double& rate = history[static_cast<std::size_t>(l) * size + 12 + 7 * b];
      dissipated += 0.5 * dt * (rate + rates[l]);
      rate = rates[l];
    }
  }
  keep(C1, 0);
  return dissipated;
}

}  // namespace hosel::fem
