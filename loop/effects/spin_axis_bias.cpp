// The recorded tilt of the spin is not the spin's.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> spin_axis_bias(const Setting& setting) {
  if (!setting.no_blow) return {};
  return {{.what = "tilt of the spin beyond the recorded one, positive for a fade",
           .parameters = {{"tilt", "deg", kRadPerDeg, radians(-30), radians(30), radians(1)}},
           .seen = [](Sizes p, Launch& launch) {
             if (p[0] == 0) return;
             const Vec3 ahead = Vec3(launch.velocity.x(), launch.velocity.y(), 0).normalized();
             launch.spin = Eigen::AngleAxisd(p[0], ahead) * launch.spin;
           }}};
}

}  // namespace hosel::loop::forms
