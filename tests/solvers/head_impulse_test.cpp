// [@head-impulse]: the shaft's influence in its purest form. The head of B3 on the clamped shaft is
// struck along -z by a half sine of 0.45 ms and 2.9 N s; what the shaft takes from the free head's
// motion is compared with the modal solution (linear, exact).
#include <gtest/gtest.h>

#include <ostream>

#include "solvers/generalized_alpha.hpp"
#include "tests/support/beams.hpp"

namespace hosel::test {
namespace {

struct Blow {
  double dy, vz;        // m, m/s
  Vec3 attached, free;  // rad/s
};
void PrintTo(const Blow& b, std::ostream* out) { *out << b.dy; }

class HeadImpulse : public testing::TestWithParam<Blow> {};

TEST_P(HeadImpulse, AttachedMinusFreeToOnePercent) {
  const Blow& blow = GetParam();
  constexpr double T = 0.45e-3, impulse = 2.9;
  constexpr double scale = 1e-3;  // the reference is linear: a thousandth of the blow, scaled back
  BeamSystem b(mesh::straight(mesh::graded(1, 40, 0.96), Vec3::Zero(), Mat3::Identity()), b2(Theory::timoshenko));
  b.clamp_first();
  fem::RigidBodyProperties head{.mass = 0.2, .offset = {0.02, 0.035, 0.015}};
  head.inertia << 4.6e-4, 1e-5, 3e-5, 1e-5, 2.2e-4, -1.5e-5, 3e-5, -1.5e-5, 2.9e-4;
  auto owned = std::make_unique<fem::RigidBody>("head", b.tip().translation, b.tip().rotation, head);
  const fem::RigidBody& body = *owned;
  b.system.terms.push_back(std::move(owned));
  const Vec3 arm = head.offset + Vec3(0, blow.dy, 0.035);
  b.load(b.tip(), [&](double t) {
    const Vec3 f(0, 0, -scale * impulse * kPi / (2 * T) * std::sin(kPi * t / T));
    return fem::Wrench{f, arm.cross(f)};
  });
  solvers::GeneralizedAlpha scheme(
      b.system, {.rho_inf = 0.9, .newton = tight(), .step_max = T / 100, .step_min = T / 1e4}, b.rest);
  while (scheme.time() < T * (1 - 1e-12)) scheme.advance(T);

  const double vz = body.velocity(scheme.state()).z() / scale;
  const Vec3 w = body.angular_velocity(scheme.state()) / scale;
  const double taken = blow.vz + 14.5;
  EXPECT_NEAR(vz, blow.vz, 0.01 * std::abs(taken));
  for (int i = 0; i < 3; ++i) {
    const double difference = blow.attached[i] - blow.free[i];
    EXPECT_NEAR(w[i], blow.attached[i], 0.01 * std::abs(difference)) << "w" << i;
  }
  RecordProperty("vz", std::to_string((vz - blow.vz) / taken));
}

INSTANTIATE_TEST_SUITE_P(Benchmark, HeadImpulse,
                         testing::Values(Blow{0, -13.95695, {-9.037, 27.937, 4.050}, {0, 0, 0}},
                                         Blow{0.02, -14.13768, {-131.552, 25.723, 9.383}, {-127.113, 6.698, 13.496}},
                                         Blow{-0.02, -13.77621, {113.479, 30.151, -1.283}, {127.113, -6.698, -13.496}}),
                         [](const auto& of) {
                           return std::string(of.param.dy > 0 ? "Above" : of.param.dy < 0 ? "Below" : "Central");
                         });

}  // namespace
}  // namespace hosel::test
