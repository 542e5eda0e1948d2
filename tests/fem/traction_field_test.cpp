// Pressure and friction over the patch as fields, against the exact pressure of a squeezed sphere and against Cattaneo
// and Mindlin. bench_traction has the tables.
#include "fem/traction_field.hpp"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/pressed_sphere.hpp"

namespace hosel::fem {
namespace {

/// The mesh of an accuracy: 2 sectors `look`, 3 `default`, 4 `reference`.
mesh::MeridianOptions of(int sector) {
  mesh::MeridianOptions mesh;
  mesh.sector = mesh.rings = sector;
  return mesh;
}

/// A patch of a golf blow has three tenths of the ball's radius or more. Stations are off by what the elements leave
/// undetermined; the field's error is that of force and second moments.
TEST(TractionField, PressureOfASqueezedSphere) {
  double stations = 0;
  std::map<int, double> mean;  // square of the field's error, by sectors
  for (const double nu : {.3, .49})
    for (const int sector : {2, 3, 4, 6})
      for (const double approach : {.094, .16, .2}) {
        const test::Pressed p = test::press({.nu = nu, .approach = approach, .mesh = of(sector)});
        ASSERT_GT(p.radius, .3);
        ASSERT_GT(p.edges, 1.5);
        if (sector >= 3) { EXPECT_LT(p.field.pressure, .03) << nu << " " << approach << " " << sector; }
        // The test sums over 200 rings, which is good to some 2e-4.
        EXPECT_LT(p.force_off, 1e-3) << nu << " " << approach << " " << sector;
        stations = std::max(stations, p.stations.pressure);
        mean[sector] += p.field.pressure * p.field.pressure / 6;
      }
  EXPECT_GT(stations, .3);  // what the field is there for
  // Single errors depend on how much of the last edge touches; over six of them, half the size of elements halves them.
  EXPECT_LT(std::sqrt(mean[6]), .5 * std::sqrt(mean[3]));
}

/// Pulled a third and two thirds of the way to sliding, and until it slides: the resultants are those of the stations.
/// Friction is off by what the mesh leaves of its polar moment, which decides how far the stick zone reaches; that
/// falls with the mesh.
TEST(TractionField, FrictionOfAPulledSphere) {
  const auto pulled = [](int sector, double pull) {
    const test::Pressed p =
        test::press({.nu = .49, .approach = .094, .mesh = of(sector), .harmonics = 4, .friction = .3, .pull = pull});
    EXPECT_GT(p.radius, .3);
    EXPECT_LT(p.force_off, 1e-3);
    EXPECT_LT(p.moment_off, 1e-3);
    EXPECT_LT(p.field.friction, .2 * p.stations.friction);
    return p;
  };
  const test::Pressed sticks = pulled(3, .04), half = pulled(3, .08), slides = pulled(3, .12), finer = pulled(6, .04);
  ASSERT_NEAR(sticks.friction_ratio, .36, .02);
  ASSERT_NEAR(half.friction_ratio, .7, .02);
  ASSERT_GT(slides.friction_ratio, .95);
  EXPECT_LT(half.field.friction, .08);
  EXPECT_LT(slides.field.friction, .08);
  EXPECT_LT(finer.field.friction, .5 * sticks.field.friction);
}

/// Slid one way, then turned round from the rim inwards (Mindlin and Deresiewicz): -p beyond b, and within it the patch
/// still drags as before. Stations as dense as a grid: what is left is the field's own error.
TEST(TractionField, FrictionThatTurnsRound) {
  constexpr double R = .02, radius = .3 * R, mu = .3, peak = 3e7;
  DofMap map;
  const mesh::Meridian meridian = mesh::sphere_meridian({R}, of(2));
  const HarmonicSolid ball(
      map, meridian, axisymmetric_basis(), SolidQuadrature{single_angle(), 2},
      std::vector<Solid>{Solid{.elastic = LinearElastic{Lame::of(1e8, .49)}, .branches = {}, .density = 1129}},
      Placement{});
  for (const double b : {.9, .7, .55}) {
    const auto friction = [&](double r) {
      const double inner = b * b - r * r;
      return mu * peak * (-std::sqrt(std::max(0.0, 1 - r * r)) + 2 * std::sqrt(std::max(0.0, inner)));
    };
    std::vector<ContactPoint> points;
    constexpr int kRings = 100, kRays = 24;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kRays; ++j) {
        const double r = (i + .5) / kRings, at = radius * r, phi = 2 * kPi * (j + .5) / kRays;
        const double height = std::sqrt(R * R - at * at);
        ContactPoint p;
        p.reference = Vec3(height, at * std::cos(phi), at * std::sin(phi));
        p.angle = phi;
        p.area = 2 * kPi * at * radius / kRings / kRays * R / height;
        p.pressure = peak * std::sqrt(1 - r * r);
        p.push = Vec3(-p.pressure, 0, 0);
        p.traction = p.push + Vec3(0, friction(r), 0);
        points.push_back(p);
      }
    const TractionField field(ball, points);
    double off = 0, all = 0, rim = 0, middle = 0;
    for (const ContactPoint& p : points) {
      const Vec3 acts = field.at(p.reference).tangential, was = p.traction - p.push;
      off += p.area * (acts - was).squaredNorm();
      all += p.area * was.squaredNorm();
      rim = std::min(rim, acts.y());
      middle = std::max(middle, acts.y());
    }
    EXPECT_LT(rim, 0) << b;  // turned round there alone
    EXPECT_GT(middle, 0) << b;
    EXPECT_LT(std::sqrt(off / all), .04) << b;
  }
}

}  // namespace
}  // namespace hosel::fem
