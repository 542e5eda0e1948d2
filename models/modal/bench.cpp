#include "models/modal/bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "fem/supports.hpp"
#include "golf/dense.hpp"
#include "golf/shaft_library.hpp"
#include "mesh/gauss.hpp"
#include "models/club/swing.hpp"
#include "solvers/errors.hpp"
#include "solvers/linear.hpp"

namespace hosel::models {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Compliances, in the order of the factors.
enum Compliance { kBending, kTorsion, kClamp, kHosel = kClamp + 3, kCompliances = kHosel + 3 };

/// Of a rigid body about a point from which its centre lies at c.
Mat6 rigid_mass(double mass, const Mat3& inertia, const Vec3& c) {
  Mat6 m;
  m << mass * Mat3::Identity(), -mass * skew(c), mass * skew(c), inertia - mass * skew(c) * skew(c);
  return m;
}

struct Assembly {
  fem::System system;
  const fem::Beam* beam = nullptr;
};

void assemble(Assembly& a, const Shaft& shaft, const BenchOptions& o) {
  const double length = shaft.length() - o.clamped_length;
  const auto line =
      mesh::straight(mesh::graded(length, o.elements), Vec3::Zero(), mesh::frame_along(-Vec3::UnitZ(), Vec3::UnitX()));
  auto owned = std::make_unique<fem::Beam>(a.system.dof_map, line,
                                           fem::shaft_sections(shaft, o.shear, o.clamped_length), fem::BeamOptions{});
  a.beam = owned.get();
  a.system.terms.push_back(std::move(owned));
  a.system.prescribed.push_back(
      std::make_unique<fem::ImposedMotion>(a.beam->nodes().front(), fem::at_rest(Vec3::Zero())));
}

MatrixXd tangent(const Assembly& a, const fem::State& s, const fem::Weights& weights) {
  solvers::SparseTangent t(a.system);
  t.assemble(a.system, s, weights);
  const MatrixXd K = t.dense();
  return 0.5 * (K + K.transpose());
}

/// A force at the head's centre turns the head in line with it.
Mat3 pendulum_stiffness(const Vec3& force, const Vec3& c) {
  return force.dot(c) * Mat3::Identity() - 0.5 * (force * c.transpose() + c * force.transpose());
}

/// Beam equations first, then the head's six.
MatrixXd joined(const MatrixXd& beam, const Mat6& head) {
  MatrixXd m = MatrixXd::Zero(beam.rows() + 6, beam.cols() + 6);
  m.topLeftCorner(beam.rows(), beam.cols()) = beam;
  m.bottomRightCorner<6, 6>() = head;
  return m;
}

/// Stiffness of a pull along the shaft, `acceleration(s)` outwards at arc length s from the clamp, `head` [kg] at the
/// end.
MatrixXd pulled(const std::vector<mesh::LineNode>& line, const Shaft& shaft, double clamped, double head,
                const Vec3& cg, const std::function<double(double)>& acceleration) {
  const auto n = 6 * (std::ptrdiff_t(line.size()) - 1);
  MatrixXd K = MatrixXd::Zero(n, n);
  const double length = line.back().arc_length, at_head = head * acceleration(length - cg.z());
  const auto tension = [&](double s) {
    constexpr int slices = 200;
    const double h = (length - s) / slices;
    double outboard = at_head;
    for (int i = 0; i < slices; ++i) {
      const double at = s + (i + 0.5) * h;
      outboard += h * shaft.at(at + clamped).mass_per_length * acceleration(at);
    }
    return outboard;
  };
  const auto rule = mesh::gauss(3);
  for (std::size_t first = 0; first + 2 < line.size(); first += 2) {
    const double a = line[first].arc_length, half = 0.5 * (line[first + 2].arc_length - a);
    for (const auto& [x, w] : rule) {
      const Vec3 slope = Vec3(x - 0.5, -2 * x, x + 0.5) / half;
      const double pull = tension(a + half * (1 + x)) * w * half;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int d = 0; d < 2; ++d) {
            const auto row = 6 * (std::ptrdiff_t(first) + i - 1) + d, column = 6 * (std::ptrdiff_t(first) + j - 1) + d;
            if (row >= 0 && column >= 0) K(row, column) += pull * slope[i] * slope[j];
          }
    }
  }
  Mat6 turned = Mat6::Zero();
  turned.bottomRightCorner<3, 3>() = pendulum_stiffness(Vec3(0, 0, -at_head), cg);
  return joined(K, turned);
}

