#include "fem/face_spring.hpp"

#include <stdexcept>
#include <utility>

namespace hosel::fem {
namespace {

const Vec3 kOut = Vec3::UnitX();

/// Derivative of w x (w x v) by w.
Mat3 centripetal(const Vec3& w, const Vec3& v) { return -skew(w.cross(v)) - skew(w) * skew(v); }

}  // namespace

/// The carrier at a state, in its body frame.
struct FaceSpring::Carried {
  Mat3 R;
  Vec3 velocity, acceleration;  // of the node, R^T x', R^T x''
  Vec3 spin, spin_rate;

  Vec3 turned(const Vec3& v) const { return spin_rate.cross(v) + spin.cross(spin.cross(v)); }
};

struct FaceSpring::Moments {
  double first = 0;         // of f
  Vec3 arm = Vec3::Zero();  // of r f
};

FaceSpring::FaceSpring(ReducedFace face, const SurfaceCarrier& carrier, const DofMap::Block& unknowns)
    : face_(std::move(face)), carrier_(carrier), unknowns_(unknowns) {
  if (unknowns.rotation || unknowns.size != face_.size())
    throw std::invalid_argument("face: as many unknowns as the face has are needed");
  moment_ = face_.moment + carrier.centre * face_.mass.transpose();
  if (carrier_.translation)
    for (const auto* block : {&*carrier_.translation, &*carrier_.rotation})
      for (Index i = 0; i < 3; ++i) dofs_.push_back(block->v + i);
  for (Index i = 0; i < unknowns_.size; ++i) dofs_.push_back(unknowns_.v + i);
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

FaceSpring::Moments FaceSpring::moments(const Vector& values) const {
  return {face_.mass.dot(values), moment_ * values};
}

double FaceSpring::travel(const State& s) const { return face_.centre.dot(unknowns(s)); }

void FaceSpring::pattern(std::vector<std::vector<Index>>& blocks) const { blocks.push_back(dofs_); }

void FaceSpring::residual(const State& s, Vector& inertia, Vector& force) const {
  const Carried c = carried(s);
  const Index n = unknowns_.size;
  const Vector w = unknowns(s), rate = s.v.segment(unknowns_.v, n), second = s.a.segment(unknowns_.v, n);
  force.segment(unknowns_.v, n) += face_.stiffness * w + face_.damping * rate;
  inertia.segment(unknowns_.v, n) += face_.inertia * second;
  if (!carrier_.translation) return;
  const Moments f = moments(w), f1 = moments(rate), f2 = moments(second);
  const Vector still = face_.transverse * w;
  const double square = w.dot(still), mixed = rate.dot(still);
  const Vec3 out = c.turned(kOut), across = 2 * c.spin.cross(kOut);
  const Vec3 push = -(out * f.first + across * f1.first + kOut * f2.first);
  const Vec3 turn = -kOut.cross(c.acceleration * f.first + c.turned(f.arm)) - f.arm.cross(out) - f1.arm.cross(across) -
                    f2.arm.cross(kOut) + kOut.cross(out * square + across * mixed);
  inertia.segment<3>(carrier_.translation->v) += c.R * push;
  inertia.segment<3>(carrier_.rotation->v) += turn;
  Vector own = -kOut.dot(c.acceleration) * face_.mass + kOut.dot(out) * still;
  for (Index j = 0; j < n; ++j) own[j] -= kOut.dot(c.turned(moment_.col(j)));
  inertia.segment(unknowns_.v, n) += own;
}

void FaceSpring::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  const bool moving = carrier_.translation.has_value();
  const Index n = unknowns_.size, at = moving ? 6 : 0;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(at + n, at + n);
  k.bottomRightCorner(n, n) = weights.stiffness * face_.stiffness + weights.damping * face_.damping +
                              weights.mass * face_.inertia;
  if (!moving) {
    sink.add(dofs_, dofs_, k);
    return;
  }
  const Carried c = carried(s);
  const Vector w = unknowns(s), rate = s.v.segment(unknowns_.v, n), second = s.a.segment(unknowns_.v, n);
  const Moments f = moments(w), f1 = moments(rate), f2 = moments(second);
  const Vector still = face_.transverse * w, going = face_.transverse * rate;
  const double square = w.dot(still), mixed = rate.dot(still);
  const Vec3 out = c.turned(kOut), across = 2 * c.spin.cross(kOut);
  const Mat3 Rt = c.R.transpose(), E = skew(kOut), Ew = centripetal(c.spin, kOut), A = skew(c.acceleration);
  const Vec3 push = -(out * f.first + across * f1.first + kOut * f2.first);

  auto by_x = k.leftCols<3>();
  auto by_turn = k.middleCols<3>(3);
  // By the node's acceleration R^T x'', which turns with the body.
  by_x.middleRows<3>(3) = -weights.mass * f.first * E * Rt;
  by_turn.middleRows<3>(3) = -weights.stiffness * f.first * E * A;
  by_x.bottomRows(n) = -weights.mass * face_.mass * (kOut.transpose() * Rt);
  by_turn.bottomRows(n) = -weights.stiffness * face_.mass * (kOut.transpose() * A);
  // By spin and its rate.
  by_turn.topRows<3>() = c.R * (weights.mass * f.first * E + weights.damping * (2 * f1.first * E - f.first * Ew) -
                                weights.stiffness * skew(push));
  by_turn.middleRows<3>(3) += weights.mass * (E * skew(f.arm) + skew(f.arm) * E - square * E * E) +
                              weights.damping * (-E * centripetal(c.spin, f.arm) - skew(f.arm) * Ew +
                                                 2 * skew(f1.arm) * E + square * E * Ew - 2 * mixed * E * E);
  const Vec3 outwards = 2 * (c.spin.x() * kOut - c.spin);  // derivative of e . w x (w x e)
  for (Index j = 0; j < n; ++j) {
    const Vec3 arm = moment_.col(j);
    const double m = face_.mass[j];
    by_turn.row(at + j) += -weights.mass * arm.cross(kOut).transpose() -
                           weights.damping *
                               (kOut.transpose() * centripetal(c.spin, arm) - still[j] * outwards.transpose());
    auto column = k.col(at + j);
    column.head<3>() = -m * (c.R * (weights.stiffness * out + weights.damping * across + weights.mass * kOut));
    column.segment<3>(3) = weights.stiffness * (-kOut.cross(c.acceleration * m + c.turned(arm)) - arm.cross(out) +
                                                kOut.cross(2 * still[j] * out + going[j] * across)) +
                           weights.damping * (-arm.cross(across) + still[j] * kOut.cross(across)) -
                           weights.mass * arm.cross(kOut);
  }
  k.bottomRightCorner(n, n) += weights.stiffness * kOut.dot(out) * face_.transverse;
  sink.add(dofs_, dofs_, k);
}

Energies FaceSpring::energies(const State& s) const {
  const Vector w = unknowns(s), rate = s.v.segment(unknowns_.v, unknowns_.size);
  Energies e;
  e.kinetic = 0.5 * rate.dot(face_.inertia * rate);
  e.strain = 0.5 * w.dot(face_.stiffness * w);
  e.viscous = viscous_;
  if (!carrier_.translation) return e;
  const Carried c = carried(s);
  const Moments f = moments(w), f1 = moments(rate);
  const Vec3 across = c.spin.cross(kOut);
  e.kinetic += 0.5 * across.squaredNorm() * w.dot(face_.transverse * w) -
               c.velocity.dot(across * f.first + kOut * f1.first) - c.spin.cross(f.arm).dot(across) -
               c.spin.cross(f1.arm).dot(kOut);
  return e;
}

void FaceSpring::commit(const State& s) {
  const Vector rate = s.v.segment(unknowns_.v, unknowns_.size);
  const double power = rate.dot(face_.damping * rate);
  if (started_) viscous_ += 0.5 * (power_ + power) * (s.time - time_);
  power_ = power;
  time_ = s.time;
  started_ = true;
}

void FaceSpring::save(std::vector<double>& h) const { put(h, viscous_, power_, time_, started_); }

void FaceSpring::restore(std::span<const double>& h) {
  take(h, "face: the history is too short", viscous_, power_, time_, started_);
}

double FaceSpring::vibration(const State& s, double head_mass) const {
  const Vector w = unknowns(s), rate = s.v.segment(unknowns_.v, unknowns_.size);
  const double momentum = face_.mass.dot(rate);
  return 0.5 * rate.dot(face_.inertia * rate) - 0.5 * momentum * momentum / head_mass +
         0.5 * w.dot(face_.stiffness * w);
}

}  // namespace hosel::fem
