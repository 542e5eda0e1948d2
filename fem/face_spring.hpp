/// What a yielding face weighs and what holds it in the head.
#pragma once

#include "fem/contact_surface.hpp"
#include "fem/term.hpp"
#include "golf/face_compliance.hpp"

namespace hosel::fem {

/// A particle of the face's effective mass at r = c - w e in the carrier's body frame (c: the face centre, e: its Xc,
/// w: the travel), on a spring and a damper against the carrier. The carrier's own mass holds it at r = c already, so
/// what acts here is the difference of the two. With p'' = x'' + R (a x r + w x (w x r) + 2 w x r' + r''):
///   translation (global)  m p''
///   rotation (body)       r x R^T m p''
///   travel                -e . R^T m p'' + stiffness w + damping w'
class FaceSpring final : public Term {
 public:
  /// `travel`: a block of one number. Throws std::invalid_argument on a face that cannot be.
  FaceSpring(const FaceCompliance& face, const SurfaceCarrier& carrier, const DofMap::Block& travel);

  std::string body() const override { return "face"; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  double travel(const State& s) const { return s.q[travel_.q]; }  ///< at the face centre, inwards [m]
  /// Energy in the spring and in the face's motion against a free head of so much mass (inf: one that is held) [J].
  double vibration(const State& s, double head_mass) const;

 private:
  struct Carried;
  Carried carried(const State& s) const;

  FaceCompliance face_;
  SurfaceCarrier carrier_;
  DofMap::Block travel_;
  std::vector<Index> dofs_;
  double viscous_ = 0, power_ = 0, time_ = 0;
  bool started_ = false;
};

}  // namespace hosel::fem
