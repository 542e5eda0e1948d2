#include "fem/beam.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "fem/rotation_forms.hpp"
#include "mesh/gauss.hpp"

namespace hosel::fem {
namespace {

using Mat12 = Eigen::Matrix<double, 12, 12>;
using Mat12x18 = Eigen::Matrix<double, 12, 18>;
using Mat18 = Eigen::Matrix<double, 18, 18>;

Vec3 shape(double x) { return {0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)}; }
Vec3 shape_derivative(double x) { return {x - 0.5, -2 * x, x + 0.5}; }

/// Shear-rigid: stiff against the bending of one element, so that the frequencies move by
/// less than 1e-5 of what the mesh does, and the tangent stays well conditioned.
constexpr double kHeldShear = 1e5;

void check(const Section& s, double at) {
  const bool good = s.axial > 0 && s.shear_y > 0 && s.shear_z > 0 && s.torsion > 0 && s.bending_y > 0 &&
                    s.bending_z > 0 && s.mass >= 0 && s.rotary.minCoeff() >= 0;
  if (!good)
    throw std::invalid_argument("the beam's section at " + std::to_string(at) +
                                " m has a stiffness that is not positive or a negative mass");
}

/// Stiffness of (gamma, kappa) in the section's axes.
Mat6 section_stiffness(const Vec3& force, const Section& s) {
  Mat6 at_centres = Mat6::Identity();  // the strains there: gamma + kappa x r
  at_centres(0, 4) = s.centres.elastic[1];
  at_centres(0, 5) = -s.centres.elastic[0];
  at_centres(1, 3) = -s.centres.shear[1];
  at_centres(2, 3) = s.centres.shear[0];
  Vec6 own;
  own << force, s.torsion, s.bending_y, s.bending_z;
  return at_centres.transpose() * own.asDiagonal() * at_centres;
}

Mat3 exp_matrix(const Vec3& w) { return rotation_exp(w).toRotationMatrix(); }

}  // namespace

std::vector<Index> dofs(const Node& node) {
  std::vector<Index> out;
  for (Index i = 0; i < 3; ++i) out.push_back(node.translation.v + i);
  for (Index i = 0; i < 3; ++i) out.push_back(node.rotation.v + i);
  return out;
}

/// An element relative to its middle node: p = (y1, psi1, y3, psi3).
struct Beam::Kinematics {
  Mat3 R2;                               // of the middle node
  std::array<Vec3, 2> y, psi;            // nodes 1 and 3: R2^T (x - x2), log(R2^T R)
  std::array<Mat3, 2> relative;          // R2^T R
  std::array<RotationForm, 2> log_form;  // T(psi)^-1

  /// Derivative of p by the nodes' increments (translations global, rotations body frame).
  Mat12x18 jacobian() const {
    Mat12x18 J = Mat12x18::Zero();
    for (int k = 0; k < 2; ++k) {
      const int row = 6 * k, column = 12 * k;
      J.block<3, 3>(row, column) = R2.transpose();
      J.block<3, 3>(row, 6) = -R2.transpose();
      J.block<3, 3>(row, 9) = skew(y[k]);
      const Mat3 log_tangent = log_form[k].matrix(psi[k]);
      J.block<3, 3>(row + 3, column + 3) = log_tangent;
      J.block<3, 3>(row + 3, 9) = -log_tangent * relative[k].transpose();
    }
    return J;
  }
};

/// d/dt of p.
struct Beam::Rates {
  std::array<Vec3, 2> y{Vec3::Zero(), Vec3::Zero()}, psi = y;
};

