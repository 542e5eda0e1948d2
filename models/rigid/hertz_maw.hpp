/// An elastic ball with a contact patch that sticks and slips piecewise: Hertz, Cattaneo-Mindlin, Maw.
#pragma once

#include <functional>

#include "models/impact_model.hpp"
#include "models/rigid/impulse.hpp"

namespace hosel::models {

/// Material of the ball; the face is rigid.
struct HertzMawLaw {
  double modulus = 85e6;    ///< Young's modulus [Pa]
  double poisson = 0.49;    ///< [-]
  double friction = 0.4;    ///< mu [-]
  double damping = 6.4e-3;  ///< normal force times (1 + d v_n) [s/m]; 0: elastic
};

struct HertzMawOptions {
  int springs = 24;  ///< across half the patch
  int steps = 64;    ///< per contact of Hertz's duration
};

struct HertzMawResult {
  Launch launch;
  Vec3 impulse = Vec3::Zero();                ///< on the ball, global frame [N s]
  double stored = 0;                          ///< left in the springs at separation [J]; they carry no force there
  double lost_normal = 0, lost_friction = 0;  ///< [J]
  double gap = 0;                             ///< what the energy balance misses, relative to the kinetic energy before
};

/// One instant, for histories: forces on the ball.
struct HertzMawSample {
  double time, depth, normal_force;
  Vec3 tangential_force;  ///< global frame [N]
};

/// Normal F = 4/3 E* sqrt(R) depth^1.5 (1 + d v_n), 1/R = 1/r + (1/bulge + 1/roll)/2. Tangential: the
/// patch as a row of springs (method of dimensionality reduction), g(x) = x^2 / R, each of stiffness
/// G* dx with G* / E* = 2 (1 - nu) / (2 - nu) and its own Coulomb limit; equals Cattaneo-Mindlin and,
/// in time, Maw, Barber and Fawcett (1976), Wear 38:101. Popov and Hess (2015), Method of
/// Dimensionality Reduction, ch. 3 and 5. Isotropic in the tangent plane.
/// The bodies keep the configuration of first contact; time stepping by a discrete gradient (Gonzalez
/// 1996), so that the energy balance closes to round-off.
/// Of blow.contact nothing is used.
HertzMawResult hertz_maw_impact(const Blow& blow, const HertzMawLaw& law, const HertzMawOptions& options = {},
                                const std::function<void(const HertzMawSample&)>& watch = {});
/// The same on a given problem (another club behind the contact).
HertzMawResult hertz_maw_impact(const Blow& blow, const ImpulseProblem& problem, const HertzMawLaw& law,
                                const HertzMawOptions& options = {},
                                const std::function<void(const HertzMawSample&)>& watch = {});

class HertzMaw final : public ImpactModel {
 public:
  explicit HertzMaw(HertzMawLaw law = {}, HertzMawOptions options = {}) : law_(law), options_(options) {}
  Launch launch(const Blow& blow) const override { return hertz_maw_impact(blow, law_, options_).launch; }

 private:
  HertzMawLaw law_;
  HertzMawOptions options_;
};

}  // namespace hosel::models
