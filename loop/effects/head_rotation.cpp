// A free head turns under an off-centre blow (gear effect). For bases whose head does not turn: the
// difference that the declared inertia makes in the eccentric rigid impact is added to the launch.
#include "loop/effects/all.hpp"
#include "loop/effects/eccentric_difference.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> head_rotation(const Setting& setting) {
  if (setting.head_turns || !setting.inertia_declared) return {};
  // 1 is a head as free as the declared inertia says; a held head turns less.
  const Parameter freedom{"freedom", "1", 1, 0, 1.6, 0.2};
  Parametrisation rotation{.what = "the declared inertia turns", .parameters = {freedom}};
  rotation.after = [](Sizes p, const Shot& t, Launch& launch) {
    if (p[0] == 0) return;
    Blow turned = t.blow, fixed = t.blow;
    turned.club.head.inertia = t.blow.club.head.inertia / p[0];
    fixed.club.head.inertia = t.blow.club.head.inertia * 1e9;
    add_difference(turned, fixed, 1, launch);
  };
  // The whole eccentric blow in place of the planar one: face, path and curvature act too.
  Parametrisation whole{.what = "free head, with face, path and curvature in three dimensions",
                        .parameters = {freedom}};
  whole.after = [](Sizes p, const Shot& t, Launch& launch) {
    if (p[0] == 0) return;
    Blow planar = t.blow;
    planar.delivery.club_path = planar.delivery.face_angle = 0;
    planar.club.head.face = Face{};
    planar.club.head.inertia = t.blow.club.head.inertia * 1e9;
    planar.club.head.cg = Vec3::Zero();
    add_difference(t.blow, planar, p[0], launch);
  };
  return {rotation, whole};
}

}  // namespace hosel::loop::forms
