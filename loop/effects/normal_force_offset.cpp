// The resultant normal force does not pass through the ball's centre (the patch wanders while it slides).
#include "golf/first_contact.hpp"
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> normal_force_offset(const Setting& setting) {
  if (setting.deformable) return {};  // what its ball does by itself
  // Usual: assumed, a patch that wanders by 1 mm; by as much at 27 deg.
  const Parameter offset = Parameter{"offset", "1", 1, -0.2, 0.2, 0.01}.within(0.05),
                  share = Parameter{"offset_per_slip", "1", 1, -0.4, 0.4, 0.02}.within(0.1);
  // The couple of the normal impulse alone: friction has stopped acting when it comes, and spin is added to rolling.
  Parametrisation couple{
      .what = "offset over the ball's radius, its couple added to rolling", .parameters = {offset}, .complexity = 3};
  couple.after = [](Sizes p, const Shot& t, Launch& launch) {
    if (p[0] == 0) return;
    const FirstContact g = first_contact(t.blow);
    const Vec3 slip = g.slip();
    if (!(slip.norm() > 0)) return;
    const double impulse = t.blow.ball.mass * launch.velocity.dot(g.normal);
    launch.spin += p[0] * t.blow.ball.radius * impulse / t.blow.ball.inertia() * slip.normalized().cross(g.normal);
  };
  // Friction closes the slip all the same: then the offset moves impulse from the tangent to the couple.
  Parametrisation closed{
      .what = "offset over the ball's radius, rolling kept", .parameters = {offset}, .complexity = 3};
  closed.before = [](Sizes p, Shot& t) { t.blow.contact.normal_force_offset += p[0]; };
  // Without slip there is no side to go to: in the simplest law of that kind it is in proportion. It lasts as long as
  // the slip, which friction closes.
  Parametrisation with_slip{
      .what = "offset in proportion to slip over approach, rolling kept", .parameters = {share}, .complexity = 3};
  with_slip.before = [](Sizes p, Shot& t) {
    const FirstContact g = first_contact(t.blow);
    const double approach = g.approach.dot(g.normal);
    if (p[0] != 0 && approach > 0) t.blow.contact.normal_force_offset += p[0] * g.slip().norm() / approach;
  };
  return {couple, closed, with_slip};
}

}  // namespace hosel::loop::forms
