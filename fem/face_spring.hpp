/// Inertia, stiffness and damping of a yielding face relative to the head.
#pragma once

#include "fem/contact_surface.hpp"
#include "fem/reduced_face.hpp"
#include "fem/term.hpp"

namespace hosel::fem {

/// Particles dm of the face at p = r - f e in the carrier's body frame (e: the face's Xc, f = sum w_j shape_j) on
/// springs and dampers against the carrier. The carrier's own mass holds them at r already, so what acts here is the
/// difference of the two. With p'' = x'' + R (a x p + w x (w x p) + 2 w x p' + p'') under the integral over dm:
///   translation (global)  p''
///   rotation (body)       p x R^T p''
///   unknown j             -shape_j e . R^T p'' + (stiffness w + damping w')_j
/// Of the face's rotary and in-plane motion, ReducedFace::inertia less transverse, the carrier feels nothing.
class FaceSpring final : public Term {
 public:
  /// `unknowns`: a block of as many numbers as the face has. Throws std::invalid_argument where it is not.
  FaceSpring(ReducedFace face, const SurfaceCarrier& carrier, const DofMap::Block& unknowns);

  std::string body() const override { return "face"; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  double travel(const State& s) const;  ///< at the face centre, inwards [m]
  Vector unknowns(const State& s) const { return s.q.segment(unknowns_.q, unknowns_.size); }
  /// Energy in the springs and in the face's motion against a free head of so much mass, which it does not turn (inf:
  /// one that is held) [J].
  double vibration(const State& s, double head_mass) const;

 private:
  struct Carried;
  Carried carried(const State& s) const;
  struct Moments;  // of the face's mass, about the carrier's node
  Moments moments(const Vector& values) const;

  ReducedFace face_;
  SurfaceCarrier carrier_;
  DofMap::Block unknowns_;
  Eigen::Matrix3Xd moment_;  // about the carrier's node
  std::vector<Index> dofs_;
  double viscous_ = 0, power_ = 0, time_ = 0;
  bool started_ = false;
};

}  // namespace hosel::fem
