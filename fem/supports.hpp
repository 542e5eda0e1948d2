/// Supports and loads of a single node: clamps, imposed motions, wrenches, springs and dampers.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "fem/beam.hpp"

namespace hosel::fem {

/// Position and attitude of a frame with its first two derivatives.
struct Pose {
  Vec3 position = Vec3::Zero();                                  ///< global [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< from the reference placement
  Vec3 velocity = Vec3::Zero(), acceleration = Vec3::Zero();     ///< global [m/s], [m/s^2]
  Vec3 angular_velocity = Vec3::Zero();                          ///< body frame [rad/s]
  Vec3 angular_acceleration = Vec3::Zero();                      ///< body frame [rad/s^2]
};
using Motion = std::function<Pose(double time)>;

/// A pose held still.
Motion at_rest(const Vec3& position, const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity());

/// A node that follows a motion; the residual on its equations is what drives it.
class ImposedMotion final : public Prescribed {
 public:
  ImposedMotion(const Node& node, Motion motion);
  const std::vector<Index>& dofs() const override { return dofs_; }
  void impose(State& state) const override;

 private:
  Node node_;
  Motion motion_;
  std::vector<Index> dofs_;
};

/// Force (global) and moment at a node.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< global [N]
  Vec3 moment = Vec3::Zero();  ///< [N m]
};

/// A wrench given over time, whose moment is dead (global axes) or follows the node (body frame).
class NodeLoad final : public Term {
 public:
  enum class Moment { global, body };
  NodeLoad(std::string body, const Node& node, std::function<Wrench(double)> wrench, Moment moment = Moment::global);

  std::string body() const override { return body_; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

 private:
  Vec3 body_moment(const State& s, const Wrench& w) const;

  std::string body_;
  Node node_;
  std::function<Wrench(double)> wrench_;
  Moment kind_;
  std::vector<Index> dofs_;
  double work_ = 0;
  bool started_ = false;
  Vec3 position_ = Vec3::Zero(), force_ = Vec3::Zero(), moment_ = Vec3::Zero();
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
};

/// Springs and dampers of a joint, along and about the axes of its frame.
struct JointStiffness {
  Vec3 translation = Vec3::Zero();          ///< [N/m]
  Vec3 rotation = Vec3::Zero();             ///< [N m/rad]
  Vec3 translation_damping = Vec3::Zero();  ///< [N s/m]
  Vec3 rotation_damping = Vec3::Zero();     ///< [N m s/rad]
  Mat3 frame = Mat3::Identity();            ///< columns: the axes, in the reference placement
};

/// Two nodes that coincide in the reference placement, tied by springs and dampers in the first node's
/// frame; or one node tied to a given motion (the hands). With d the second's position from the first, in
/// the first's axes, and r the rotation vector of the second from the first:
///   energy = (d' Kt d + r' Kr r) / 2.
class SpringJoint final : public Term {
 public:
  SpringJoint(std::string body, const Node& first, const Node& second, const JointStiffness& stiffness);
  SpringJoint(std::string body, Motion first, const Node& second, const JointStiffness& stiffness);

  std::string body() const override { return body_; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

 private:
  struct Strain;
  Strain strain(const State& s) const;
  Pose first(const State& s) const;

  std::string body_;
  std::optional<Node> first_;
  Motion motion_;
  Node second_;
  Mat3 Kt_, Kr_, Ct_, Cr_;
  std::vector<Index> dofs_;
  double viscous_ = 0, work_ = 0, power_ = 0, drive_ = 0, time_ = 0;
  bool started_ = false;
};

}  // namespace hosel::fem
