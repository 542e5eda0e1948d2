#include <algorithm>
#include <array>
#include <utility>

#include "loop/effects/all.hpp"

namespace hosel::loop {
namespace {

using namespace forms;
using Through = OneFunction::Through;
using Of = OneFunction::Of;
constexpr OneFunction kTangential{Through::tangential_restitution, Of::blow};
constexpr OneFunction kNormal{Through::normal_restitution, Of::blow};
constexpr OneFunction kNormalByPlace{Through::normal_restitution, Of::place};
constexpr OneFunction kLoft{Through::recorded_loft, Of::blow};
constexpr std::array kEffects = {
    EffectEntry{"ball-tangential-compliance",
                "tangential energy stored in the ball and given back: more spin than rolling",
                "slip at the end of contact (high-speed video of the ball's markings)", ball_tangential_compliance,
                nullptr, kTangential},
    EffectEntry{"friction-limit", "the ball slides throughout at high obliquity: spin below rolling",
                "friction coefficient of face and cover", friction_limit},
    EffectEntry{"restitution-law", "level or speed dependence of the normal coefficient of restitution",
                "head speed after impact", restitution_law, nullptr, kNormal},
    EffectEntry{"restitution-falloff", "restitution drops away from the face centre",
                "normal restitution of the bare face at several points", restitution_falloff, nullptr, kNormalByPlace},
    EffectEntry{"face-compliance",
                "the face yields under the ball: restitution above that of a rigid face, falling towards the edge",
                "characteristic time of the face (pendulum test) at several points", face_compliance, nullptr,
                kNormalByPlace},
    EffectEntry{"head-rotation", "a free head turns under an off-centre blow (gear effect)",
                "angular velocity of the head after impact", head_rotation},
    EffectEntry{"head-mass", "effective head mass differs from the declared one", "head speed after impact", head_mass},
    EffectEntry{"head-inertia", "effective rotational inertia differs (a shaft resists the turn)",
                "moment of inertia of the head (torsion pendulum), or its angular velocity after impact", head_inertia,
                head_inertia},
    EffectEntry{"shaft-coupling", "the club behind the head, where the base is a free head",
                "velocity and angular velocity of the head after impact, with and without shaft", shaft_coupling},
    EffectEntry{"cg-shift", "the centre of gravity is not where it is declared",
                "centre of gravity of the head (balance)", cg_shift, cg_shift},
    EffectEntry{"head-closure", "the head has an angular velocity at impact",
                "angular velocity of the head before impact", head_closure},
    EffectEntry{"ball-inertia", "the ball's moment of inertia is not the declared one",
                "moment of inertia of the ball (torsion pendulum)", ball_inertia},
    EffectEntry{"normal-force-offset", "the resultant normal force does not pass through the ball's centre",
                "contact patch over time (pressure film, high-speed video)", normal_force_offset},
    EffectEntry{"loft-bias", "the recorded loft is not the loft that the ball met",
                "loft by a second instrument (camera at impact)", loft_bias, nullptr, kLoft},
    EffectEntry{"monitor-misalignment", "the launch monitor's axes are turned against the target frame",
                "the monitor's axes against a surveyed line", monitor_misalignment},
    EffectEntry{"session-drift", "something drifts slowly and steadily with the shot number",
                "a repeated reference shot through the session", session_drift},
    EffectEntry{"ball-cover-stiffness", "the cover is stiffer or softer against the core than declared",
                "indentation of cover and core", ball_cover_stiffness},
    EffectEntry{"ball-relaxation", "the ball's shear losses are not the declared ones, at equal normal restitution",
                "tangential restitution at several speeds of contact", ball_relaxation},
    EffectEntry{"hosel-place", "the shaft meets the head elsewhere than declared", "place of the hosel (callipers)",
                hosel_place},
    EffectEntry{"drag-level", "the ball's drag is not the flight law's", "speed of the ball along its flight (radar)",
                drag_level},
    EffectEntry{"lift-law", "the ball's lift is not the flight law's", "height of the ball along its flight (radar)",
                lift_law},
    EffectEntry{"spin-decay", "the spin dies out faster or slower than declared", "spin at landing (radar)",
                spin_decay},
    EffectEntry{"air-density", "the air is denser or thinner than declared", "temperature, pressure and humidity",
                air_density},
    EffectEntry{"spin-axis-bias", "the recorded tilt of the spin is not the spin's",
                "tilt of the spin by a second instrument (high-speed video of a marked ball)", spin_axis_bias},
    EffectEntry{"wind", "a wind blows that is not declared", "wind at the height of the flight (anemometer)", wind},
    EffectEntry{"shaft-stiffness", "the shaft is stiffer or softer than its table",
                "bending stiffness of the bare shaft (three-point bending)", shaft_stiffness, shaft_stiffness},
    EffectEntry{"shaft-damping", "vibrations die away faster or slower",
                "decay of a long record after the same release", nullptr, shaft_damping},
    EffectEntry{"clamp-compliance", "the clamp yields",
                "rotation of the shaft at the clamp (dial gauge or strain near the clamp)", nullptr, clamp_compliance},
    EffectEntry{"hosel-compliance", "the joint of tip and head yields", "rotation of the head against the tip", nullptr,
                hosel_compliance},
    EffectEntry{"tip-mass", "mass at the tip that is not declared", "mass of head and hosel (scales)", nullptr,
                tip_mass},
    EffectEntry{"rotational-stiffening", "the pull of turning stiffens the shaft",
                "the same test at another rate of turning, and at rest", nullptr, rotational_stiffening},
    EffectEntry{"sensor-delay", "a channel lags behind", "a common event in all channels (a tap)", nullptr,
                sensor_delay},
    EffectEntry{"sensor-gain", "a channel shows a multiple", "a known displacement of the sensor", nullptr,
                sensor_gain},
    EffectEntry{"sensor-offset", "a channel's zero is not zero", "a reading at rest", nullptr, sensor_offset},
};

template <class S>
std::vector<Parametrisation> named(std::string_view name, std::vector<Parametrisation> (*on)(const S&), const S& at) {
  std::vector<Parametrisation> all;
  if (on) all = on(at);
  for (Parametrisation& f : all) f.effect = name;
  return all;
}

}  // namespace

std::vector<Parametrisation> EffectEntry::forms(const Setting& setting) const { return named(name, on_shots, setting); }
std::vector<Parametrisation> EffectEntry::forms(const HistorySetting& setting) const {
  return named(name, on_tests, setting);
}

std::span<const EffectEntry> effects() { return kEffects; }

Parametrisation placed_otherwise(const Parametrisation& form, std::function<double(double)> place) {
  Parametrisation other = form;
  other.of_order = false;
  if (form.before)
    other.before = [before = form.before, place](Sizes p, Shot& s) {
      const double own = std::exchange(s.order, place(s.order));
      before(p, s);
      s.order = own;
    };
  if (form.reading)
    other.reading = [reading = form.reading, place](Sizes p, const Shot& s, Output of, double value) {
      Shot at = s;
      at.order = place(s.order);
      return reading(p, at, of, value);
    };
  return other;
}

std::vector<EffectEntry> effects_with(std::span<const EffectEntry> own) {
  std::vector<EffectEntry> all(kEffects.begin(), kEffects.end());
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

const EffectEntry* find_effect(std::string_view name, std::span<const EffectEntry> own) {
  for (const std::span<const EffectEntry> some : {effects(), own})
    for (const EffectEntry& e : some)
      if (e.name == name) return &e;
  return nullptr;
}

std::vector<std::string> sensors_of(const std::vector<std::vector<std::string>>& ties,
                                    std::span<const EffectEntry> own) {
  std::vector<std::string> all;
  for (const auto& tie : ties)
    for (const std::string& name : tie)
      if (const EffectEntry* e = find_effect(name, own); e && !std::ranges::count(all, e->sensor))
        all.emplace_back(e->sensor);
  return all;
}

}  // namespace hosel::loop
