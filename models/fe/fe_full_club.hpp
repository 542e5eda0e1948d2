/// The finite-element impact with the whole club: ball, contact, head and flexible shaft in one system.
#pragma once

#include "models/club/mounted_shaft.hpp"
#include "models/fe/fe_impact.hpp"

namespace hosel::models {

struct FeFullClubOptions {
  FeImpactOptions impact;
  ShaftMount mount;
};

/// The club and the ball at first contact; the shaft is unloaded and moves with the head as one rigid body.
struct FullClubImpact {
  fem::System system;
  BallOnFace parts;
  const fem::RigidBody* head = nullptr;
  const fem::Beam* shaft = nullptr;
  fem::Node hosel;  ///< the shaft's tip: head and shaft share this node
  fem::State initial;
  Encounter encounter;
};
/// Throws std::invalid_argument on a club without shaft or with a head of infinite mass.
FullClubImpact assemble_full_club(const Blow& blow, const FeFullClubOptions& options);

FeOutcome solve_full_club(const Blow& blow, const FeFullClubOptions& options, const ImpactObserver& observer = {},
                          const ImpactCheckpoint* from = nullptr);

/// `fe-full-club` behind the common interface.
class FeFullClub final : public FeModel {
 public:
  explicit FeFullClub(FeFullClubOptions options);
  FeOutcome solve(const Blow& blow, const ImpactObserver& observer, const ImpactCheckpoint* from) const override;

 private:
  FeFullClubOptions options_;
};

}  // namespace hosel::models
