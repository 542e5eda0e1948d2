#include "models/club/swing_end.hpp"

#include <cmath>

namespace hosel::models {

SwingEnd swing_end(const Club& club, const SwingOptions& options, const fem::Motion& motion, double begin, double end,
                   std::optional<double> lie) {
  Swing swing(club, options, {.motion = motion});
  SwingSample before, last;
  const fem::State state = swing.run(swing.start(begin, swing.equilibrium(begin)), end, [&](const SwingSample& s) {
    before = last;
    last = s;
  });
  SwingEnd out{.club = club, .lie = lie.value_or(dynamic_lie(last.head)), .lead = last.lead, .droop = last.droop};
  out.club = turned_about_normal(club, out.lie);
  // The same club in other words: the grip's axes are the same, and so is the state.
  const Swing turned(out.club, options, {.motion = motion});
  out.delivery = delivery_of(turned.sample(state, fem::Vector::Zero(turned.system().dof_map.size())).head);
  out.shaft = loaded_by_swing(turned, state, before, last);
  out.hands = {.force = last.grip.rotation.conjugate() * last.force, .moment = last.moment, .gravity = options.gravity};
  return out;
}

void turn_place(double lie, Delivery& d) {
  const double toe = d.impact_toe, high = d.impact_high;
  d.impact_toe = std::cos(lie) * toe - std::sin(lie) * high;
  d.impact_high = std::sin(lie) * toe + std::cos(lie) * high;
}

}  // namespace hosel::models
