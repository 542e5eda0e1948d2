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

/// Pulled half way to sliding: stick within, slip around it. The resultants are those of the stations.
TEST(TractionField, FrictionOfAPulledSphere) {
  const test::Pressed p =
      test::press({.nu = .49, .approach = .094, .mesh = of(3), .harmonics = 4, .friction = .3, .pull = .05});
  ASSERT_GT(p.friction_ratio, .3);
  ASSERT_LT(p.friction_ratio, .9);
  EXPECT_LT(p.force_off, 1e-3);
  EXPECT_LT(p.moment_off, 1e-3);
  EXPECT_LT(p.field.friction, .5 * p.stations.friction);
}

}  // namespace
}  // namespace hosel::fem