/// What the centrifugal field at one radian per second grows by with a displacement across its axis.
MatrixXd softening(const Vec3& axis, const MatrixXd& beam_mass, double head, const Vec3& cg) {
  const Mat3 across = Mat3::Identity() - axis * axis.transpose();
  MatrixXd P = MatrixXd::Zero(beam_mass.rows(), beam_mass.rows());
  for (std::ptrdiff_t i = 0; i < P.rows(); i += 6) P.block<3, 3>(i, i) = across;
  Eigen::Matrix<double, 3, 6> centre;
  centre << Mat3::Identity(), -skew(cg);
  return joined(dense::congruent(beam_mass, P), head * centre.transpose() * across * centre);
}

/// Solutions of F M u = u / omega^2 with M = root root', the lowest first; M may be zero at the head.
MatrixXd shapes(const MatrixXd& F, const MatrixXd& root, int count) {
  const dense::Eigenpairs all = dense::eigenpairs(dense::congruent(F, root));
  if (!all.converged) throw solvers::NonConvergence("bench: the modes of this shaft did not converge");
  MatrixXd U(F.rows(), count);
  for (int k = 0; k < count; ++k) {
    const auto at = F.rows() - 1 - k;
    U.col(k) = F * (root * all.vectors.col(at)) / all.values[at];
  }
  return U;
}

}  // namespace

Head changed(const Head& head, const ClubChange& change) {
  Head h = head;
  h.cg += change.cg;
  const Vec3 root = (0.5 * change.inertia).array().exp();
  h.inertia = root.asDiagonal() * head.inertia * root.asDiagonal();
  return h;
}

std::vector<std::string> BenchOptions::faults() const {
  std::vector<std::string> out;
  if (elements < 2) out.emplace_back("a bench shaft needs at least two elements");
  if (!(clamped_length >= 0)) out.emplace_back("the clamped length is not negative");
  if (std::abs(rotation_axis.z()) > 1e-12 || std::abs(rotation_axis.norm() - 1) > 1e-9)
    out.emplace_back("the clamp turns about XG or YG");
  return out;
}

Mat6 Bench::head_mass(const ClubChange& change) const {
  Mat6 m = Mat6::Zero();
  if (with_head_) {
    const Head h = changed(club_.head, change);
    const Mat3 R = face_to_grip(club_.geometry);
    m = rigid_mass(h.mass, R * h.inertia * R.transpose(), R * (h.cg - club_.geometry.hosel));
  }
  m.topLeftCorner<3, 3>() += change.tip_mass * Mat3::Identity();
  return m;
}

