#include "fem/rigid_body.hpp"

#include <utility>

namespace hosel::fem {

RigidBody::RigidBody(std::string body, const DofMap::Block& translation, const DofMap::Block& rotation,
                     const RigidBodyProperties& properties, const Vec3& gravity)
    : body_(std::move(body)),
      translation_(translation),
      rotation_(rotation),
      properties_(properties),
      gravity_(gravity) {
  for (Index i = 0; i < 3; ++i) dofs_.push_back(translation_.v + i);
  for (Index i = 0; i < 3; ++i) dofs_.push_back(rotation_.v + i);
}

void RigidBody::pattern(std::vector<std::vector<Index>>& blocks) const { blocks.push_back(dofs_); }

void RigidBody::residual(const State& s, Vector& inertia, Vector& force) const {
  const Mat3 R = rotation(s, rotation_).toRotationMatrix();
  const Vec3 w = s.v.segment<3>(rotation_.v), alpha = s.a.segment<3>(rotation_.v);
  const Vec3& c = properties_.offset;
  const Mat3& J = properties_.inertia;
  const double m = properties_.mass;
  const Vec3 cg = s.a.segment<3>(translation_.v) + R * (alpha.cross(c) + w.cross(w.cross(c)));
  inertia.segment<3>(translation_.v) += m * cg;
  inertia.segment<3>(rotation_.v) += m * c.cross(R.transpose() * cg) + J * alpha + w.cross(J * w);
  force.segment<3>(translation_.v) -= m * gravity_;
  force.segment<3>(rotation_.v) -= m * c.cross(R.transpose() * gravity_);
}

void RigidBody::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  const Mat3 R = rotation(s, rotation_).toRotationMatrix();
  const Vec3 w = s.v.segment<3>(rotation_.v), alpha = s.a.segment<3>(rotation_.v);
  const Vec3& c = properties_.offset;
  const Mat3& J = properties_.inertia;
  const double m = properties_.mass;
  const Mat3 cx = skew(c), wx = skew(w);
  const Vec3 offset_acceleration = alpha.cross(c) + w.cross(w.cross(c));
  const Vec3 node = R.transpose() * (s.a.segment<3>(translation_.v) - gravity_);
  const Mat3 centripetal = -skew(w.cross(c)) - wx * cx;  // d(w x (w x c)) / dw

  Eigen::Matrix<double, 6, 6> k;
  k.topLeftCorner<3, 3>() = weights.mass * m * Mat3::Identity();
  k.bottomLeftCorner<3, 3>() = weights.mass * m * cx * R.transpose();
  k.topRightCorner<3, 3>() =
      m * R * (-weights.mass * cx + weights.damping * centripetal - weights.stiffness * skew(offset_acceleration));
  k.bottomRightCorner<3, 3>() = weights.mass * (J - m * cx * cx) +
                                weights.damping * (m * cx * centripetal + wx * J - skew(J * w)) +
                                weights.stiffness * m * cx * skew(node);
  sink.add(dofs_, dofs_, k);
}

Energies RigidBody::energies(const State& s) const {
  const Vec3 w = s.v.segment<3>(rotation_.v);
  Energies e;
  e.kinetic = 0.5 * properties_.mass * velocity(s).squaredNorm() + 0.5 * w.dot(properties_.inertia * w);
  e.external = external_work_;
  return e;
}

void RigidBody::commit(const State& s) {
  const Vec3 now = position(s);
  // The first accepted state is the start: no work has been done yet.
  if (has_position_) external_work_ += properties_.mass * gravity_.dot(now - last_position_);
  last_position_ = now;
  has_position_ = true;
}

void RigidBody::save(std::vector<double>& h) const { put(h, external_work_, last_position_, has_position_); }

void RigidBody::restore(std::span<const double>& h) {
  take(h, "rigid body: the history is too short", external_work_, last_position_, has_position_);
}

Vec3 RigidBody::position(const State& s) const {
  return s.q.segment<3>(translation_.q) + rotation(s, rotation_) * properties_.offset;
}

Vec3 RigidBody::velocity(const State& s) const {
  const Vec3 w = s.v.segment<3>(rotation_.v);
  return s.v.segment<3>(translation_.v) + rotation(s, rotation_) * w.cross(properties_.offset);
}

Vec3 RigidBody::angular_velocity(const State& s) const {
  return rotation(s, rotation_) * Vec3(s.v.segment<3>(rotation_.v));
}

Vec3 RigidBody::linear_momentum(const State& s) const { return properties_.mass * velocity(s); }

Vec3 RigidBody::angular_momentum(const State& s) const {
  const Vec3 w = s.v.segment<3>(rotation_.v);
  return position(s).cross(linear_momentum(s)) + rotation(s, rotation_) * Vec3(properties_.inertia * w);
}

}  // namespace hosel::fem
