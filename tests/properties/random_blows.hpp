/// Blows that a golfer might give and some that nobody does, by a seed; and how often a property is tried.
#pragma once

#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "golf/units.hpp"
#include "models/options.hpp"
#include "models/registry.hpp"

namespace hosel::test {

/// HOSEL_CHECKS, or `standard`: how many trials a property gets in all.
inline int checks(int standard) {
  const char* wanted = std::getenv("HOSEL_CHECKS");
  return wanted ? std::max(1, std::atoi(wanted)) : standard;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(engine_);
  }
  double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool chance(double p) { return between(0, 1) < p; }
  Vec3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }

 private:
  std::mt19937_64 engine_;
};

/// A blow and what the reduced models need beside it.
struct Trial {
  Blow blow;
  models::Options options;
};

/// `wide`: contact laws and materials over all that a case may state; else what balls have.
inline Trial random_trial(Random& r, bool wide) {
  Trial t;
  Delivery& d = t.blow.delivery;
  d.club_speed = r.between(5, 70);
  d.attack_angle = radians(r.between(-10, 10));
  d.club_path = radians(r.between(-10, 10));
  d.dynamic_loft = radians(r.between(0, 55));
  d.face_angle = radians(r.between(-10, 10));
  d.impact_toe = r.between(-0.03, 0.03);
  d.impact_high = r.between(-0.02, 0.02);
  if (r.chance(0.5)) d.head_angular_velocity = r.vector(30);
  Head& head = t.blow.club.head;
  head.mass = r.between(0.1, 0.4);
  head.cg = Vec3(r.between(-0.04, 0), r.between(-0.01, 0.01), r.between(-0.01, 0.01));
  // A body's moments: sums of second moments, two and two; its axes anywhere.
  const Vec3 second(r.between(0.3e-4, 2e-4), r.between(0.3e-4, 2e-4), r.between(0.3e-4, 2e-4));
  const Mat3 turn = Eigen::AngleAxisd(r.between(0, 3), r.vector(1).normalized()).toRotationMatrix();
  head.inertia = turn * Vec3(second.y() + second.z(), second.x() + second.z(), second.x() + second.y()).asDiagonal() *
                 turn.transpose();
  head.inertia = 0.5 * (head.inertia + head.inertia.transpose()).eval();
  if (r.chance(0.5)) head.face = {.bulge = r.between(0.2, 0.5), .roll = r.between(0.2, 0.5)};
  t.blow.club.geometry.hosel = Vec3(r.between(-0.02, 0), r.between(0.03, 0.06), r.between(-0.01, 0.02));
  t.blow.club.geometry.shaft_axis = Vec3(r.between(-0.2, 0.2), r.between(0.3, 0.6), r.between(0.7, 0.9)).normalized();
  Shaft shaft;
  shaft.damping_time = r.between(0, 1e-5);
  const double EI = r.between(15, 60), taper = r.between(0.3, 0.8), mass = r.between(0.04, 0.12);
  for (const double s : {0.0, 0.5, 1.0}) {
    const double k = 1 - (1 - taper) * s;
    shaft.stations.push_back({.arc_length = 1.1 * s,
                              .bending_stiffness_y = EI * k,
                              .bending_stiffness_z = EI * k,
                              .torsional_stiffness = 0.6 * EI * k,
                              .axial_stiffness = 4e6 * k,
                              .shear_stiffness = 1e6 * k,
                              .mass_per_length = mass * k,
                              .rotary_inertia_y = 3e-6 * k,
                              .rotary_inertia_z = 3e-6 * k,
                              .outer_radius = 0.005});
  }
  t.blow.club.shaft = shaft;
  t.blow.ball.inertia_factor = r.between(0.36, 0.44);
  ContactLaw& c = t.blow.contact;
  c.restitution = wide ? r.between(0, 1) : r.between(0.7, 0.9);
  c.restitution_slope = wide ? r.between(-0.005, 0.002) : r.between(-0.003, 0);
  c.restitution_falloff = r.chance(0.5) ? r.between(0, 100) : 0;
  c.tangential_restitution = wide ? r.between(-1, 1) : r.between(0, 0.3);
  if (r.chance(0.7)) c.friction = wide ? r.log_between(1e-3, 3) : r.between(0.2, 0.6);
  c.normal_force_offset = wide && r.chance(0.5) ? r.between(-0.5, 0.5) : 0;
  models::VolumetricLaw& v = t.options.volumetric;
  v.stiffness *= wide ? r.log_between(0.05, 20) : r.between(0.8, 1.2);
  v.damping *= wide ? r.between(0, 5) : r.between(0.8, 1.2);
  v.friction = wide ? r.log_between(1e-3, 3) : r.between(0.2, 0.5);
  v.static_friction = v.friction * r.between(1, wide ? 2 : 1.2);
  v.transition_speed *= wide ? r.log_between(0.05, 10) : r.between(0.8, 1.2);
  v.joint_stiffness *= wide ? r.log_between(0.01, 100) : r.between(0.5, 2);
  v.joint_damping *= wide ? r.log_between(0.01, 10) : r.between(0.5, 2);
  v.cover_thickness = r.between(0.5e-3, 4e-3);
  if (r.chance(0.3)) v.volume_exponent = r.between(0.5, 1);
  t.options.hertz_maw = {.modulus = r.log_between(20e6, 500e6),
                         .poisson = r.between(0.2, 0.499),
                         .friction = v.friction,
                         .damping = v.damping};
  return t;
}

/// The models without finite elements, by their names.
inline std::vector<std::string> reduced_models() {
  std::vector<std::string> names;
  for (const models::ModelEntry& m : models::registry())
    if (!m.name.starts_with("fe-")) names.emplace_back(m.name);
  return names;
}

}  // namespace hosel::test
