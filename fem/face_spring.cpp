#include "fem/face_spring.hpp"

#include <stdexcept>
#include <utility>

namespace hosel::fem {
namespace {

const Vec3 kOut = Vec3::UnitX();

/// A particle seen from the carrier, in its body frame.
struct Particle {
  Vec3 arm, rate, second;  // from the node, and its derivatives there
};

}  // namespace

/// The carrier at a state, in its body frame.
struct FaceSpring::Carried {
  Mat3 R;
  Vec3 velocity, acceleration;  // of the node, R^T x', R^T x''
  Vec3 spin, spin_rate;

  Vec3 velocity_of(const Particle& p) const { return velocity + spin.cross(p.arm) + p.rate; }
  Vec3 acceleration_of(const Particle& p) const {
    return acceleration + spin_rate.cross(p.arm) + spin.cross(spin.cross(p.arm)) + 2 * spin.cross(p.rate) + p.second;
  }
};

FaceSpring::FaceSpring(const FaceCompliance& face, const SurfaceCarrier& carrier, const DofMap::Block& travel)
    : face_(face), carrier_(carrier), travel_(travel) {
  if (const auto faults = face.faults(); !faults.empty()) throw std::invalid_argument(faults.front());
  if (carrier_.translation)
    for (const auto* block : {&*carrier_.translation, &*carrier_.rotation})
      for (Index i = 0; i < 3; ++i) dofs_.push_back(block->v + i);
  dofs_.push_back(travel_.v);
}

FaceSpring::Carried FaceSpring::carried(const State& s) const {
  Carried c{carrier_.attitude, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  if (!carrier_.translation) return c;
  c.R = rotation(s, *carrier_.rotation).toRotationMatrix();
  c.velocity = c.R.transpose() * s.v.segment<3>(carrier_.translation->v);
  c.acceleration = c.R.transpose() * s.a.segment<3>(carrier_.translation->v);
  c.spin = s.v.segment<3>(carrier_.rotation->v);
  c.spin_rate = s.a.segment<3>(carrier_.rotation->v);
  return c;
}

void FaceSpring::pattern(std::vector<std::vector<Index>>& blocks) const { blocks.push_back(dofs_); }

void FaceSpring::residual(const State& s, Vector& inertia, Vector& force) const {
  const Carried c = carried(s);
  const double w = s.q[travel_.q], w_rate = s.v[travel_.v], w_second = s.a[travel_.v];
  const Particle moved{carrier_.centre - w * kOut, -w_rate * kOut, -w_second * kOut},
      rigid{carrier_.centre, Vec3::Zero(), Vec3::Zero()};
  const Vec3 f = face_.mass * c.acceleration_of(moved), f0 = face_.mass * c.acceleration_of(rigid);
  inertia[travel_.v] -= f.dot(kOut);
  force[travel_.v] += face_.stiffness * w + face_.damping * w_rate;
  if (!carrier_.translation) return;
  inertia.segment<3>(carrier_.translation->v) += c.R * (f - f0);
  inertia.segment<3>(carrier_.rotation->v) += moved.arm.cross(f) - rigid.arm.cross(f0);
}

void FaceSpring::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  const Carried c = carried(s);
  const double w = s.q[travel_.q], w_rate = s.v[travel_.v], w_second = s.a[travel_.v], m = face_.mass;
  const bool moving = carrier_.translation.has_value();
  const Index n = moving ? 7 : 1, last = n - 1;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  k(last, last) = weights.stiffness * face_.stiffness + weights.damping * face_.damping;
  if (!moving) {
    k(0, 0) += weights.mass * m;
    sink.add(dofs_, dofs_, k);
    return;
  }
  const Mat3 Rt = c.R.transpose(), spin = skew(c.spin);
  using Rows = Eigen::Matrix<double, 3, 7>;
  const auto add = [&](double sign, const Particle& p, bool travels) {
    // How the particle moves with the unknowns (translation, rotation, travel), and how its acceleration does.
    Rows motion;
    motion << Rt, -skew(p.arm), travels ? Vec3(-kOut) : Vec3::Zero();
    Rows acceleration = weights.mass * motion;
    acceleration.middleCols<3>(3) += weights.damping *
                                         (-skew(c.spin.cross(p.arm)) - spin * skew(p.arm) - 2 * skew(p.rate)) +
                                     weights.stiffness * skew(c.acceleration);
    if (travels)
      acceleration.col(6) -= weights.damping * 2 * spin * kOut +
                             weights.stiffness * (c.spin_rate.cross(kOut) + c.spin.cross(c.spin.cross(kOut)));
    const Vec3 f = m * c.acceleration_of(p);
    k += sign * m * motion.transpose() * acceleration;
    k.block<3, 3>(0, 3) -= sign * weights.stiffness * c.R * skew(f);
    if (travels) k.block<3, 1>(3, 6) -= sign * weights.stiffness * kOut.cross(f);
  };
  add(1, {carrier_.centre - w * kOut, -w_rate * kOut, -w_second * kOut}, true);
  add(-1, {carrier_.centre, Vec3::Zero(), Vec3::Zero()}, false);
  sink.add(dofs_, dofs_, k);
}

Energies FaceSpring::energies(const State& s) const {
  const Carried c = carried(s);
  const double w = s.q[travel_.q], w_rate = s.v[travel_.v];
  const Vec3 moved = c.velocity_of({carrier_.centre - w * kOut, -w_rate * kOut, Vec3::Zero()}),
             rigid = c.velocity_of({carrier_.centre, Vec3::Zero(), Vec3::Zero()});
  Energies e;
  e.kinetic = 0.5 * face_.mass * (moved.squaredNorm() - rigid.squaredNorm());
  e.strain = 0.5 * face_.stiffness * w * w;
  e.viscous = viscous_;
  return e;
}

void FaceSpring::commit(const State& s) {
  const double rate = s.v[travel_.v], power = face_.damping * rate * rate;
  if (started_) viscous_ += 0.5 * (power_ + power) * (s.time - time_);
  power_ = power;
  time_ = s.time;
  started_ = true;
}

void FaceSpring::save(std::vector<double>& h) const {
  h.insert(h.end(), {viscous_, power_, time_, started_ ? 1.0 : 0.0});
}

void FaceSpring::restore(std::span<const double>& h) {
  if (h.size() < 4) throw std::invalid_argument("face: the history is too short");
  viscous_ = h[0];
  power_ = h[1];
  time_ = h[2];
  started_ = h[3] != 0;
  h = h.subspan(4);
}

double FaceSpring::vibration(const State& s, double head_mass) const {
  const double w = s.q[travel_.q], rate = s.v[travel_.v];
  return 0.5 * face_.mass * (1 - face_.mass / head_mass) * rate * rate + 0.5 * face_.stiffness * w * w;
}

}  // namespace hosel::fem
