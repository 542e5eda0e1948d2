// Shafts from their geometry or their tables, against the integrals that they stand for.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "golf/shaft_library.hpp"
#include "golf/units.hpp"

namespace hosel {
namespace {

/// A wall of three unlike layers on a tube that tapers, with another taper from its middle on: at any place the sums
/// over the layers. Between its 401 stations a property is straight, which leaves an eighth of (1.1 m / 400)^2 of its
/// curvature.
TEST(TubeShaft, EveryPropertyIsTheSumOverItsLayers) {
  const std::vector<TubeStation> tube{{0.1, 8e-3, 2e-3}, {0.7, 6e-3, 1.5e-3}, {1.2, 4e-3, 1.6e-3}};
  const std::vector<ShaftLayer> layers{{0.2, 230e9, 8e9, 1600}, {0.5, 60e9, 25e9, 1500}, {0.3, 130e9, 5e9, 1800}};
  constexpr double kShear = 0.53;
  const Shaft shaft = tube_shaft(tube, layers, kShear);
  ASSERT_TRUE(faults(shaft).empty());
  EXPECT_NEAR(shaft.length(), 1.1, 1e-12) << "counted from the tube's own beginning";
  for (const double s : {0.0, 0.31, 0.55, 0.77, 1.1}) {
    SCOPED_TRACE(s);
    const bool first = s <= 0.6;
    const double w = first ? s / 0.6 : (s - 0.6) / 0.5, radius = first ? 8e-3 - 2e-3 * w : 6e-3 - 2e-3 * w,
                 wall = first ? 2e-3 - 0.5e-3 * w : 1.5e-3 + 0.1e-3 * w;
    double EI = 0, GJ = 0, EA = 0, GA = 0, mass = 0, rotary = 0, share = 0;
    for (const ShaftLayer& l : layers) {
      const double inner = radius - wall + share * wall, outer = inner + l.share * wall;
      const double A = kPi * (outer * outer - inner * inner), fourth = std::pow(outer, 4) - std::pow(inner, 4);
      share += l.share;
      EI += l.E * kPi * fourth / 4;
      GJ += l.G * kPi * fourth / 2;
      EA += l.E * A;
      GA += l.G * A;
      mass += l.density * A;
      rotary += l.density * kPi * fourth / 4;
    }
    const ShaftStation at = shaft.at(s);
    for (const auto& [found, exact] : {std::pair{at.bending_stiffness_y, EI},
                                       {at.bending_stiffness_z, EI},
                                       {at.torsional_stiffness, GJ},
                                       {at.axial_stiffness, EA},
                                       {at.shear_stiffness, kShear * GA},
                                       {at.mass_per_length, mass},
                                       {at.rotary_inertia_y, rotary},
                                       {at.rotary_inertia_z, rotary},
                                       {at.outer_radius, radius}})
      EXPECT_NEAR(found, exact, 2e-5 * exact);
  }
  EXPECT_THROW(tube_shaft(tube, {{0.5, 1e9, 1e9, 1000}, {0.4, 1e9, 1e9, 1000}}, kShear), std::invalid_argument);
}

/// Cubics are met at the 401 stations to the last digits, and their mass and tip deflection to (1/400)^2.
TEST(PolynomialShaft, FollowsItsPolynomials) {
  const CompositePolynomials p{.length = 1.1,
                               .bending_stiffness = {70, -30, 5, -8},
                               .torsional_stiffness = {25, -12, 0, 2},
                               .mass_per_length = {0.07, -0.02, 0.004, 0.001},
                               .mean_radius = {0.0072, -0.003, 1e-4}};
  const Shaft shaft = polynomial_shaft(p);
  ASSERT_TRUE(faults(shaft).empty());
  for (const std::size_t i : {0U, 100U, 300U, 400U}) {
    const double s = 1.1 * double(i) / 400, EI = 70 - 30 * s + 5 * s * s - 8 * s * s * s,
                 GJ = 25 - 12 * s + 2 * s * s * s, m = 0.07 - 0.02 * s + 0.004 * s * s + 0.001 * s * s * s,
                 r = 0.0072 - 0.003 * s + 1e-4 * s * s;
    const ShaftStation& at = shaft.stations.at(i);
    for (const auto& [found, exact] : {std::pair{at.bending_stiffness_y, EI},
                                       {at.bending_stiffness_z, EI},
                                       {at.torsional_stiffness, GJ},
                                       {at.mass_per_length, m},
                                       {at.axial_stiffness, 2 * EI / (r * r)},
                                       {at.shear_stiffness, GJ / (2 * r * r)},
                                       {at.rotary_inertia_y, m * r * r / 2},
                                       {at.rotary_inertia_z, m * r * r / 2},
                                       {at.outer_radius, r}})
      EXPECT_NEAR(found, exact, 1e-12 * exact) << s;
  }
  const double L = 1.1, whole = 0.07 * L - 0.01 * L * L + 0.004 / 3 * L * L * L + 0.00025 * L * L * L * L;
  EXPECT_NEAR(mass(shaft), whole, 1e-5 * whole);
  EXPECT_THROW(polynomial_shaft({}), std::invalid_argument);
  CompositePolynomials crossed = p;
  crossed.mean_radius = {0.0072, -0.009};  // below zero from 0.8 m on
  EXPECT_EQ(faults(polynomial_shaft(crossed)).size(), 1u);
}

/// No station of a shaft may weigh or resist less than nothing.
TEST(Shaft, StationsThatCannotBeAreNamed) {
  const ShaftStation good{.bending_stiffness_y = 40,
                          .bending_stiffness_z = 40,
                          .torsional_stiffness = 20,
                          .axial_stiffness = 1e6,
                          .shear_stiffness = 1e5,
                          .mass_per_length = 0.06,
                          .rotary_inertia_y = 1e-6,
                          .rotary_inertia_z = 1e-6};
  ShaftStation end = good;
  end.arc_length = 1;
  ASSERT_TRUE(faults(Shaft{{good, end}}).empty());
  for (double ShaftStation::*of :
       {&ShaftStation::bending_stiffness_y, &ShaftStation::bending_stiffness_z, &ShaftStation::torsional_stiffness,
        &ShaftStation::axial_stiffness, &ShaftStation::shear_stiffness, &ShaftStation::mass_per_length,
        &ShaftStation::rotary_inertia_y, &ShaftStation::rotary_inertia_z, &ShaftStation::outer_radius}) {
    ShaftStation bad = end;
    bad.*of = -1;
    EXPECT_EQ(faults(Shaft{{good, bad}}).size(), 1u);
  }
}

/// Of a mass per length that is linear from m0 to m1 the centre lies L (m0 + 2 m1) / 3 (m0 + m1) from the butt.
TEST(BalancePoint, OfALinearTaper) {
  constexpr double kLength = 1.1, m0 = 0.08, m1 = 0.03;
  const double exact = kLength * (m0 + 2 * m1) / (3 * (m0 + m1));
  ASSERT_GT(std::abs(exact - kLength / 2), 0.05);
  for (const int pieces : {1, 7}) {
    Shaft shaft;
    for (int i = 0; i <= pieces; ++i) {
      const double w = double(i) / pieces;
      shaft.stations.push_back({.arc_length = w * kLength, .mass_per_length = (1 - w) * m0 + w * m1});
    }
    EXPECT_NEAR(balance_point(shaft), exact, 1e-12) << pieces;
    EXPECT_NEAR(mass(shaft), kLength * (m0 + m1) / 2, 1e-15) << pieces;
  }
}

/// Deflection of the tip under a force there: F int (L - s)^2 / EI ds, by Simpson's rule.
double tip_compliance(const Shaft& shaft) {
  constexpr int kParts = 2000;
  const double L = shaft.length();
  double sum = 0;
  for (int i = 0; i <= kParts; ++i) {
    const double s = L * i / kParts, weight = i == 0 || i == kParts ? 1 : i % 2 ? 4 : 2;
    sum += weight * (L - s) * (L - s) / shaft.at(s).bending_stiffness_y;
  }
  return sum * L / kParts / 3;
}

/// A uniform shaft whose tip is softened from `from` on: EI runs straight there from EI to f EI, so that the tip gives
/// by (L^3 - T^3) / 3 EI before it, T = L - from, and by T^3 / (EI (1 - f)) (1/2 - q (1 - q ln(1 + 1/q))), q = f / (1 -
/// f), in it.
TEST(ScaledTip, SoftensInBetweenAsItSays) {
  constexpr double L = 1.1, EI = 50, GJ = 20, EA = 4e6, GA = 3e5, from = 0.7, bend = 0.4, twist = 1.5;
  Shaft shaft;
  for (const double s : {0.0, 0.3, 0.9, L})
    shaft.stations.push_back({.arc_length = s,
                              .bending_stiffness_y = EI,
                              .bending_stiffness_z = 2 * EI,
                              .torsional_stiffness = GJ,
                              .axial_stiffness = EA,
                              .shear_stiffness = GA,
                              .mass_per_length = 0.06});
  const Shaft soft = scaled_tip(shaft, from, bend, twist);
  for (const double s : {0.0, 0.5, 0.7, 0.8, 0.9, 1.0, L}) {
    const double share = std::max(0.0, (s - from) / (L - from)), b = 1 + share * (bend - 1),
                 t = 1 + share * (twist - 1);
    const ShaftStation at = soft.at(s);
    EXPECT_NEAR(at.bending_stiffness_y, b * EI, 1e-12 * EI) << s;
    EXPECT_NEAR(at.bending_stiffness_z, b * 2 * EI, 1e-12 * EI) << s;
    EXPECT_NEAR(at.axial_stiffness, b * EA, 1e-12 * EA) << s;
    EXPECT_NEAR(at.torsional_stiffness, t * GJ, 1e-12 * GJ) << s;
    EXPECT_NEAR(at.shear_stiffness, t * GA, 1e-12 * GA) << s;
    EXPECT_NEAR(at.mass_per_length, 0.06, 1e-15) << s;
  }
  const double T = L - from, q = bend / (1 - bend);
  const double exact = (L * L * L - T * T * T) / (3 * EI) +
                       T * T * T / (EI * (1 - bend)) * (0.5 - q * (1 - q * std::log(1 + 1 / q)));
  EXPECT_NEAR(tip_compliance(shaft), L * L * L / (3 * EI), 1e-9);
  EXPECT_NEAR(tip_compliance(soft), exact, 1e-6 * exact);
  ASSERT_GT(exact, 1.005 * L * L * L / (3 * EI)) << "the tip is felt";
}

}  // namespace
/// What is said of a shaft's mass is the mass that it has.
TEST(ShaftLibrary, AShaftWeighsWhatIsSaidOfIt) {
  for (const NamedShaft& shaft : shaft_library()) {
    std::smatch said;
    const std::string text(shaft.what);
    ASSERT_TRUE(std::regex_search(text, said, std::regex("([0-9]+) g"))) << text;
    EXPECT_NEAR(1e3 * mass(shaft.make()), std::stod(said[1]), 0.5) << text;
  }
}

}  // namespace hosel