namespace {

/// One Gauss point: strains and what their derivatives by p are made of.
struct PointStrain {
  Vec3 psi, dpsi, dy;
  Vec6 strain;  // gamma, kappa
  RotationForm turn, curve;
};

template <class Kinematics, class Point>
PointStrain point_strain(const Kinematics& k, const Point& g) {
  PointStrain s;
  s.psi = g.N[0] * k.psi[0] + g.N[2] * k.psi[1];
  s.dpsi = g.dN[0] * k.psi[0] + g.dN[2] * k.psi[1];
  s.dy = g.dN[0] * k.y[0] + g.dN[2] * k.y[1];
  const ExponentialForms forms = exponential_forms(s.psi.squaredNorm());
  s.turn = forms.transposed;
  s.curve = forms.tangent;
  s.strain << s.turn.times(s.psi, s.dy) - g.tangent, s.curve.times(s.psi, s.dpsi);
  return s;
}

template <class Rates, class Point>
Vec6 strain_rate(const PointStrain& s, const Point& g, const Rates& r) {
  const Vec3 psi = g.N[0] * r.psi[0] + g.N[2] * r.psi[1], dpsi = g.dN[0] * r.psi[0] + g.dN[2] * r.psi[1],
             dy = g.dN[0] * r.y[0] + g.dN[2] * r.y[1];
  Vec6 rate;
  rate << s.turn.times(s.psi, dy) + s.turn.change(s.psi, s.dy, psi),
      s.curve.times(s.psi, dpsi) + s.curve.change(s.psi, s.dpsi, psi);
  return rate;
}

/// Derivative of the strains by p.
template <class Point>
Eigen::Matrix<double, 6, 12> strain_matrix(const PointStrain& s, const Point& g) {
  const Mat3 Vc = s.turn.matrix(s.psi), Vt = s.curve.matrix(s.psi), Dc = s.turn.derivative(s.psi, s.dy),
             Dt = s.curve.derivative(s.psi, s.dpsi);
  Eigen::Matrix<double, 6, 12> B = Eigen::Matrix<double, 6, 12>::Zero();
  for (int k = 0; k < 2; ++k) {
    const double N = g.N[2 * k], dN = g.dN[2 * k];
    B.block<3, 3>(0, 6 * k) = dN * Vc;
    B.block<3, 3>(0, 6 * k + 3) = N * Dc;
    B.block<3, 3>(3, 6 * k + 3) = N * Dt + dN * Vt;
  }
  return B;
}

}  // namespace

