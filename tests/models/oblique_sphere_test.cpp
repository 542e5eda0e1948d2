// Oblique impact of elastic spheres on a rigid wall: finite-sphere and peer references; the full table is in the
// case elastic-oblique.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "fem/materials/linear_elastic.hpp"
#include "tests/support/elastic_sphere.hpp"

namespace hosel::models {
namespace {

/// Linear elastic, E = 100 MPa, nu = 0.49, a/R = 0.079: some eight elements across the patch's radius and five below it
/// to that depth, of even size out to beyond its edge, where stick turns to slip.
FeImpactOptions small_contact() {
  FeImpactOptions o;
  o.ball = elastic_ball("sphere",
                        {.elastic = fem::LinearElastic{fem::Lame::of(100e6, .49)}, .branches = {}, .density = 1129});
  o.harmonics = 2;
  o.mesh = {.sector = 10, .rings = 12, .pole = .11, .far = 6, .skin = .05, .core = .4};
  o.penalty = 1600;
  o.tangential_penalty = 1;
  o.steps_per_contact = 60;
  o.newton_relative = 1e-5;
  return o;
}

/// psi = kappa / mu times the tangential speed of the contact point over the normal speed of approach: before, after.
struct Rebound {
  double before, after;
  double grip;  ///< at least this much of the largest pull comes back as a push
};
void PrintTo(const Rebound& r, std::ostream* out) { *out << r.before; }

class ObliqueSphere : public testing::TestWithParam<Rebound> {};

TEST_P(ObliqueSphere, TangentialRebound) {
  constexpr double v_n = 0.3, kappa = 2 * .51 / 1.51, friction = .1;
  const auto [psi, expected, grip] = GetParam();
  const test::Bounce b = test::bounce(small_contact(), v_n, psi * friction / kappa * v_n, friction);
  ASSERT_GT(b.peak_force, 35);
  EXPECT_NEAR(kappa / friction * (b.v_t - b.rim) / v_n, expected, .03);
  EXPECT_LE(b.friction_ratio, friction * (1 + 1e-9));
  if (psi < 4.5) {
    EXPECT_GT(b.push, grip * b.pull);  // the force reverses
  } else {
    // Gross slip: friction throughout. What is missing is the patch's own radial slip.
    EXPECT_EQ(b.push, 0);
    EXPECT_NEAR(b.impulse_ratio, friction, friction * 2e-3);
  }
  EXPECT_LT(std::abs(b.closure), 1e-3);
}
INSTANTIATE_TEST_SUITE_P(FourierBall, ObliqueSphere,
                         testing::Values(Rebound{1, -.584, .1}, Rebound{2, -1.360, .1}, Rebound{3, -1.483, .03},
                                         Rebound{5, .290, 0}),
                         [](const auto& info) { return "Psi" + std::to_string(int(info.param.before)); });

/// a/R = 0.0125 on 21,000 unknowns, 3 mm/s: what residual is left at the first touch is the round-off of all of them.
/// The whole blow is bench_oblique_sphere's.
TEST(SmallPatch, AFineMeshTouchesSlowly) {
  FeImpactOptions o = small_contact();
  o.mesh = {.sector = 10, .rings = 17, .pole = .018, .far = 30, .skin = .008};
  o.penalty = 10000;
  Blow blow;
  blow.club.head.mass = INFINITY;
  blow.contact.patch.coefficient = .1;
  blow.delivery.club_speed = .003;
  blow.delivery.club_path = std::atan(.1 * 1.51 / 1.02);
  struct Enough {};
  double force = 0;
  EXPECT_THROW(Impact(o).run(blow,
                             [&](const ImpactView& view) {
                               force = view.report.normal_force;
                               if (view.state.time > 2e-5) throw Enough();
                             }),
               Enough);
  EXPECT_GT(force, 1e-4);
}

}  // namespace
}  // namespace hosel::models
