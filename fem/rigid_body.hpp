/// A rigid body attached to a node (position and rotation), with its centre of gravity off the node.
#pragma once

#include <string>

#include "fem/term.hpp"

namespace hosel::fem {

/// Mass properties in the body frame.
struct RigidBodyProperties {
  double mass = 0;              ///< [kg]
  Mat3 inertia = Mat3::Zero();  ///< about the centre of gravity [kg m^2]
  Vec3 offset = Vec3::Zero();   ///< from the node to the centre of gravity [m]
};

/// Newton-Euler equations about the node. With c the offset, w and a the body-frame angular velocity
/// and acceleration, x the node and R the rotation (body to global):
///   translation (global)  m (x'' + R (a x c + w x (w x c))) - m g
///   rotation (body)       c x R^T m (acceleration of the cg - g) + J a + w x J w
class RigidBody final : public Term {
 public:
  /// `translation` holds the node's global position, `rotation` its attitude; the body's own frame is
  /// the node's. `gravity` is the global acceleration of free fall [m/s^2].
  RigidBody(std::string body, const DofMap::Block& translation, const DofMap::Block& rotation,
            const RigidBodyProperties& properties, const Vec3& gravity = Vec3::Zero());

  std::string body() const override { return body_; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  const RigidBodyProperties& properties() const { return properties_; }
  Vec3 position(const State& s) const;          ///< of the centre of gravity, global [m]
  Vec3 velocity(const State& s) const;          ///< of the centre of gravity, global [m/s]
  Vec3 angular_velocity(const State& s) const;  ///< global [rad/s]
  Vec3 linear_momentum(const State& s) const;   ///< global [kg m/s]
  Vec3 angular_momentum(const State& s) const;  ///< about the global origin [kg m^2/s]

 private:
  std::string body_;
  DofMap::Block translation_, rotation_;
  RigidBodyProperties properties_;
  Vec3 gravity_;
  double external_work_ = 0;
  bool has_position_ = false;
  Vec3 last_position_ = Vec3::Zero();
  std::vector<Index> dofs_;
};

}  // namespace hosel::fem
