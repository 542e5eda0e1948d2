// Oblique impact of elastic spheres on a rigid wall: finite-sphere and peer references; the full table is in the
// case elastic-oblique.
#include <gtest/gtest.h>

#include "tests/support/elastic_sphere.hpp"

namespace hosel::models {
namespace {

/// Linear elastic, E = 100 MPa, nu = 0.49, a/R = 0.079: five to six elements across the patch.
FeImpactOptions small_contact() {
  FeImpactOptions o;
  o.ball = elastic_ball("sphere", {.elastic = fem::LinearElastic{fem::Lame::of(100e6, .49)}, .branches = {}, .density = 1129});
  o.friction = 0.1;
  o.harmonics = 2;
  o.mesh = {.sector = 5, .rings = 6, .pole = .045, .far = 3, .skin = .05, .core = .4};
  o.penalty = 3000;
  o.tangential_penalty = 1;
  o.steps_per_contact = 80;
  return o;
}

/// psi = kappa / mu times the tangential speed of the contact point over the normal speed of approach.
double psi_after(const test::Bounce& b, double v_n) { return 2 * .51 / 1.51 / .1 * (b.v_t - b.rim) / v_n; }

TEST(ObliqueSphere, TangentialRebound) {
  constexpr double v_n = 0.3, kappa = 2 * .51 / 1.51;
  for (const auto& [psi, expected] : {std::pair{1.0, -.584}, {5.0, .290}}) {
    const test::Bounce b = test::bounce(small_contact(), v_n, psi * .1 / kappa * v_n);
    ASSERT_GT(b.peak_force, 35);
    EXPECT_NEAR(psi_after(b, v_n), expected, .03);
    EXPECT_LE(b.friction_ratio, .1 * (1 + 1e-9));
    if (psi < 4.5) {
      EXPECT_GT(b.push, .1 * b.pull);  // the force reverses: the grip
    } else {
      // Gross slip: friction throughout. What is missing is the patch's own radial slip.
      EXPECT_EQ(b.push, 0);
      EXPECT_NEAR(b.impulse_ratio, .1, .1 * 2e-3);
    }
    EXPECT_LT(std::abs(b.closure), 1e-3);
  }
}

}  // namespace
}  // namespace hosel::models
