// The launch monitor's axes are turned against the target frame: it reports the same vectors in its own axes.
#include <algorithm>

#include "loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> monitor_misalignment(const Setting& setting) {
  // A monitor is levelled by its own sensors and aimed by eye: beyond this its angles are wrong, not its axes. Usual:
  // assumed, four tenths of that.
  const auto angle = [](const char* name, double most) {
    return Parameter{name, "deg", kRadPerDeg, radians(-most), radians(most), radians(0.5)}.within(radians(most / 2.5));
  };
  // Positive yaw turns what the monitor shows to the right, positive pitch upwards, positive roll adds fade spin.
  const auto about = [&](const std::vector<int>& axes, const char* what) {
    static constexpr const char* names[] = {"roll", "pitch", "yaw"};
    Parametrisation f{.what = what};
    for (const int a : axes) f.parameters.push_back(angle(names[a], a == 2 ? 5 : 3));
    f.after = [axes](Sizes p, const Shot&, Launch& launch) {
      Mat3 turn = Mat3::Identity();
      bool turned = false;
      for (std::size_t k = 0; k < axes.size(); ++k) {
        if (p[k] == 0) continue;
        turn = Eigen::AngleAxisd(axes[k] == 0 ? p[k] : -p[k], Vec3::Unit(axes[k])).toRotationMatrix() * turn;
        turned = true;
      }
      if (!turned) return;
      launch.velocity = turn * launch.velocity;
      launch.spin = turn * launch.spin;
    };
    return f;
  };
  // Without a sideways reading, yaw and roll show in the second order only.
  const bool sideways = std::ranges::any_of(setting.outputs, [](Output o) {
    return o == Output::azimuth || o == Output::sidespin || o == Output::spin_axis;
  });
  if (!sideways) return {about({1}, "pitch")};
  return {about({2}, "yaw"), about({1}, "pitch"), about({0}, "roll"), about({2, 1}, "yaw and pitch"),
          about({2, 1, 0}, "yaw, pitch and roll")};
}

}  // namespace hosel::loop::forms
