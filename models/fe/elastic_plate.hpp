/// Impact of a sphere on an elastic plate, from a finite-element sphere on a rigid plate.
#pragma once

#include "models/fe/impact.hpp"

namespace hosel::models {

struct ElasticSolid {
  double young = 0;    ///< [Pa]
  double poisson = 0;  ///< [-]
};

/// What a patch small against both bodies knows of them. [@contact-mechanics]
struct ContactPair {
  double modulus = 0;     ///< E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 [Pa]
  double tangential = 0;  ///< kappa, tangential over normal stiffness of a patch that sticks [-]
  double dundurs = 0;     ///< |beta|, how far normal pressure shears: 0 for like bodies [-]
  static ContactPair of(const ElasticSolid& sphere, const ElasticSolid& plate);
};

/// One elastic sphere on a rigid plate that contacts as the pair does. E* and beta fix its constants; its kappa is then
/// not the pair's. The patch's motion depends on kappa / m_t alone, m_t = m / (1 + 1/i) with I = i m r^2, once friction
/// is scaled like kappa: a sphere of another inertia has the same slip, and so the same e_t. The sign of beta does not
/// matter: reversing all shear of a pair gives the other one's, and the blow's mirror image is the same blow. Exact for
/// half spaces (kappa's small dependence on the direction left out).
struct RigidPlateStandIn {
  ElasticSolid sphere;
  double inertia_factor = 0.4;  ///< i
  double friction = 1;          ///< its coefficient over the pair's
  static RigidPlateStandIn of(const ContactPair& pair, double inertia_factor);
};

/// The finite-element sphere as that stand-in; spin and speed are the true sphere's, by momentum from its e_t.
class ElasticPlate final : public ImpactModel {
 public:
  /// `sphere`: its ball is one elastic layer, the sphere's own; friction is the pair's. Throws std::invalid_argument
  /// where it is not, or where no stand-in exists: like bodies would need an incompressible one.
  ElasticPlate(FeImpactOptions sphere, const ElasticSolid& plate, const Ball& ball);
  /// Of a blow by a wall, the ball at rest and without spin. Throws what the finite-element model throws.
  Launch launch(const Blow& blow) const override { return run(blow).launch; }
  /// The same with what the stand-in was solved to.
  FeOutcome run(const Blow& blow) const;

 private:
  FeImpactOptions stand_in_;
  double friction_ = 1;  // of the stand-in, over the pair's
};

}  // namespace hosel::models
