/// Sliding, then rolling, in closed form along the normal impulse.
#pragma once

#include "models/impact_model.hpp"
#include "models/rigid/impulse.hpp"

namespace hosel::models {

/// How the blow went, by the normal impulse p.
struct StickSlipPath {
  Vec3 impulse;                       ///< on the ball, global frame [N s]
  double normal_impulse = 0;          ///< at the end [N s]
  double rolling_from = 0;            ///< share of the normal impulse at which sliding ends; 1: never
  double tangential_restitution = 0;  ///< the share of e_t that Coulomb's limit let through
  double lost_normal = 0;             ///< work of the normal force [J]
  double lost_friction = 0;           ///< work of friction while sliding [J]
  double lost_tangential = 0;         ///< work of the tangential impulse while sticking and given back [J]
};

/// Routh's construction. While the ball slides, dJ = (n + mu d) dp with the constant direction d in
/// which the slip shrinks along itself to zero (for a tangentially isotropic mobility d is the slip's
/// own direction); from there it sticks, dJ = (n - K_tt^-1 K_tn) dp. The normal impulse that closes the
/// approach is p_c; the blow ends at (1 + e) p_c (Poisson). With tangential restitution e_t the
/// tangential impulse K_tt^-1 slip, spent in stopping the slip, comes back e_t times at the end, up to
/// Coulomb's limit |J_t| <= mu p. Uses contact.restitution, restitution_slope, restitution_falloff,
/// tangential_restitution and friction.
/// Routh (1905), Dynamics of a System of Rigid Bodies, art. 182ff; Stronge (2000), Impact Mechanics, ch. 4.
StickSlipPath stick_slip_path(const Blow& blow, const ImpulseProblem& problem);

class StickSlip final : public ImpactModel {
 public:
  Launch launch(const Blow& blow) const override;
};

}  // namespace hosel::models