Beam::Beam(DofMap& dof_map, const std::vector<mesh::LineNode>& line, const SectionLaw& sections, BeamOptions options)
    : options_(std::move(options)), line_(line) {
  if (line.size() < 3 || line.size() % 2 == 0) throw std::invalid_argument("a beam needs 2 n + 1 nodes for n elements");
  if (!(options_.damping_time >= 0)) throw std::invalid_argument("the damping time of a beam is not negative");
  for (std::size_t i = 0; i < line.size(); ++i)
    if (i == 0 && options_.first) nodes_.push_back(*options_.first);
    else if (i + 1 == line.size() && options_.last) nodes_.push_back(*options_.last);
    else nodes_.push_back({dof_map.add_vector(3), dof_map.add_rotation()});
  rotary_.assign(line.size(), Mat3::Zero());
  moment_.assign(line.size(), Vec3::Zero());
  weight_.assign(line.size(), 0);

  // Four points integrate mass times two shape functions of a cubic taper.
  const auto stiffness_rule = mesh::gauss(2), mass_rule = mesh::gauss(4);
  for (std::size_t first = 0; first + 2 < line.size(); first += 2) {
    Element e;
    for (std::size_t i = first; i < first + 3; ++i)
      for (Index q : dofs(nodes_[i])) e.dofs.push_back(q);
    const Vec3 arc(line[first].arc_length, line[first + 1].arc_length, line[first + 2].arc_length);
    const double length = arc[2] - arc[0];
    const Eigen::Quaterniond q2(line[first + 1].frame);
    const Vec3 w1 = rotation_log(q2.conjugate() * Eigen::Quaterniond(line[first].frame));
    const Vec3 w3 = rotation_log(q2.conjugate() * Eigen::Quaterniond(line[first + 2].frame));
    const auto frame_at = [&](const Vec3& N) {
      return Mat3(line[first + 1].frame * exp_matrix(N[0] * w1 + N[2] * w3));
    };

    for (std::size_t i = 0; i < 2; ++i) {
      Point& g = e.points[i];
      const double x = stiffness_rule[i].first;
      g.N = shape(x);
      const double ds = shape_derivative(x).dot(arc);
      g.dN = shape_derivative(x) / ds;
      g.weight = ds;
      g.arc_length = g.N.dot(arc);
      g.frame = frame_at(g.N);
      g.tangent.setZero();
      for (int n = 0; n < 3; ++n) g.tangent += g.dN[n] * line[first + static_cast<std::size_t>(n)].position;
      const Section s = sections(g.arc_length);
      check(s, g.arc_length);
      const double held = kHeldShear / (length * length);
      const Vec3 force(s.axial, std::isinf(s.shear_y) ? held * s.bending_z : s.shear_y,
                       std::isinf(s.shear_z) ? held * s.bending_y : s.shear_z);
      Mat6 frames = Mat6::Zero();
      frames.topLeftCorner<3, 3>() = frames.bottomRightCorner<3, 3>() = g.frame;
      g.stiffness = frames * section_stiffness(force, s) * frames.transpose();
    }
    e.mass.setZero();
    for (const auto& [x, w] : mass_rule) {
      const Vec3 N = shape(x);
      const double weight = w * shape_derivative(x).dot(arc), at = N.dot(arc);
      const Section s = sections(at);
      check(s, at);
      e.mass += weight * s.mass * N * N.transpose();
      const Mat3 frame = frame_at(N);
      const Vec3 centre = frame * Vec3(0, s.centres.mass[0], s.centres.mass[1]);
      const Mat3 J = frame * s.rotary.asDiagonal() * frame.transpose() - s.mass * skew(centre) * skew(centre);
      for (int n = 0; n < 3; ++n) {
        rotary_[first + static_cast<std::size_t>(n)] += weight * N[n] * J;
        moment_[first + static_cast<std::size_t>(n)] += weight * N[n] * s.mass * centre;
        weight_[first + static_cast<std::size_t>(n)] += weight * N[n] * s.mass;
      }
    }
    elements_.push_back(std::move(e));
  }
}

void Beam::place(State& s) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    s.q.segment<3>(nodes_[i].translation.q) = line_[i].position;
    set_rotation(s, nodes_[i].rotation, Eigen::Quaterniond::Identity());
  }
}

void Beam::pattern(std::vector<std::vector<Index>>& blocks) const {
  for (const Element& e : elements_) blocks.push_back(e.dofs);
}

Mat3 Beam::attitude(const State& s, std::size_t node) const {
  return rotation(s, nodes_[node].rotation).toRotationMatrix();
}

Beam::Kinematics Beam::kinematics(const State& s, const Element& e) const {
  const std::size_t first = 2 * static_cast<std::size_t>(&e - elements_.data());
  const Node& middle = nodes_[first + 1];
  const Eigen::Quaterniond q2 = rotation(s, middle.rotation);
  Kinematics k;
  k.R2 = q2.toRotationMatrix();
  for (std::size_t i = 0; i < 2; ++i) {
    const Node& node = nodes_[first + 2 * i];
    k.y[i] = k.R2.transpose() * (s.q.segment<3>(node.translation.q) - s.q.segment<3>(middle.translation.q));
    const Eigen::Quaterniond relative = q2.conjugate() * rotation(s, node.rotation);
    k.psi[i] = rotation_log(relative);
    k.relative[i] = relative.toRotationMatrix();
    k.log_form[i] = exp_tangent_inverse(k.psi[i].squaredNorm());
  }
  return k;
}

Beam::Rates Beam::rates(const State& s, const Element& e, const Kinematics& k) const {
  const Vec3 v2 = s.v.segment<3>(e.dofs[6]), w2 = s.v.segment<3>(e.dofs[9]);
  Rates r;
  for (std::size_t i = 0; i < 2; ++i) {
    const Index at = e.dofs[12 * i], turn = e.dofs[12 * i + 3];
    r.y[i] = k.R2.transpose() * (s.v.segment<3>(at) - v2) + k.y[i].cross(w2);
    r.psi[i] = k.log_form[i].times(k.psi[i], s.v.segment<3>(turn) - k.relative[i].transpose() * w2);
  }
  return r;
}

