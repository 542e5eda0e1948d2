#include "forms.hpp"

#include <stdexcept>

#include "units.hpp"

namespace examination {
namespace {

using P = std::span<const double>;

std::vector<Form> make_natural() {
  std::vector<Form> f;
  f.push_back({"ball-tangential-compliance",
               "constant",
               {{"tangential restitution", "", 0.1, 0.02, 0.45}},
               [](Truth& t, P p) { t.nature.rebound += p[0]; },
               true,
               true});
  f.push_back({"friction-limit",
               "coulomb",
               {{"inverse friction coefficient", "", 1.0, 1.5, 8.0}},
               [](Truth& t, P p) { t.nature.slip = std::max(0.0, p[0]); },
               true,
               true,
               {2.0, 2.7, 3.4, 4.2, 5.0, 6.0, 7.5}});
  f.push_back({"restitution-law",
               "linear",
               {{"restitution at 40 m/s", "", 0.02, -0.09, 0.09}, {"slope", "s/m", 0.001, -0.006, 0.006}},
               [](Truth& t, P p) {
                 t.nature.level += p[0] - 40 * p[1];
                 t.nature.slope -= p[1];
               },
               true,
               true});
  f.push_back({"restitution-falloff",
               "round",
               {{"loss at 20 mm", "", 0.03, 0.005, 0.25}},
               [](Truth& t, P p) {
                 t.nature.falloff_toe += p[0];
                 t.nature.falloff_high += p[0];
               },
               true,
               true});
  f.push_back({"head-rotation",
               "free",
               {{"share of the free head", "", 1.0, 0.999, 1.001}},
               [](Truth& t, P p) { t.nature.turning = p[0]; },
               true,
               false});
  f.push_back({"head-mass",
               "factor",
               {{"relative change", "", 0.03, -0.25, 0.25}},
               [](Truth& t, P p) { t.nature.mass_factor *= 1 + p[0]; },
               true,
               true});
  f.push_back({"head-inertia",
               "factor",
               {{"relative change", "", 0.1, -0.45, 0.9}},
               [](Truth& t, P p) { t.nature.inertia_factor *= 1 + p[0]; },
               false,
               true});
  f.push_back({"shaft-coupling",
               "hosel mass",
               {{"mass", "kg", 0.005, 0.0, 0.03}, {"inertia across the shaft", "", 0.1, 0.0, 0.8}},
               [](Truth& t, P p) {
                 t.nature.shaft_kg += p[0];
                 t.nature.shaft_inertia += p[1];
               },
               false,
               true});
  f.push_back({"cg-shift",
               "across",
               {{"towards the heel", "m", 0.003, -0.012, 0.012}, {"up", "m", 0.003, -0.012, 0.012}},
               [](Truth& t, P p) { t.nature.cg_shift_m += Vector3d(0, p[0], p[1]); },
               false,
               true});
  f.push_back({"head-closure",
               "vertical",
               {{"rate", "rad/s", 10, -60, 60}},
               [](Truth& t, P p) { t.nature.spin_of_head += Vector3d(0, 0, p[0]); },
               false,
               true});
  f.push_back({"ball-inertia",
               "factor",
               {{"relative change", "", 0.03, -0.2, 0.2}},
               [](Truth& t, P p) { t.nature.ball_inertia_factor *= 1 + p[0]; },
               true,
               true});
  f.push_back({"normal-force-offset",
               "constant",
               {{"up", "m", 0.0005, -0.004, 0.004}},
               [](Truth& t, P p) { t.nature.offset_m += Vector3d(0, 0, p[0]); },
               true,
               true});
  f.push_back({"loft-bias",
               "constant",
               {{"loft met minus recorded", "rad", 0.5 * deg, -4 * deg, 4 * deg}},
               [](Truth& t, P p) { t.nature.loft_bias += p[0]; },
               true,
               true});
  f.push_back({"monitor-misalignment",
               "yaw and pitch",
               {{"pitch", "rad", 0.3 * deg, -3 * deg, 3 * deg}, {"yaw", "rad", 0.3 * deg, -3 * deg, 3 * deg}},
               [](Truth& t, P p) { t.nature.monitor += Vector3d(0, p[0], p[1]); },
               true,
               true});
  f.push_back({"session-drift",
               "linear",
               {},
               [](Truth& t, P p) {
                 for (int c = 0; c < drift_channels; ++c) t.drift[c] += p[static_cast<std::size_t>(c)];
               },
               true,
               true});
  for (int c = 0; c < drift_channels; ++c)
    f.back().parameters.push_back({"channel " + std::to_string(c), "noise sd by the end", 1.0, -12, 12});
  return f;
}

std::vector<Form> make_other() {
  std::vector<Form> f;
  f.push_back({"ball-tangential-compliance",
               "growing with normal speed",
               {{"at 35 m/s", "", 0.1, 0.02, 0.45}},
               [](Truth& t, P p) { t.nature.rebound_per_speed += p[0]; },
               true,
               true});
  f.push_back({"ball-tangential-compliance",
               "growing with obliquity",
               {{"at tan 0.4", "", 0.1, 0.02, 0.45}},
               [](Truth& t, P p) { t.nature.rebound_oblique += p[0]; },
               true,
               true});
  f.push_back({"friction-limit",
               "stribeck",
               {{"inverse friction coefficient", "", 1.0, 1.5, 8.0}},
               [](Truth& t, P p) {
                 t.nature.slip = std::max(0.0, p[0]);
                 t.nature.stribeck = 0.35;
               },
               true,
               true,
               {2.0, 2.7, 3.4, 4.2, 5.0, 6.0, 7.5}});
  f.push_back({"restitution-law",
               "quadratic",
               {{"curvature", "s2/m2", 2e-4, -2e-3, 2e-3}},
               [](Truth& t, P p) { t.nature.curvature += p[0]; },
               true,
               true});
  f.push_back({"restitution-law",
               "power",
               {{"exponent", "", 0.05, -0.4, 0.4}},
               [](Truth& t, P p) { t.nature.power += p[0]; },
               true,
               true});
  f.push_back({"restitution-falloff",
               "elliptical",
               {{"loss at 20 mm", "", 0.03, 0.005, 0.25}},
               [](Truth& t, P p) {
                 t.nature.falloff_toe += 0.5 * p[0];
                 t.nature.falloff_high += 1.8 * p[0];
               },
               true,
               true});
  f.push_back({"restitution-falloff",
               "cone",
               {{"loss at 20 mm", "", 0.03, 0.005, 0.25}},
               [](Truth& t, P p) { t.nature.falloff_cone += p[0]; },
               true,
               true});
  f.push_back({"head-inertia",
               "about the vertical",
               {{"relative change", "", 0.1, -0.45, 0.9}},
               [](Truth& t, P p) { t.nature.inertia_factor.z() *= 1 + p[0]; },
               false,
               true});
  f.push_back({"cg-shift",
               "all three",
               {{"size", "m", 0.003, -0.012, 0.012}},
               [](Truth& t, P p) { t.nature.cg_shift_m += p[0] * Vector3d(0.5, 0.7, 0.5); },
               false,
               true});
  f.push_back({"head-closure",
               "about the shaft, with speed",
               {{"rate", "1/m", 0.3, -1.5, 1.5}},
               [](Truth& t, P p) { t.nature.closure_per_speed += p[0]; },
               false,
               true});
  f.push_back({"normal-force-offset",
               "growing with obliquity",
               {{"at tan 1", "m", 0.001, -0.01, 0.01}},
               [](Truth& t, P p) { t.nature.offset_oblique += p[0]; },
               true,
               true});
  f.push_back({"loft-bias",
               "gain",
               {{"gain", "", 0.03, -0.25, 0.25}},
               [](Truth& t, P p) { t.nature.loft_gain += p[0]; },
               true,
               true});
  f.push_back({"loft-bias",
               "with speed",
               {{"at 50 m/s", "rad", 0.5 * deg, -4 * deg, 4 * deg}},
               [](Truth& t, P p) {
                 t.nature.loft_bias += 0.5 * p[0];
                 t.nature.loft_per_speed += 0.05 * p[0];
               },
               true,
               true});
  f.push_back({"monitor-misalignment",
               "about three axes",
               {{"size", "rad", 0.3 * deg, -3 * deg, 3 * deg}},
               [](Truth& t, P p) { t.nature.monitor += p[0] * Vector3d(0.8, 0.6, 0.7); },
               false,
               true});
  f.push_back({"session-drift",
               "concave",
               {{"ball speed", "noise sd by the end", 1, -10, 10}, {"spin", "noise sd by the end", 1, -10, 10}},
               [](Truth& t, P p) {
                 t.drift[0] += p[0];
                 t.drift[3] += p[1];
                 t.drift_power = 0.6;
               },
               true,
               true});
  f.push_back({"session-drift",
               "of the loft",
               {{"by the end", "rad", 0.5 * deg, -4 * deg, 4 * deg}},
               [](Truth& t, P p) { t.loft_drift += p[0]; },
               true,
               true});
  f.push_back({"session-drift",
               "of the restitution",
               {{"by the end", "", 0.01, -0.08, 0.08}},
               [](Truth& t, P p) { t.level_drift += p[0]; },
               true,
               true});
  return f;
}

}  // namespace

const std::vector<Form>& natural_forms() {
  static const std::vector<Form> forms = make_natural();
  return forms;
}

const std::vector<Form>& other_forms() {
  static const std::vector<Form> forms = make_other();
  return forms;
}

const Form& find_form(const std::string& effect, const std::string& form) {
  for (const auto* list : {&natural_forms(), &other_forms()})
    for (const Form& f : *list)
      if (f.effect == effect && f.form == form) return f;
  throw std::invalid_argument("no form '" + form + "' of " + effect);
}

const Form& calibration() {
  static const Form form{"restitution-level",
                         "constant",
                         {{"level", "", 0.02, -1, 1}},
                         [](Truth& t, P p) { t.nature.level += p[0]; },
                         true,
                         true};
  return form;
}

}  // namespace examination
