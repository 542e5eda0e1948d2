/// The beams of the benchmark file (part 1) and small systems made of them.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "fem/beam.hpp"
#include "fem/rigid_body.hpp"
#include "fem/supports.hpp"
#include "golf/units.hpp"
#include "solvers/newton.hpp"

namespace hosel::test {

inline constexpr double kInf = std::numeric_limits<double>::infinity();

enum class Theory { euler, rayleigh, timoshenko };

inline fem::Section by_theory(fem::Section s, Theory theory) {
  if (theory != Theory::timoshenko) s.shear_y = s.shear_z = kInf;
  // Euler-Bernoulli drops the rotary inertia of bending; a thousandth of it keeps the mass matrix definite.
  if (theory == Theory::euler) s.rotary.tail<2>() *= 1e-3;
  return s;
}

/// Saint-Venant torsion constant of a rectangle a >= b (series).
inline double rectangle_torsion(double a, double b) {
  double sum = 0;
  for (int n = 1; n < 40; n += 2) sum += std::tanh(n * kPi * a / (2 * b)) / std::pow(n, 5);
  return a * b * b * b * (1.0 / 3 - 64 / std::pow(kPi, 5) * b / a * sum);
}

/// B1: aluminium, width 0.010, depth 0.020 (1 - 0.5 x/L), L = 0.5; bends in the tapered plane about z.
inline fem::SectionLaw b1(Theory theory) {
  return [theory](double x) {
    const double b = 0.010, h = 0.020 * (1 - 0.5 * x / 0.5), E = 70e9, G = 26e9, rho = 2700;
    const double I = b * h * h * h / 12, I2 = h * b * b * b / 12;
    return by_theory({.axial = E * b * h,
                      .shear_y = 5.0 / 6 * G * b * h,
                      .shear_z = 5.0 / 6 * G * b * h,
                      .torsion = G * rectangle_torsion(std::max(b, h), std::min(b, h)),
                      .bending_y = E * I2,
                      .bending_z = E * I,
                      .mass = rho * b * h,
                      .rotary = rho * Vec3(I + I2, I2, I)},
                     theory);
  };
}

/// B2: steel tube, outer diameter 0.0152 -> 0.0094 over L = 1, wall 0.0004.
inline fem::SectionLaw b2(Theory theory) {
  return [theory](double x) {
    const double E = 205e9, G = 79e9, rho = 7850, kappa = 0.53;
    const double d = 0.0152 + (0.0094 - 0.0152) * x, i = d - 2 * 0.0004;
    const double A = kPi / 4 * (d * d - i * i), I = kPi / 64 * (std::pow(d, 4) - std::pow(i, 4));
    return by_theory({.axial = E * A,
                      .shear_y = kappa * G * A,
                      .shear_z = kappa * G * A,
                      .torsion = G * 2 * I,
                      .bending_y = E * I,
                      .bending_z = E * I,
                      .mass = rho * A,
                      .rotary = rho * I * Vec3(2, 1, 1)},
                     theory);
  };
}

inline fem::Section uniform(double EA, double GA, double GJ, double EI, double mass, const Vec3& rotary) {
  return {.axial = EA,
          .shear_y = GA,
          .shear_z = GA,
          .torsion = GJ,
          .bending_y = EI,
          .bending_z = EI,
          .mass = mass,
          .rotary = rotary};
}

/// A beam in a system of its own, with its reference placement.
struct BeamSystem {
  BeamSystem(const std::vector<mesh::LineNode>& line, const fem::SectionLaw& sections, fem::BeamOptions options = {}) {
    auto owned = std::make_unique<fem::Beam>(system.dof_map, line, sections, std::move(options));
    beam = owned.get();
    system.terms.push_back(std::move(owned));
    rest = system.dof_map.rest();
    beam->place(rest);
  }
  void clamp_first() {
    system.prescribed.push_back(
        std::make_unique<fem::ImposedMotion>(beam->nodes().front(), fem::at_rest(beam->line().front().position)));
  }
  void load(const fem::Node& node, std::function<fem::Wrench(double)> wrench,
            fem::NodeLoad::Moment moment = fem::NodeLoad::Moment::global) {
    system.terms.push_back(std::make_unique<fem::NodeLoad>("load", node, std::move(wrench), moment));
  }
  const fem::Node& tip() const { return beam->nodes().back(); }
  Vec3 displacement(const fem::State& s, std::size_t node) const {
    return Vec3(s.q.segment<3>(beam->nodes()[node].translation.q)) - beam->line()[node].position;
  }
  Vec3 tip_displacement(const fem::State& s) const { return displacement(s, beam->nodes().size() - 1); }
  Vec3 tip_rotation(const fem::State& s) const { return fem::rotation_log(fem::rotation(s, tip().rotation)); }

  fem::System system;
  fem::Beam* beam = nullptr;
  fem::State rest;
};

inline solvers::NewtonOptions tight() {
  return {.residual_relative = 1e-9, .residual_absolute = 1e-9, .increment_vector = 1e-8, .increment_rotation = 1e-8};
}

}  // namespace hosel::test
