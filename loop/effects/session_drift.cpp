// Something drifts slowly and steadily with the shot number: an instrument, the club, the ball or the face.
#include <fmt/format.h>

#include "loop/effects/all.hpp"

namespace hosel::loop::forms {
namespace {

Parameter size_of(Output output) {
  const std::string name = fmt::format("{}_per_session", stem(output));
  const auto degrees = [&](double most, double scale) {
    return Parameter{name, "deg", kRadPerDeg, -radians(most), radians(most), radians(scale)};
  };
  switch (output) {
    case Output::ball_speed: return {name, "m/s", 1, -12, 12, 0.5};
    case Output::launch_angle:
    case Output::azimuth: return degrees(8, 0.4);
    case Output::spin_axis: return degrees(20, 2);
    default: break;  // a spin; readings of the flight are not among the setting's outputs
  }
  return {name, "rpm", kRadPerSecPerRpm, -2500 * kRadPerSecPerRpm, 2500 * kRadPerSecPerRpm, 100 * kRadPerSecPerRpm};
}

}  // namespace

std::vector<Parametrisation> session_drift(const Setting& setting) {
  std::vector<Parametrisation> forms;
  // Zero at the first shot (something wears or warms), or zero in the middle (calibrated over the session).
  for (const double zero : {0.0, 0.5}) {
    const std::string from = zero == 0 ? ", from the first shot" : ", about the middle";
    const auto readings = [&](const std::vector<Output>& outputs, const std::string& what, double complexity) {
      Parametrisation f{.what = what + from, .complexity = complexity, .of_order = true};
      for (const Output output : outputs) f.parameters.push_back(size_of(output));
      f.reading = [outputs, zero](Sizes q, const Shot& t, Output o, double value) {
        for (std::size_t k = 0; k < outputs.size(); ++k)
          if (o == outputs[k] && q[k] != 0) return value + q[k] * (t.order - zero);
        return value;
      };
      forms.push_back(f);
    };
    // One reading, then two at once, then all: an instrument that drifts may do so in more than one.
    const std::vector<Output>& all = setting.outputs;
    for (const Output output : all) readings({output}, fmt::format("of the {} reading", stem(output)), 0);
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = a + 1; b < all.size(); ++b)
        readings({all[a], all[b]}, fmt::format("of the {} and {} readings", stem(all[a]), stem(all[b])), 4);
    if (all.size() > 2) readings(all, "of all readings", 4);
    // What drifts is the instrument before it is the club or the ball.
    const auto drift = [&](const char* what, Parameter p, double& (*of)(Shot&), bool relative) {
      Parametrisation f{.what = what + from, .parameters = {std::move(p)}, .complexity = 8, .of_order = true};
      f.before = [of, relative, zero](Sizes q, Shot& t) {
        double& x = of(t);
        x += q[0] * (t.order - zero) * (relative ? x : 1);
      };
      forms.push_back(f);
    };
    drift(
        "of the club speed", {"relative_club_speed_per_session", "1", 1, -0.2, 0.2, 0.01},
        [](Shot& s) -> double& { return s.blow.delivery.club_speed; }, true);
    drift(
        "of the loft", {"loft_per_session", "deg", kRadPerDeg, radians(-8), radians(8), radians(0.5)},
        [](Shot& s) -> double& { return s.blow.delivery.dynamic_loft; }, false);
    if (setting.deformable) {
      drift(
          "of the ball's losses", {"log_factor_of_losses_per_session", "1", 1, -0.8, 0.8, 0.05},
          [](Shot& s) -> double& { return s.change.losses; }, false);
      drift(
          "of the friction", {"relative_friction_per_session", "1", 1, -0.6, 0.6, 0.1},
          [](Shot& s) -> double& { return s.blow.contact.friction; }, true);
      continue;
    }
    drift(
        "of the restitution", {"restitution_per_session", "1", 1, -0.2, 0.2, 0.02},
        [](Shot& s) -> double& { return s.blow.contact.restitution; }, false);
    drift(
        "of the tangential restitution", {"tangential_restitution_per_session", "1", 1, -0.6, 0.6, 0.1},
        [](Shot& s) -> double& { return s.blow.contact.tangential_restitution; }, false);
  }
  return forms;
}

}  // namespace hosel::loop::forms