Bench::Bench(const Club& club, bool with_head, const BenchOptions& options, const std::vector<BenchSensor>& sensors)
    : club_(club), with_head_(with_head), options_(options) {
  if (!club.shaft) throw std::invalid_argument("a bench test needs a shaft");
  if (const auto wrong = faults(*club.shaft); !wrong.empty()) throw std::invalid_argument(wrong.front());
  if (const auto wrong = options.faults(); !wrong.empty()) throw std::invalid_argument("bench: " + wrong.front());
  length_ = club.shaft->length() - options.clamped_length;
  if (!(length_ > 0)) throw std::invalid_argument("the clamp holds the whole shaft");
  damping_time_ = club.shaft->damping_time;
  head0_ = head_mass({});
  const Mat3 turn = face_to_grip(club.geometry);
  const Vec3 cg = with_head ? Vec3(turn * (club.head.cg - club.geometry.hosel)) : Vec3::Zero();
  const double head = with_head ? club.head.mass : 0;

  // Beam alone: flexibility apart by compliance.
  Assembly plain, stiff;
  assemble(plain, *club.shaft, options);
  assemble(stiff, scaled(*club.shaft, 2, 1), options);
  fem::State rest = plain.system.dof_map.rest();
  plain.beam->place(rest);
  const MatrixXd K = tangent(plain, rest, {1, 0, 0}), Mb = tangent(plain, rest, {0, 0, 1});
  const auto nb = K.rows(), n = nb + 6;
  const MatrixXd whole = dense::Cholesky(K).inverse(),
                 half = dense::Cholesky(tangent(stiff, rest, {1, 0, 0})).inverse();
  MatrixXd S = MatrixXd::Zero(n, nb);
  S.topRows(nb).setIdentity();
  S.bottomRightCorner<6, 6>().setIdentity();
  std::vector<MatrixXd> F(kCompliances);
  F[kBending] = dense::congruent(2 * (whole - half), S.transpose());
  F[kTorsion] = dense::congruent(2 * half - whole, S.transpose());
  const auto& line = plain.beam->line();
  const auto place = [&](std::ptrdiff_t node) {
    return node < nb / 6 ? line[std::size_t(node) + 1].position : line.back().position;
  };
  for (int a = 0; a < 3; ++a) {
    VectorXd clamp = VectorXd::Zero(n), hosel = VectorXd::Zero(n);
    for (std::ptrdiff_t i = 0; i < n / 6; ++i) {
      clamp.segment<3>(6 * i) = Vec3::Unit(a).cross(place(i));
      clamp[6 * i + 3 + a] = 1;
    }
    hosel[nb + 3 + a] = 1;
    F[std::size_t(kClamp + a)] = clamp * clamp.transpose();
    F[std::size_t(kHosel + a)] = hosel * hosel.transpose();
  }
  const MatrixXd M = joined(Mb, head0_);

  // The basis: modes of the declared club and of clubs that differ in every way, and static responses.
  const auto rooted = [&](const Mat6& h) {
    MatrixXd root = MatrixXd::Zero(n, n);
    root.topLeftCorner(nb, nb) = dense::Cholesky(Mb).lower();
    const dense::Eigenpairs of_head = dense::eigenpairs(h);
    root.bottomRightCorner(6, 6) = of_head.vectors * of_head.values.cwiseMax(0).cwiseSqrt().asDiagonal();
    return root;
  };
  const double bend = length_ / club.shaft->at(options.clamped_length + 0.5 * length_).bending_stiffness_y;
  std::vector<MatrixXd> parts;
  const auto with = [&](const ClubChange& c, int count) {
    MatrixXd sum = F[kBending] + F[kTorsion];
    for (int a = 0; a < 3; ++a)
      sum += c.clamp[a] * F[std::size_t(kClamp + a)] + c.hosel[a] * F[std::size_t(kHosel + a)];
    const Mat6 h = head_mass(c);
    parts.push_back(shapes(sum, rooted(h), count));
  };
  with({}, 18);
  with({.clamp = Vec3::Constant(0.2 * bend)}, 8);
  with({.clamp = Vec3::Constant(2 * bend)}, 8);
  with({.tip_mass = 0.03}, 8);
  with({.tip_mass = 0.3}, 8);
  if (with_head) {
    with({.hosel = Vec3::Constant(0.1 * bend)}, 10);
    with({.hosel = Vec3::Constant(bend)}, 10);
    with({.cg = Vec3(0.02, 0.02, 0.02)}, 8);
    with({.cg = Vec3(-0.02, 0.02, -0.02)}, 8);
    with({.inertia = Vec3(1.2, -0.8, 1.2)}, 8);
  }
  parts.emplace_back((F[kBending] + F[kTorsion]).rightCols<6>());
  MatrixXd V(n, 0);
  for (const MatrixXd& part : parts)
    for (std::ptrdiff_t c = 0; c < part.cols(); ++c) {
      VectorXd u = part.col(c);
      const double before = std::sqrt(u.dot(M * u));
      if (!(before > 0)) continue;
      for (int pass = 0; pass < 2; ++pass) u -= V * (V.transpose() * (M * u));
      const double after = std::sqrt(u.dot(M * u));
      if (after < 1e-4 * before) continue;
      V.conservativeResize(n, V.cols() + 1);
      V.col(V.cols() - 1) = u / after;
    }
  basis_ = int(V.cols());
  if (basis_ == 0 || !V.allFinite()) throw std::invalid_argument("bench: the modes of this shaft are not finite");
  head_shape_ = V.bottomRows<6>().transpose();
  MatrixXd move = MatrixXd::Zero(n, 3);
  for (std::ptrdiff_t i = 0; i < n; i += 6) move.block<3, 3>(i, 0).setIdentity();
  base_shape_ = V.transpose() * M * move;

  weight_ = spin_ = MatrixXd::Zero(basis_, basis_);
  MatrixXd gravity = MatrixXd::Zero(n, n), turning = gravity;
  if (options.gravity.norm() > 0) {
    gravity = pulled(line, *club.shaft, options.clamped_length, head, cg, [&](double) { return -options.gravity.z(); });
    weight_ = dense::congruent(gravity, V);
  }
  if (options.rotation_rate != 0) {
    turning = pulled(line, *club.shaft, options.clamped_length, head, cg, [&](double s) { return options.hub + s; }) -
              softening(options.rotation_axis, Mb, head, cg);
    spin_ = dense::congruent(turning, V);
  }

  // What acts on the club, in one matrix W: inertia of the basis, forces on the head, forces of the two fields.
  MatrixXd W(n, 3 * basis_ + 6);
  MatrixXd T = MatrixXd::Zero(n, 6);
  T.bottomRows<6>().setIdentity();
  W << M * V, T, gravity * V, turning * V;
  for (const MatrixXd& f : F) flex_.emplace_back(dense::congruent(f, W));
  for (int a = 0; a < kCompliances; ++a) read_.emplace_back(MatrixXd::Zero(std::ptrdiff_t(sensors.size()), W.cols()));
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const auto row = std::ptrdiff_t(k);
    const BenchSensor& sensor = sensors[k];
    const double at = sensor.arc_length - options.clamped_length;
    if (!(at >= 0 && at <= length_ + 1e-9)) throw std::invalid_argument("a sensor lies off the free shaft");
    using Quantity = BenchSensor::Quantity;
    if (sensor.quantity == Quantity::strain_lead || sensor.quantity == Quantity::strain_droop) {
      // Strain of the fibre on the XG (YG) side: moment of what acts outboard, over EI, times the radius. Local y is
      // XG and local z is -YG: lead bends about z.
      const ShaftStation st = club.shaft->at(sensor.arc_length);
      const bool lead = sensor.quantity == Quantity::strain_lead;
      VectorXd g = VectorXd::Zero(n);
      const Vec3 about = lead ? Vec3::UnitY() : Vec3(-Vec3::UnitX());
      for (std::ptrdiff_t i = 0; i < n / 6; ++i) {
        const Vec3 x = place(i);
        if (-x.z() <= at) continue;
        g.segment<3>(6 * i) = about.cross(Vec3(x + at * Vec3::UnitZ()));
        g.segment<3>(6 * i + 3) = about;
      }
      read_[kBending].row(row) = sensor.radius.value_or(st.outer_radius) /
                                 (lead ? st.bending_stiffness_z : st.bending_stiffness_y) * g.transpose() * W;
      continue;
    }
    std::ptrdiff_t node = nb / 6;  // the head's
    if (at < length_ - 1e-9) {
      node = 0;
      for (std::ptrdiff_t i = 0; i < nb / 6; ++i)
        if (std::abs(-place(i).z() - at) < std::abs(-place(node).z() - at)) node = i;
    }
    const int entry = sensor.quantity == Quantity::lead         ? 0
                      : sensor.quantity == Quantity::droop      ? 1
                      : sensor.quantity == Quantity::shortening ? 2
                                                                : 5;
    for (int a = 0; a < kCompliances; ++a) read_[std::size_t(a)].row(row) = F[std::size_t(a)].row(6 * node + entry) * W;
  }
}

