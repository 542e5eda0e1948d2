/// Shafts: built from geometry or polynomials, and a few by name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "golf/shaft.hpp"

namespace hosel {

/// One layer of a tube's wall.
struct ShaftLayer {
  double share = 1;     ///< of the wall, inside outwards; the shares of a wall add up to 1
  double E = 0, G = 0;  ///< along the shaft, and in shear [Pa]
  double density = 0;   ///< [kg/m^3]
};

struct TubeStation {
  double arc_length = 0;    ///< from the butt [m]
  double outer_radius = 0;  ///< [m]
  double wall = 0;          ///< [m]
};

/// A round tube whose radius and wall run linearly between stations. Every property is the integral over
/// the wall's layers; the shear factor (0.5 for a thin tube, G. R. Cowper, J. Appl. Mech. 33 (1966)
/// 335-340, within a few per cent) is stated by the caller.
Shaft tube_shaft(const std::vector<TubeStation>& tube, const std::vector<ShaftLayer>& layers, double shear_factor);

/// A thin round composite tube known by its bending and torsional stiffness, mass and radius at stations:
/// EA = 2 EI / r^2, kappa GA = GJ / (2 r^2), rho I = rho A r^2 / 2.
struct CompositeStation {
  double arc_length = 0;           ///< from the butt [m]
  double bending_stiffness = 0;    ///< EI [N m^2]
  double torsional_stiffness = 0;  ///< GJ [N m^2]
  double mass_per_length = 0;      ///< [kg/m]
  double mean_radius = 0;          ///< of the wall [m]
};
Shaft composite_shaft(const std::vector<CompositeStation>& stations);

/// As composite_shaft, from cubic polynomials c0 + c1 s + c2 s^2 + c3 s^3 of the arc length s [m].
struct CompositePolynomials {
  double length = 0;
  std::vector<double> bending_stiffness, torsional_stiffness, mass_per_length, mean_radius;
};
Shaft polynomial_shaft(const CompositePolynomials& p);

/// Sentences naming what no shaft can have (order of stations, stiffness or mass not positive, inertia or radius
/// negative); empty if all is well.
std::vector<std::string> faults(const Shaft& shaft);

/// Bending and axial stiffness multiplied by `bending`, torsional and shear stiffness by `torsion`.
Shaft scaled(Shaft shaft, double bending, double torsion);

/// Stiffness as `scaled` does, by factors that grow linearly from 1 at `from` [m from the butt] to these at the tip.
/// `from` lies inside the shaft and becomes a station.
Shaft scaled_tip(Shaft shaft, double from, double bending, double torsion);

double mass(const Shaft& shaft);           ///< [kg]
double balance_point(const Shaft& shaft);  ///< distance of the centre of mass from the butt, along the axis [m]

struct NamedShaft {
  std::string_view name;
  std::string_view what;  ///< one sentence for `hosel list`
  Shaft (*make)();
};
std::span<const NamedShaft> shaft_library();

}  // namespace hosel