void Beam::residual(const State& s, Vector& inertia, Vector& force) const {
  const double tau = options_.damping_time;
  for (const Element& e : elements_) {
    const Kinematics k = kinematics(s, e);
    Rates rate;
    if (tau > 0) rate = rates(s, e, k);
    std::array<Vec3, 2> gy{Vec3::Zero(), Vec3::Zero()}, gpsi = gy;
    for (const Point& g : e.points) {
      const PointStrain p = point_strain(k, g);
      Vec6 strain = p.strain;
      if (tau > 0) strain += tau * strain_rate(p, g, rate);
      const Vec6 stress = g.stiffness * strain;
      const Vec3 n = stress.head<3>(), m = stress.tail<3>();
      const Vec3 along = p.turn.transposed_times(p.psi, n), curve = p.curve.transposed_times(p.psi, m);
      const Vec3 turn = p.turn.gradient(p.psi, p.dy, n) + p.curve.gradient(p.psi, p.dpsi, m);
      for (std::size_t i = 0; i < 2; ++i) {
        const auto node = static_cast<Index>(2 * i);
        gy[i] += g.weight * g.dN[node] * along;
        gpsi[i] += g.weight * (g.N[node] * turn + g.dN[node] * curve);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t at = 12 * i;
      const Vec3 f = k.R2 * gy[i], m = k.log_form[i].transposed_times(k.psi[i], gpsi[i]);
      force.segment<3>(e.dofs[at]) += f;
      force.segment<3>(e.dofs[6]) -= f;
      force.segment<3>(e.dofs[at + 3]) += m;
      force.segment<3>(e.dofs[9]) += gy[i].cross(k.y[i]) - k.relative[i] * m;
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        inertia.segment<3>(e.dofs[6 * i]) += e.mass(static_cast<Index>(i), static_cast<Index>(j)) *
                                             s.a.segment<3>(e.dofs[6 * j]);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Index t = nodes_[i].translation.v, r = nodes_[i].rotation.v;
    const Vec3 w = s.v.segment<3>(r), turn = s.a.segment<3>(r);
    inertia.segment<3>(r) += rotary_[i] * turn + w.cross(rotary_[i] * w);
    force.segment<3>(t) -= weight_[i] * options_.gravity;
    if (moment_[i].isZero(0)) continue;
    const Mat3 R = attitude(s, i);
    inertia.segment<3>(t) += R * (turn.cross(moment_[i]) + w.cross(w.cross(moment_[i])));
    inertia.segment<3>(r) += moment_[i].cross(R.transpose() * s.a.segment<3>(t));
    force.segment<3>(r) -= moment_[i].cross(R.transpose() * options_.gravity);
  }
}

void Beam::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  const double tau = options_.damping_time;
  const double material = weights.stiffness + tau * weights.damping;
  for (const Element& e : elements_) {
    Mat18 K = Mat18::Zero();
    const std::size_t first = 2 * static_cast<std::size_t>(&e - elements_.data());
    if (material != 0) {
      const Kinematics k = kinematics(s, e);
      const Mat12x18 J = k.jacobian();
      Rates rate;
      if (tau > 0) rate = rates(s, e, k);
      Mat12 H = Mat12::Zero();
      std::array<Vec3, 2> gy{Vec3::Zero(), Vec3::Zero()}, gpsi = gy;
      for (const Point& g : e.points) {
        const PointStrain p = point_strain(k, g);
        const Eigen::Matrix<double, 6, 12> B = strain_matrix(p, g);
        Vec6 strain = p.strain;
        if (tau > 0) strain += tau * strain_rate(p, g, rate);
        const Vec6 stress = g.stiffness * strain;
        const Vec3 n = stress.head<3>(), m = stress.tail<3>();
        // Lazy: Eigen would pack products of this size for its cache.
        const Eigen::Matrix<double, 6, 12> CB = (g.weight * material * g.stiffness).lazyProduct(B);
        H.noalias() += B.transpose().lazyProduct(CB);
        if (weights.stiffness == 0) continue;
        const double w = g.weight * weights.stiffness;
        const Mat3 turn = p.turn.hessian(p.psi, n, p.dy) + p.curve.hessian(p.psi, m, p.dpsi);
        const Mat3 stretch = p.turn.dual_derivative(p.psi, n), curve = p.curve.dual_derivative(p.psi, m);
        const Vec3 along = p.turn.transposed_times(p.psi, n), bend = p.curve.transposed_times(p.psi, m);
        const Vec3 moment = p.turn.gradient(p.psi, p.dy, n) + p.curve.gradient(p.psi, p.dpsi, m);
        for (int a = 0; a < 2; ++a) {
          const double Na = g.N[2 * a], dNa = g.dN[2 * a];
          gy[static_cast<std::size_t>(a)] += w * dNa * along;
          gpsi[static_cast<std::size_t>(a)] += w * (Na * moment + dNa * bend);
          for (int b = 0; b < 2; ++b) {
            const double Nb = g.N[2 * b], dNb = g.dN[2 * b];
            H.block<3, 3>(6 * a + 3, 6 * b + 3) += w *
                                                   (Na * Nb * turn + dNa * Nb * curve + Na * dNb * curve.transpose());
            H.block<3, 3>(6 * a, 6 * b + 3) += w * dNa * Nb * stretch;
            H.block<3, 3>(6 * a + 3, 6 * b) += w * Na * dNb * stretch.transpose();
          }
        }
      }
      const Mat12x18 HJ = H.lazyProduct(J);
      K.noalias() = J.transpose().lazyProduct(HJ);
      if (weights.stiffness != 0)
        for (int a = 0; a < 2; ++a) {
          // What the residual changes because J does; gy and gpsi carry the weight already.
          const auto i = static_cast<std::size_t>(a);
          const int at = 12 * a;
          const Mat3 f = k.R2 * skew(gy[i]);
          K.block<3, 3>(at, 9) -= f;
          K.block<3, 3>(6, 9) += f;
          K.middleRows<3>(9).noalias() += skew(gy[i]) * J.middleRows<3>(6 * a);
          const Mat3 bend = k.log_form[i].dual_derivative(k.psi[i], gpsi[i]);
          const Vec3 m = k.log_form[i].transposed_times(k.psi[i], gpsi[i]);
          const Eigen::Matrix<double, 3, 18> change = bend * J.middleRows<3>(6 * a + 3);
          K.middleRows<3>(at + 3) += change;
          K.middleRows<3>(9).noalias() -= k.relative[i] * change;
          const Mat3 turned = k.relative[i] * skew(m);
          K.block<3, 3>(9, at + 3) += turned;
          K.block<3, 3>(9, 9) -= turned * k.relative[i].transpose();
        }
    }
    if (weights.mass != 0)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) K.block<3, 3>(6 * i, 6 * j).diagonal().array() += weights.mass * e.mass(i, j);
    for (std::size_t i = 0; i < 3; ++i) {
      // A node's rotary inertia goes with the element before it, the first node's with the first.
      if (i == 0 && first > 0) continue;
      const Mat3& J = rotary_[first + i];
      const Vec3 w = s.v.segment<3>(nodes_[first + i].rotation.v);
      const auto at = static_cast<Index>(6 * i + 3);
      K.block<3, 3>(at, at) += weights.mass * J + weights.damping * (skew(w) * J - skew(J * w));
      const Vec3& S = moment_[first + i];
      if (S.isZero()) continue;
      const Mat3 R = attitude(s, first + i);
      const Vec3 turn = s.a.segment<3>(nodes_[first + i].rotation.v);
      const Vec3 lift = R.transpose() * (s.a.segment<3>(nodes_[first + i].translation.v) - options_.gravity);
      K.block<3, 3>(at - 3, at) -= R *
                                   (weights.mass * skew(S) + weights.damping * (skew(w.cross(S)) + skew(w) * skew(S)) +
                                    weights.stiffness * skew(turn.cross(S) + w.cross(w.cross(S))));
      K.block<3, 3>(at, at - 3) += weights.mass * skew(S) * R.transpose();
      K.block<3, 3>(at, at) += weights.stiffness * skew(S) * skew(lift);
    }
    sink.add(e.dofs, e.dofs, K);
  }
}