BenchModes Bench::modes(const ClubChange& change, int count) const {
  const int r = basis_;
  std::array<double, kCompliances> yields{};
  yields[kBending] = std::exp(-change.bending);
  yields[kTorsion] = std::exp(-change.torsion);
  for (int a = 0; a < 3; ++a) {
    yields[std::size_t(kClamp + a)] = change.clamp[a];
    yields[std::size_t(kHosel + a)] = change.hosel[a];
  }
  MatrixXd G = yields[0] * flex_[0], R = yields[0] * read_[0];
  for (std::size_t a = 1; a < kCompliances; ++a)
    if (yields[a] != 0) {
      G += yields[a] * flex_[a];
      R += yields[a] * read_[a];
    }
  const Mat6 more = head_mass(change) - head0_;
  const MatrixXd added = more * head_shape_.transpose();  // forces on the head
  MatrixXd C = MatrixXd::Zero(G.rows(), r);
  C.topRows(r).setIdentity();
  C.middleRows(r, 6) = added;
  MatrixXd B = MatrixXd::Identity(r, r) + head_shape_ * added;
  B = (0.5 * (B + B.transpose())).eval();
  MatrixXd A = C.transpose() * (G * C);
  A = (0.5 * (A + A.transpose())).eval();
  const double turning = change.stiffening * options_.rotation_rate * options_.rotation_rate;
  const bool field = options_.gravity.norm() > 0 || turning != 0;
  dense::Eigenpairs all;
  if (!field) {
    all = dense::eigenpairs(A, B);
  } else {
    MatrixXd K = B * dense::Cholesky(A).solve(B) + weight_ + turning * spin_;
    K = (0.5 * (K + K.transpose())).eval();
    all = dense::eigenpairs(B, K);
  }
  if (!all.converged)
    throw std::invalid_argument("this club cannot vibrate: it buckles, or its stiffness or mass is not positive");
  const int m = std::min(count, r);
  BenchModes out;
  out.omega.resize(m);
  out.ratio.resize(m);
  out.sensors.resize(R.rows(), m);
  out.tip.resize(6, m);
  out.base.resize(3, m);
  MatrixXd move = base_shape_;  // r x 3
  move += head_shape_ * more.leftCols<3>();
  for (int k = 0; k < m; ++k) {
    const auto at = r - 1 - k;
    const double inverse = all.values[at];  // 1 / omega^2
    if (!(inverse > 0)) throw std::invalid_argument("this club cannot vibrate: it buckles");
    VectorXd a = all.vectors.col(at);
    a /= std::sqrt(a.dot(B * a));
    VectorXd force = C * a / inverse;
    if (field) {
      force.segment(r + 6, r) = -a;
      force.tail(r) = -turning * a;
    }
    out.omega[k] = 1 / std::sqrt(inverse);
    out.sensors.col(k) = R * force;
    out.tip.col(k) = G.middleRows(r, 6) * force;
    out.base.col(k) = move.transpose() * a;
    // Unit modal mass: twice the ratio times omega is what the shaft's dampers take; a field stiffens and damps
    // nothing.
    const double shaft = yields[0] * force.dot(flex_[0] * force) + yields[1] * force.dot(flex_[1] * force);
    out.ratio[k] = 0.5 * ((damping_time_ + change.damping_time) * shaft + change.mass_damping) / out.omega[k] +
                   change.damping_ratio;
  }
  return out;
}

}  // namespace hosel::models
