// The response surface against a model that is quick enough to be asked everywhere.
#include "hosel/models/response_surface.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hosel/models/registry.hpp"

namespace hosel::models {
namespace {

TEST(ResponseSurface, PredictsWhatItWasNotAskedWithinItsStatedError) {
  Blow blow;
  blow.club.head = {
      .mass = 0.2, .cg = Vec3(-0.035, 0, 0), .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(), .face = {0.3, 0.3}};
  blow.contact.tangential_restitution = 0.3;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto draw = [&] {
    return Delivery{.club_speed = 45 + 5 * u(random),
                    .attack_angle = 0.05 * u(random),
                    .club_path = 0.06 * u(random),
                    .dynamic_loft = 0.24 + 0.08 * u(random),
                    .face_angle = 0.05 * u(random),
                    .impact_toe = 0.02 * u(random),
                    .impact_high = 0.012 * u(random)};
  };
  std::vector<Delivery> asked, fresh;
  for (int i = 0; i < 90; ++i) asked.push_back(draw());
  for (int i = 0; i < 40; ++i) fresh.push_back(draw());
  const auto slow = find("stick-slip")->make({});
  const ResponseSurface quick(*slow, blow, asked);
  double speed = 0, spin = 0, before = 0;
  for (const Delivery& d : fresh) {
    blow.delivery = d;
    const Launch truth = slow->launch(blow), guess = quick.launch(blow);
    speed += (truth.velocity - guess.velocity).squaredNorm() / 40;
    spin += (truth.spin - guess.spin).squaredNorm() / 40;
    before += (truth.spin - find("rigid-eccentric")->make({})->launch(blow).spin).squaredNorm() / 40;
  }
  EXPECT_LT(std::sqrt(speed), 1.6 * quick.error().head<3>().norm() + 1e-9);
  EXPECT_LT(std::sqrt(spin), 1.6 * quick.error().segment<3>(3).norm() + 1e-9);
  EXPECT_LT(quick.error().segment<3>(3).norm(), 1.0);    // rad/s, 10 rpm
  EXPECT_GT(std::sqrt(before), 1e-6 * std::sqrt(spin));  // the two models do differ
}

}  // namespace
}  // namespace hosel::models
