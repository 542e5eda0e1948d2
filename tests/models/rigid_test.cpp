// The closed-form base models against their published and independently computed values.
#include <gtest/gtest.h>

#include <array>
#include <ostream>

#include "golf/first_contact.hpp"
#include "golf/units.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "models/rigid/rigid_planar.hpp"

namespace hosel::models {
namespace {

Head head_a() {
  Head h;
  h.mass = 0.2;
  h.cg = {-0.035, 0, 0};
  h.inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal();
  h.face = {0.3, 0.3};
  return h;
}

Head head_b() {
  Head h = head_a();
  h.cg = {-0.038, 0.003, 0.004};
  h.inertia << 2.9e-4, -2e-5, 3e-5, -2e-5, 4.1e-4, 1e-5, 3e-5, 1e-5, 5.6e-4;
  return h;
}

Blow blow(const Head& head, double speed, double attack, double path, double face, double loft, double toe,
          double high) {
  Blow b;
  b.club.head = head;
  b.delivery = {.club_speed = speed,
                .attack_angle = radians(attack),
                .club_path = radians(path),
                .dynamic_loft = radians(loft),
                .face_angle = radians(face),
                .impact_toe = toe * 1e-3,
                .impact_high = high * 1e-3};
  return b;
}

struct Row {
  char head;
  double speed, attack, path, face, loft, toe, high;
  std::array<double, 6> expected;  // m/s, deg, deg, rpm, rpm, rpm
};
void PrintTo(const Row& r, std::ostream* out) { *out << r.head << ' ' << r.toe << ' ' << r.high; }

class Eccentric : public testing::TestWithParam<Row> {};

TEST_P(Eccentric, ReferenceRow) {
  const Row& row = GetParam();
  const Launch l = RigidEccentric().launch(blow(row.head == 'A' ? head_a() : head_b(), row.speed, row.attack, row.path,
                                                row.face, row.loft, row.toe, row.high));
  const std::array got = {l.ball_speed(),    degrees(l.launch_angle()), degrees(l.azimuth()),
                          rpm(l.backspin()), rpm(l.sidespin()),         rpm(l.riflespin())};
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(got[i], row.expected[i], 1e-6 * std::max(1.0, std::abs(row.expected[i]))) << "value " << i;
}

// Computed by a program that shares no code with this one, printed to 1e-7 or 1e-5.
INSTANTIATE_TEST_SUITE_P(
    Reference, Eccentric,
    testing::Values(
        Row{'A', 50, 0, 0, 0, 10, 0, 0, {68.7996625, 8.1568547, 0, 2476.09382, 0, 0}},
        Row{'A', 50, 3, 0, 0, 13, 0, 0, {68.7996625, 11.1568547, 0, 2476.09382, 0, 0}},
        Row{'A', 50, 0, 0, 0, 10, 20, 0, {67.0417009, 8.1044535, 4.0202226, 2444.23816, -188.28558, -198.66279}},
        Row{'A', 50, 0, 0, 0, 10, -20, 0, {67.0417009, 8.1044535, -4.0202226, 2444.23816, 188.28558, 198.66279}},
        Row{'A', 50, 0, 0, 0, 12, 0, 10, {67.1318532, 12.0128637, 0, 2485.70699, 0, 0}},
        Row{'A', 50, 0, 0, 0, 12, 0, -10, {68.2542186, 7.4994374, 0, 3453.13610, 0, 0}},
        Row{'A', 50, -1, 4, -2, 11, 0, 0, {68.0572782, 8.7779367, -0.8427541, 2958.08862, -1492.09525, -186.91199}},
        Row{'A', 42, -3, -3, 3, 14, 12, -6, {56.1572111, 9.4649126, 4.2558819, 3709.46885, 1152.83596, -83.31975}},
        Row{'B', 46, 2, 2, -1, 12, 8, 5, {63.1286855, 10.9169153, 1.3165128, 2502.76664, -884.02101, -228.06872}}));

TEST(RigidPlanar, CoefficientOfTheSecondSource) {
  Blow b;
  b.club.head.mass = 0.286;
  b.delivery.club_speed = 36.65728;
  for (double loft : {10.0, 20.0, 45.0}) {
    b.delivery.dynamic_loft = radians(loft);
    const Launch l = RigidPlanar().launch(b);
    EXPECT_NEAR(rpm(l.backspin()), 11205.4001 * std::sin(radians(loft)), 2e-4);
  }
}

struct ClubRow {
  const char* club;
  double mass, mph, attack, loft, spin, launch, speed_mph;
};
void PrintTo(const ClubRow& c, std::ostream* out) { *out << c.club; }
class SevenIrons : public testing::TestWithParam<ClubRow> {};

TEST_P(SevenIrons, BenchmarkTable) {
  const ClubRow& c = GetParam();
  Blow b;
  b.club.head.mass = c.mass;
  b.delivery.club_speed = c.mph * kMpsPerMph;
  b.delivery.attack_angle = radians(c.attack);
  b.delivery.dynamic_loft = radians(c.loft);
  const Launch l = RigidPlanar().launch(b);
  EXPECT_NEAR(rpm(l.backspin()), c.spin, 0.05);
  EXPECT_NEAR(degrees(l.launch_angle()), c.launch, 5e-4);
  EXPECT_NEAR(l.ball_speed() / kMpsPerMph, c.speed_mph, 5e-3);
}

// [@rolling-irons]; lofts are the means of the shots (the printed five digits are rounded).
INSTANTIATE_TEST_SUITE_P(Benchmark, SevenIrons,
                         testing::Values(ClubRow{"4i", 0.2451, 82.8, -1.3, 12.775, 2731.6, 10.142, 118.89},
                                         ClubRow{"5i", 0.2498, 81.5, -1.8, 16.0833333333, 3398.4, 12.710, 115.47},
                                         ClubRow{"6i", 0.2581, 81.9, -1.2, 18.84, 3817.0, 15.043, 115.23},
                                         ClubRow{"7i", 0.2643, 82.2, -1.9, 22.06, 4545.2, 17.455, 113.17},
                                         ClubRow{"8i", 0.2705, 82.4, -2.1, 25.275, 5164.5, 19.933, 110.89},
                                         ClubRow{"9i", 0.281, 81.9, -2.7, 28.325, 5763.9, 22.162, 107.33},
                                         ClubRow{"PW", 0.2865, 82, -2.5, 32.5, 6427.6, 25.364, 103.44}));

TEST(RigidEccentric, ReducesToPlanarForInfiniteInertiaAndFlatFace) {
  Head h;
  h.mass = 0.26;
  h.cg = {-0.02, 0.01, 0.005};
  h.inertia = 1e30 * Mat3::Identity();
  for (double et : {0.0, 0.3})
    for (double offset : {0.0, 0.05}) {
      Blow b = blow(h, 40, -3, 0, 0, 25, 0, 0);
      b.contact.tangential_restitution = et;
      b.contact.normal_force_offset = offset;
      const Launch p = RigidPlanar().launch(b), e = RigidEccentric().launch(b);
      EXPECT_LT((p.velocity - e.velocity).norm(), 1e-12 * p.ball_speed());
      EXPECT_LT((p.spin - e.spin).norm(), 1e-12 * p.spin_rate());
    }
}

TEST(RigidEccentric, FrictionLimitSlides) {
  Blow b = blow(head_a(), 45, 0, 0, 0, 60, 0, 0);
  b.contact.friction = 0.1;
  const Launch l = RigidEccentric().launch(b);
  const Vec3 n = first_contact(b).normal;
  const Vec3 J = b.ball.mass * l.velocity;
  const double Jn = J.dot(n);
  EXPECT_NEAR((J - Jn * n).norm(), 0.1 * Jn, 1e-12 * Jn);
}

}  // namespace
}  // namespace hosel::models
