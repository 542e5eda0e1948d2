/// The finite-element impact as a function of the blow and of changes of the declared ball and shaft.
#pragma once

#include "models/club/mounted_shaft.hpp"
#include "models/fe/fe_change.hpp"
#include "models/fe/impact.hpp"

namespace hosel::models {

/// The ball with the change in it. Longer branch times keep the storage and the loss modulus at the frequency of the
/// contact, pi over `contact_time`, so that the bounce stays and only what is slower or quicker loses otherwise.
/// Throws std::invalid_argument where no ball can have it (a cover without thickness, no stiffness left).
FeBall changed(FeBall ball, const FeChange& change, double radius, double contact_time = 0.45e-3);
/// `share` of its mass and of its bending and torsional stiffness, these times exp(stiffness); 1 and 0 give it back.
Shaft changed(Shaft shaft, double share, double stiffness);

/// The face with so much more compliance at its centre [m/N]. A rigid one takes outline, effective mass and damping of
/// the library's for such a head.
std::optional<FaceCompliance> changed(std::optional<FaceCompliance> face, double compliance, const Head& head);

class ChangeableFe {
 public:
  /// `full_club`: the shaft hangs on the head unless a change takes it away; else only a change adds it. The blow's own
  /// shaft is not looked at.
  ChangeableFe(FeImpactOptions impact, ShaftMount mount, std::optional<Shaft> shaft, bool full_club);

  const FeImpactOptions& impact() const { return impact_; }
  const std::optional<Shaft>& shaft() const { return shaft_; }
  /// Share of the shaft that hangs on the head with a change: 0 is a free head.
  double share(const FeChange& change) const { return (full_club_ ? 1 : 0) + change.shaft; }
  /// Coulomb's coefficient is the blow's where it is finite. Throws as ImpactModel::launch.
  Launch launch(const Blow& blow, const FeChange& change) const;

 private:
  FeImpactOptions impact_;
  ShaftMount mount_;
  std::optional<Shaft> shaft_;
  bool full_club_;
};

}  // namespace hosel::models
