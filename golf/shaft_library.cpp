#include "golf/shaft_library.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "golf/units.hpp"

namespace hosel {
namespace {

constexpr int kStations = 401;  // linear between them: relative error below 1e-5 of a smooth property

ShaftStation tube_section(const TubeStation& t, const std::vector<ShaftLayer>& layers, double shear_factor) {
  ShaftStation s{.arc_length = t.arc_length, .outer_radius = t.outer_radius};
  double inner = t.outer_radius - t.wall;
  for (const ShaftLayer& layer : layers) {
    const double outer = inner + layer.share * t.wall;
    const double A = kPi * (outer * outer - inner * inner), I = kPi / 4 * (std::pow(outer, 4) - std::pow(inner, 4));
    s.bending_stiffness_y += layer.E * I;
    s.bending_stiffness_z += layer.E * I;
    s.torsional_stiffness += layer.G * 2 * I;
    s.axial_stiffness += layer.E * A;
    s.shear_stiffness += shear_factor * layer.G * A;
    s.mass_per_length += layer.density * A;
    s.rotary_inertia_y += layer.density * I;
    s.rotary_inertia_z += layer.density * I;
    inner = outer;
  }
  return s;
}

ShaftStation thin_tube(const CompositeStation& c) {
  const double r2 = c.mean_radius * c.mean_radius, rho_I = 0.5 * c.mass_per_length * r2;
  return {.arc_length = c.arc_length,
          .bending_stiffness_y = c.bending_stiffness,
          .bending_stiffness_z = c.bending_stiffness,
          .torsional_stiffness = c.torsional_stiffness,
          .axial_stiffness = 2 * c.bending_stiffness / r2,
          .shear_stiffness = 0.5 * c.torsional_stiffness / r2,
          .mass_per_length = c.mass_per_length,
          .rotary_inertia_y = rho_I,
          .rotary_inertia_z = rho_I,
          .outer_radius = c.mean_radius};
}

double between(double a, double b, double w) { return (1 - w) * a + w * b; }

/// kStations stations, each by section(arc length from the first of `given`, the given ones on either side, the share
/// of the second).
template <class Station, class Section>
Shaft resampled(const std::vector<Station>& given, const Section& section) {
  Shaft shaft;
  const double start = given.front().arc_length, length = given.back().arc_length - start;
  std::size_t at = 0;
  for (int i = 0; i < kStations; ++i) {
    const double s = start + length * i / (kStations - 1);
    while (at + 2 < given.size() && s > given[at + 1].arc_length) ++at;
    const Station &a = given[at], &b = given[at + 1];
    shaft.stations.push_back(section(s - start, a, b, (s - a.arc_length) / (b.arc_length - a.arc_length)));
  }
  return shaft;
}

Shaft composite_driver() {
  // EI, mass and GJ/EI within the published range of composite driver shafts; the radii are those of common blanks.
  return composite_shaft({{0, 70, 0.35 * 70, 0.060 / 1.1, 0.0072}, {1.1, 20, 0.35 * 20, 0.060 / 1.1, 0.0042}});
}

Shaft steel_iron7() {
  // Outer radius and wall as published for a 7-iron shaft of 104 g, which they make 125 g of steel; E 190 GPa, nu 0.29.
  constexpr double E = 190e9, G = E / (2 * 1.29);
  return tube_shaft(
      {{0, 7.6e-3, 0.348e-3}, {0.273, 7.24e-3, 0.381e-3}, {0.609, 5.08e-3, 0.549e-3}, {0.965, 4.7e-3, 0.549e-3}},
      {{1, E, G, 7850}}, 0.53);
}

constexpr std::array kLibrary = {
    NamedShaft{"composite-driver", "composite, 60 g, 1.10 m, EI 70 (butt) to 20 N m^2 (tip), GJ 0.35 EI",
               composite_driver},
    NamedShaft{"steel-7-iron", "steel, 125 g, 0.965 m, published radii and walls, EI 85 to 28 N m^2", steel_iron7},
};

/// Moduli of stretch go with those of bending, of shear with those of torsion.
void scale(ShaftStation& s, double bending, double torsion) {
  s.bending_stiffness_y *= bending;
  s.bending_stiffness_z *= bending;
  s.axial_stiffness *= bending;
  s.shear_stiffness *= torsion;
  s.torsional_stiffness *= torsion;
}

}  // namespace

Shaft tube_shaft(const std::vector<TubeStation>& tube, const std::vector<ShaftLayer>& layers, double shear_factor) {
  if (tube.size() < 2) throw std::invalid_argument("a tube needs at least two stations");
  double share = 0;
  for (const ShaftLayer& layer : layers) share += layer.share;
  if (std::abs(share - 1) > 1e-9) throw std::invalid_argument("the layers' shares of the wall must add up to 1");
  for (std::size_t i = 0; i < tube.size(); ++i) {
    if (i > 0 && !(tube[i].arc_length > tube[i - 1].arc_length))
      throw std::invalid_argument("the stations of a shaft must run from butt to tip with increasing arc length");
    if (!(tube[i].wall > 0 && tube[i].wall <= tube[i].outer_radius))
      throw std::invalid_argument("the wall of a tube lies between zero and its radius");
  }
  return resampled(tube, [&](double s, const TubeStation& a, const TubeStation& b, double w) {
    return tube_section({s, between(a.outer_radius, b.outer_radius, w), between(a.wall, b.wall, w)}, layers,
                        shear_factor);
  });
}

Shaft composite_shaft(const std::vector<CompositeStation>& stations) {
  if (stations.size() < 2) throw std::invalid_argument("a shaft needs at least two stations");
  for (std::size_t i = 1; i < stations.size(); ++i)
    if (!(stations[i].arc_length > stations[i - 1].arc_length))
      throw std::invalid_argument("the stations of a shaft must run from butt to tip with increasing arc length");
  return resampled(stations, [](double s, const CompositeStation& a, const CompositeStation& b, double w) {
    return thin_tube({s, between(a.bending_stiffness, b.bending_stiffness, w),
                      between(a.torsional_stiffness, b.torsional_stiffness, w),
                      between(a.mass_per_length, b.mass_per_length, w), between(a.mean_radius, b.mean_radius, w)});
  });
}

Shaft polynomial_shaft(const CompositePolynomials& p) {
  if (!(p.length > 0)) throw std::invalid_argument("a shaft needs a length above zero");
  const auto value = [](const std::vector<double>& c, double s) {
    double y = 0;
    for (std::size_t k = c.size(); k-- > 0;) y = y * s + c[k];
    return y;
  };
  Shaft shaft;
  for (int i = 0; i < kStations; ++i) {
    const double s = p.length * i / (kStations - 1);
    shaft.stations.push_back(thin_tube({s, value(p.bending_stiffness, s), value(p.torsional_stiffness, s),
                                        value(p.mass_per_length, s), value(p.mean_radius, s)}));
  }
  return shaft;
}

std::vector<std::string> faults(const Shaft& shaft) {
  std::vector<std::string> out;
  if (shaft.stations.size() < 2) out.emplace_back("a shaft needs at least two stations");
  const auto say = [&](const char* what, double s) {
    std::ostringstream text;
    text << what << " at " << s << " m from the butt";
    out.push_back(text.str());
  };
  for (std::size_t i = 0; i < shaft.stations.size() && out.empty(); ++i) {
    const ShaftStation& s = shaft.stations[i];
    if (i > 0 && !(s.arc_length > shaft.stations[i - 1].arc_length))
      say("the stations of a shaft must run from butt to tip with increasing arc length, which ends", s.arc_length);
    if (!(s.bending_stiffness_y > 0 && s.bending_stiffness_z > 0))
      say("the bending stiffness is not positive", s.arc_length);
    if (!(s.torsional_stiffness > 0)) say("the torsional stiffness is not positive", s.arc_length);
    if (!(s.axial_stiffness > 0 && std::isfinite(s.axial_stiffness)))
      say("the axial stiffness is not positive and finite", s.arc_length);
    if (!(s.shear_stiffness >= 0)) say("the shear stiffness is negative", s.arc_length);
    if (!(s.rotary_inertia_y >= 0 && s.rotary_inertia_z >= 0)) say("a rotary inertia is negative", s.arc_length);
    if (!(s.outer_radius >= 0)) say("the radius is negative", s.arc_length);
    if (!(s.mass_per_length > 0)) say("the mass per length is not positive", s.arc_length);
  }
  if (!(shaft.damping_time >= 0)) out.emplace_back("the damping time of a shaft is not negative");
  return out;
}

Shaft scaled(Shaft shaft, double bending, double torsion) {
  for (ShaftStation& s : shaft.stations) scale(s, bending, torsion);
  return shaft;
}

Shaft scaled_tip(Shaft shaft, double from, double bending, double torsion) {
  const auto after = std::ranges::upper_bound(shaft.stations, from, {}, &ShaftStation::arc_length);
  if (after != shaft.stations.begin() && std::prev(after)->arc_length != from)
    shaft.stations.insert(after, shaft.at(from));
  const double length = shaft.length() - from;
  for (ShaftStation& s : shaft.stations) {
    const double share = std::max(0.0, (s.arc_length - from) / length);
    scale(s, 1 + share * (bending - 1), 1 + share * (torsion - 1));
  }
  return shaft;
}

double balance_point(const Shaft& shaft) {
  double moment = 0;
  for (std::size_t i = 1; i < shaft.stations.size(); ++i) {
    const ShaftStation &a = shaft.stations[i - 1], &b = shaft.stations[i];
    // Exact for a mass per length that is linear between stations.
    moment +=
        (b.arc_length - a.arc_length) / 6 *
        (a.mass_per_length * (2 * a.arc_length + b.arc_length) + b.mass_per_length * (a.arc_length + 2 * b.arc_length));
  }
  return moment / mass(shaft);
}

double mass(const Shaft& shaft) {
  double m = 0;
  for (std::size_t i = 1; i < shaft.stations.size(); ++i)
    m += 0.5 * (shaft.stations[i].mass_per_length + shaft.stations[i - 1].mass_per_length) *
         (shaft.stations[i].arc_length - shaft.stations[i - 1].arc_length);
  return m;
}

std::span<const NamedShaft> shaft_library() { return kLibrary; }

}  // namespace hosel