Energies Beam::energies(const State& s) const {
  Energies out;
  for (const Element& e : elements_) {
    const Kinematics k = kinematics(s, e);
    for (const Point& g : e.points) {
      const PointStrain p = point_strain(k, g);
      out.strain += 0.5 * g.weight * p.strain.dot(g.stiffness * p.strain);
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        out.kinetic += 0.5 * e.mass(static_cast<Index>(i), static_cast<Index>(j)) *
                       s.v.segment<3>(e.dofs[6 * i]).dot(s.v.segment<3>(e.dofs[6 * j]));
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vec3 w = s.v.segment<3>(nodes_[i].rotation.v);
    out.kinetic += 0.5 * w.dot(rotary_[i] * w);
    if (!moment_[i].isZero(0))
      out.kinetic += s.v.segment<3>(nodes_[i].translation.v).dot(attitude(s, i) * w.cross(moment_[i]));
  }
  out.viscous = viscous_;
  out.external = fall_;
  return out;
}

void Beam::commit(const State& s) {
  double height = 0, power = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    height += weight_[i] * options_.gravity.dot(s.q.segment<3>(nodes_[i].translation.q));
    if (!moment_[i].isZero(0)) height += options_.gravity.dot(attitude(s, i) * moment_[i]);
  }
  if (options_.damping_time > 0)
    for (const Element& e : elements_) {
      const Kinematics k = kinematics(s, e);
      const Rates rate = rates(s, e, k);
      for (const Point& g : e.points) {
        const Vec6 r = strain_rate(point_strain(k, g), g, rate);
        power += options_.damping_time * g.weight * r.dot(g.stiffness * r);
      }
    }
  if (started_) {
    viscous_ += 0.5 * (power_ + power) * (s.time - time_);
    fall_ += height - height_;
  }
  power_ = power;
  height_ = height;
  time_ = s.time;
  started_ = true;
}

