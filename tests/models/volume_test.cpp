// The overlap of ball and face: closed form against quadrature and finite differences.
#include "models/reduced/volume.hpp"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "golf/lanes.hpp"
#include "golf/units.hpp"

namespace hosel::models {
namespace {

constexpr double r = 0.0213;

struct Integrals {
  double volume = 0, moment = 0;
};

/// Discs across the line of centres, at t beyond the face's vertex: the smaller of the two spheres'
/// sections, cut where they are equal.
Integrals by_discs(double depth, double curvature) {
  const double R = curvature > 0 ? 1 / curvature : INFINITY;
  const auto ball_section = [&](double t) { return std::max(0.0, (depth - t) * (2 * r - depth + t)); };
  const auto face_section = [&](double t) { return t >= 0 ? std::max(0.0, t * (2 * R - t)) : 0.0; };
  const auto section = [&](double t) { return kPi * std::min(ball_section(t), face_section(t)); };
  using G = boost::math::quadrature::gauss_kronrod<double, 61>;
  const double low = std::max(0.0, depth - 2 * r), high = std::min(depth, 2 * R);
  if (!(high > low)) return {};
  const double equal = std::isinf(R) ? low : depth * (2 * r - depth) / (2 * (R + r - depth));
  const double cut = equal > low && equal < high ? equal : low;
  Integrals out;
  for (const auto& [from, to] : {std::pair{low, cut}, std::pair{cut, high}})
    if (to > from) {
      out.volume += G::integrate(section, from, to, 5, 1e-15);
      out.moment += G::integrate([&](double t) { return (r - depth + t) * section(t); }, from, to, 5, 1e-15);
    }
  return out;
}

class OverlapOf : public testing::TestWithParam<double> {};  // face radius [m]

TEST_P(OverlapOf, QuadratureAndDifferences) {
  const double R = GetParam(), c = 1 / R;
  const double contained = 2 * std::min(r, R);
  int overlapping = 0;
  for (const double share : {1e-3, 0.05, 0.15, 0.3, 0.5, 0.8, 0.97}) {
    const double d = share * contained;
    const Overlap o = overlap(d, r, c);
    const Integrals q = by_discs(d, c);
    ++overlapping;
    EXPECT_GT(o.volume, 0);
    EXPECT_NEAR(o.volume, q.volume, 1e-12 * q.volume) << "R " << R << " depth " << d;
    EXPECT_NEAR(o.centroid, q.moment / q.volume, 1e-12 * r);
    const double h = 1e-4 * std::min(d, contained - d);
    const double slope = (8 * (overlap(d + h, r, c).volume - overlap(d - h, r, c).volume) -
                          (overlap(d + 2 * h, r, c).volume - overlap(d - 2 * h, r, c).volume)) /
                         (12 * h);
    EXPECT_NEAR(o.area, slope, 1e-7 * o.area);
    const double energy = (overlap_potential(d + h, r, c) - overlap_potential(d - h, r, c)) / (2 * h);
    EXPECT_NEAR(energy, o.volume, 1e-7 * o.volume);
    const double flat = (overlap_potential(d + h, r, c, 0.6) - overlap_potential(d - h, r, c, 0.6)) / (2 * h);
    EXPECT_NEAR(flat, powered(o.volume, 0.6), 1e-6 * flat);  // the rule's error where the power sets in
  }
  EXPECT_EQ(overlapping, 7);
}

TEST_P(OverlapOf, SeparateAndContained) {
  const double R = GetParam(), c = 1 / R, small = std::min(r, R);
  for (const double d : {-1e-3, 0.0}) {
    EXPECT_EQ(overlap(d, r, c).volume, 0);
    EXPECT_EQ(overlap(d, r, c).area, 0);
    EXPECT_EQ(overlap_potential(d, r, c), 0);
  }
  const double whole = 4.0 / 3.0 * kPi * std::pow(small, 3);
  for (const double d : {2 * small, std::min(2.3 * small, r + R)}) {
    EXPECT_NEAR(overlap(d, r, c).volume, whole, 1e-14 * whole);
    EXPECT_EQ(overlap(d, r, c).area, 0);
    EXPECT_NEAR(by_discs(d, c).volume, whole, 1e-12 * whole);
  }
  // Volume and slope are continuous into both neighbours.
  EXPECT_NEAR(overlap(2 * small * (1 - 1e-9), r, c).volume, whole, 1e-12 * whole);
  EXPECT_LT(overlap(2 * small * (1 - 1e-9), r, c).area, 1e-6 * small * small);
}

INSTANTIATE_TEST_SUITE_P(Faces, OverlapOf, testing::Values(INFINITY, 0.305, 0.05, 0.02, 0.008),
                         [](const auto& i) { return "Face" + std::to_string(i.index); });

TEST(Overlap, LongFormOfTheLens) {
  const double R = 0.305, d = 6.4e-3, a = r + R - d, s = r + R - a;
  const double lens = kPi * s * s * (a * a + 2 * a * (r + R) - 3 * (r - R) * (r - R)) / (12 * a);
  EXPECT_NEAR(overlap(d, r, 1 / R).volume, lens, 1e-11 * lens);
}

/// Separate, overlapping and contained side by side, in a small and in a wide face.
TEST(Volume, LanesAreTheNumbers) {
  for (const double c : {1 / 0.3, 1 / 0.01, 0.0}) {
    Pack depth;
    for (int l = 0; l < kLanes; ++l) set_lane(depth, l, 0.015 * (l - 0.7));
    const auto four = overlap(depth, Pack(r), Pack(c));
    const Pack power = powered(four.volume, 0.6);
    for (int l = 0; l < kLanes; ++l) {
      const Overlap one = overlap(lane(depth, l), r, c);
      EXPECT_EQ(one.volume > 0, l > 0);
      EXPECT_DOUBLE_EQ(lane(four.volume, l), one.volume);
      EXPECT_DOUBLE_EQ(lane(four.area, l), one.area);
      EXPECT_DOUBLE_EQ(lane(four.centroid, l), one.centroid);
      EXPECT_NEAR(lane(power, l), powered(one.volume, 0.6), 1e-14 * powered(one.volume, 0.6));
    }
  }
}

}  // namespace
}  // namespace hosel::models
