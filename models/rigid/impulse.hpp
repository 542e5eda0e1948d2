/// An impact as an impulse at one contact point, in the configuration of first contact: what the
/// models without finite motion (stick-slip, hertz-maw, pendulum-club, hinged-head) have in common.
#pragma once

#include "golf/first_contact.hpp"
#include "golf/launch.hpp"
#include "models/reduced/shaft_impedance.hpp"

namespace hosel::models {

/// Change of the head's twist (velocity of its cg, angular velocity; global axes) by a wrench impulse
/// (force, moment about the cg): symmetric, positive.
Mat6 free_head_mobility(const Blow& blow, const FirstContact& contact);

struct ImpulseProblem {
  FirstContact contact;
  Mat3 mobility;  ///< change of -approach by an impulse on the ball [1/kg]
  Mat6 head_mobility;
};

/// Throws std::invalid_argument where the head moves away from the ball.
ImpulseProblem impulse_problem(const Blow& blow);
ImpulseProblem impulse_problem(const Blow& blow, const Mat6& head_mobility);

/// Both bodies after the impulse J on the ball (and -J on the head).
Launch launch_after(const Blow& blow, const ImpulseProblem& p, const Vec3& J);

}  // namespace hosel::models
