#include "hosel/models/hinged_head.hpp"

#include "hosel/models/jointed_club.hpp"
#include "hosel/models/stick_slip.hpp"

namespace hosel::models {

Mat6 hinged_mobility(const Blow& blow) { return jointed_mobility(blow, true); }

Launch HingedHead::launch(const Blow& blow) const {
  const ImpulseProblem p = impulse_problem(blow, hinged_mobility(blow));
  return launch_after(blow, p, stick_slip_path(blow, p).impulse);
}

}  // namespace hosel::models
