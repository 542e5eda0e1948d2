/// Damping of a club mode by mode, independent of its rigid motion.
#pragma once

#include <string>
#include <vector>

#include "fem/beam.hpp"

namespace hosel::fem {

/// Against the first node's frame, node i moves with
///   u_i' = R_0^T (v_i - v_0 - w_0 x (x_i - x_0)),   turn_i' = R_0^T R_i W_i - W_0   (W: body frame),
/// which a rigid motion leaves at zero. With the modes phi_k (phi' M phi = 1) of the body held at the first
/// node, eta_k = phi_k' M (u', turn') is the speed of mode k; the damping force is that of the dissipation
/// sum zeta_k omega_k eta_k^2, and has neither force nor moment on the whole.
/// The tangent leaves it out: dense, and small by zeta omega h in a step h.
class ModalDamping final : public Term {
 public:
  /// `weights`: M phi, six rows (translation, rotation) per node, a column per mode; `rates`: 2 zeta omega [1/s].
  ModalDamping(std::string body, const Node& first, std::vector<Node> nodes, Eigen::MatrixXd weights, Vector rates);

  std::string body() const override { return body_; }
  void pattern(std::vector<std::vector<Index>>&) const override {}
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State&, const Weights&, TangentSink&) const override {}
  Energies energies(const State&) const override { return {.viscous = viscous_}; }
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  Vector speeds(const State& s) const;  ///< eta, a number per mode

 private:
  std::string body_;
  Node first_;
  std::vector<Node> nodes_;
  Eigen::MatrixXd weights_;
  Vector rates_;
  double viscous_ = 0, power_ = 0, time_ = 0;
  bool started_ = false;
};

}  // namespace hosel::fem