void Beam::save(std::vector<double>& history) const { put(history, viscous_, power_, time_, height_, fall_, started_); }

void Beam::restore(std::span<const double>& history) {
  take(history, "the checkpoint is of another system", viscous_, power_, time_, height_, fall_, started_);
}

std::vector<Beam::Strain> Beam::strains(const State& s) const {
  std::vector<Strain> out;
  for (const Element& e : elements_) {
    const Kinematics k = kinematics(s, e);
    for (const Point& g : e.points) {
      const PointStrain p = point_strain(k, g);
      out.push_back({g.arc_length, g.frame.transpose() * p.strain.head<3>(), g.frame.transpose() * p.strain.tail<3>()});
    }
  }
  return out;
}

std::vector<Beam::Resultant> Beam::resultants(const State& s) const {
  std::vector<Resultant> out;
  for (const Element& e : elements_) {
    const Kinematics k = kinematics(s, e);
    Rates rate;
    if (options_.damping_time > 0) rate = rates(s, e, k);
    for (const Point& g : e.points) {
      const PointStrain p = point_strain(k, g);
      Vec6 strain = p.strain;
      if (options_.damping_time > 0) strain += options_.damping_time * strain_rate(p, g, rate);
      const Vec6 stress = g.stiffness * strain;
      out.push_back({g.arc_length, g.frame.transpose() * stress.head<3>(), g.frame.transpose() * stress.tail<3>()});
    }
  }
  return out;
}

double Beam::mass() const {
  double sum = 0;
  for (double w : weight_) sum += w;
  return sum;
}

}  // namespace hosel::fem
