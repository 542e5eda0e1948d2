#include "models/rigid/pendulum_club.hpp"

#include "models/rigid/jointed_club.hpp"
#include "models/rigid/stick_slip.hpp"

namespace hosel::models {

Mat6 pendulum_mobility(const Blow& blow) { return jointed_mobility(blow, false); }

Launch PendulumClub::launch(const Blow& blow) const {
  const ImpulseProblem p = impulse_problem(blow, pendulum_mobility(blow));
  return launch_after(blow, p, stick_slip_path(blow, p).impulse);
}

}  // namespace hosel::models
