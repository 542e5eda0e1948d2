// Something drifts slowly and steadily with the shot number: an instrument, the club, the ball or the face.
#include <fmt/format.h>

#include "hosel/loop/effects/all.hpp"

namespace hosel::loop::forms {
namespace {

Parameter size_of(Output output) {
  switch (output) {
    case Output::ball_speed: return {"", "m/s", 1, -12, 12, 0.5};
    case Output::launch_angle:
    case Output::azimuth: return {"", "deg", kRadPerDeg, radians(-8), radians(8), radians(0.4)};
    case Output::spin_axis: return {"", "deg", kRadPerDeg, radians(-20), radians(20), radians(2)};
    case Output::backspin:
    case Output::sidespin:
    case Output::spin_rate: break;
  }
  return {"", "rpm", kRadPerSecPerRpm, -2500 * kRadPerSecPerRpm, 2500 * kRadPerSecPerRpm, 100 * kRadPerSecPerRpm};
}

}  // namespace

std::vector<Form> session_drift(const Setting& setting) {
  const char* effect = "session-drift";
  std::vector<Form> forms;
  // Zero at the first shot (something wears or warms), or zero in the middle (calibrated over the session).
  for (const double zero : {0.0, 0.5}) {
    const std::string from = zero == 0 ? "from the first shot" : "about the middle";
    for (const Output output : setting.outputs) {
      Parameter p = size_of(output);
      p.name = fmt::format("{}_per_session", stem(output));
      Form f{.effect = effect, .what = fmt::format("of the {} reading, {}", stem(output), from), .parameters = {p}};
      f.reading = [output, zero](std::span<const double> q, const Trial& t, Output o, double value) {
        return o == output ? value + q[0] * (t.order - zero) : value;
      };
      forms.push_back(f);
    }
    // Two readings at once, then all: an instrument that drifts may do so in more than one.
    const auto several = [&](const std::vector<Output>& outputs, std::string what, double rarity) {
      Form all{.effect = effect, .what = what + ", " + from};
      for (const Output output : outputs) {
        Parameter p = size_of(output);
        p.name = fmt::format("{}_per_session", stem(output));
        all.parameters.push_back(p);
      }
      all.rarity = rarity;
      all.reading = [outputs, zero](std::span<const double> q, const Trial& t, Output o, double value) {
        for (std::size_t k = 0; k < outputs.size(); ++k)
          if (o == outputs[k] && q[k] != 0) return value + q[k] * (t.order - zero);
        return value;
      };
      forms.push_back(all);
    };
    for (std::size_t a = 0; a < setting.outputs.size(); ++a)
      for (std::size_t b = a + 1; b < setting.outputs.size(); ++b)
        several({setting.outputs[a], setting.outputs[b]},
                fmt::format("of the {} and {} readings", stem(setting.outputs[a]), stem(setting.outputs[b])), 4);
    if (setting.outputs.size() > 2) several(setting.outputs, "of all readings", 4);
    // What drifts is the instrument before it is the club or the ball.
    Form speed{.effect = effect,
               .what = "of the club speed, " + from,
               .parameters = {{"relative_club_speed_per_session", "1", 1, -0.2, 0.2, 0.01}}};
    speed.before = [zero](std::span<const double> q, Trial& t) {
      t.blow.delivery.club_speed *= 1 + q[0] * (t.order - zero);
    };
    speed.rarity = 8;
    forms.push_back(speed);
    Form loft{.effect = effect,
              .what = "of the loft, " + from,
              .parameters = {{"loft_per_session", "deg", kRadPerDeg, radians(-8), radians(8), radians(0.5)}}};
    loft.before = [zero](std::span<const double> q, Trial& t) {
      t.blow.delivery.dynamic_loft += q[0] * (t.order - zero);
    };
    loft.rarity = 8;
    forms.push_back(loft);
    Form restitution{.effect = effect,
                     .what = "of the restitution, " + from,
                     .parameters = {{"restitution_per_session", "1", 1, -0.2, 0.2, 0.02}}};
    restitution.before = [zero](std::span<const double> q, Trial& t) {
      t.blow.contact.restitution += q[0] * (t.order - zero);
    };
    restitution.rarity = 8;
    forms.push_back(restitution);
    Form spin{.effect = effect,
              .what = "of the tangential restitution, " + from,
              .parameters = {{"tangential_restitution_per_session", "1", 1, -0.6, 0.6, 0.1}}};
    spin.before = [zero](std::span<const double> q, Trial& t) {
      t.blow.contact.tangential_restitution += q[0] * (t.order - zero);
    };
    spin.rarity = 8;
    forms.push_back(spin);
  }
  return forms;
}

}  // namespace hosel::loop::forms
