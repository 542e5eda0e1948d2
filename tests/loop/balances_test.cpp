// One impulse gives the ball velocity and spin: what of a residual some impulse mends, and what none does.
#include "loop/shots/balances.hpp"

#include <gtest/gtest.h>

#include <random>

#include "loop/likeness.hpp"
#include "models/registry.hpp"

namespace hosel::loop {
namespace {

/// Shots of a head that the model knows, measured with small noise; the truth's ball and contact as given.
Balance of(double tangential, double inertia_factor, double loft_error) {
  std::mt19937 random(4);
  std::normal_distribution<double> gauss;
  const auto model = models::find("rigid-eccentric")->make({});
  std::vector<ShotChannel> channels = {
      {{.name = "ball_speed_mps", .noise = 0.05}, Output::ball_speed},
      {{.name = "launch_angle_deg", .si = radians(1), .noise = 0.04}, Output::launch_angle},
      {{.name = "azimuth_deg", .si = radians(1), .noise = 0.05}, Output::azimuth},
      {{.name = "backspin_rpm", .si = kRadPerSecPerRpm, .noise = 12}, Output::backspin},
      {{.name = "sidespin_rpm", .si = kRadPerSecPerRpm, .noise = 12}, Output::sidespin}};
  std::vector<Shot> trials;
  Eigen::MatrixXd measured(60, 5);
  for (int i = 0; i < 60; ++i) {
    Shot t;
    t.blow.club.head = {.mass = 0.2,
                        .cg = Vec3(-0.035, 0, 0),
                        .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(),
                        .face = {0.3, 0.3}};
    t.blow.delivery = {.club_speed = 45 + 3 * gauss(random),
                       .club_path = radians(2 * gauss(random)),
                       .dynamic_loft = radians(14 + 3 * gauss(random)),
                       .impact_toe = 0.009 * gauss(random),
                       .impact_high = 0.006 * gauss(random)};
    Blow truth = t.blow;
    truth.contact.tangential_restitution = tangential;
    truth.ball.inertia_factor = inertia_factor;
    truth.delivery.dynamic_loft += loft_error;
    const Launch l = model->launch(truth);
    for (int c = 0; c < 5; ++c)
      measured(i, c) = get(l, channels[std::size_t(c)].output) / channels[std::size_t(c)].si +
                       channels[std::size_t(c)].noise * gauss(random);
    trials.push_back(t);
  }
  ShotModel shots(*model, true, trials, channels, measured);
  shots.set_covariance({}, Model{}, nullptr);
  std::vector<int> rows;
  for (int i = 0; i < 60; ++i) rows.push_back(i);
  return balance(shots, rows, Model{}, nullptr);
}

TEST(Balances, NoiseAloneIsSharedByFreedom) {
  const Balance b = of(0, 0.4, 0);
  EXPECT_EQ(b.contact_freedom, 180);
  EXPECT_EQ(b.inertia_freedom, 120);
  EXPECT_NEAR(b.contact / 180, 1, 4 * std::sqrt(2.0 / 180));
  EXPECT_NEAR(b.inertia / 120, 1, 4 * std::sqrt(2.0 / 120));
}

TEST(Balances, WhatTheContactDoesSomeImpulseMends) {
  const Balance b = of(0.25, 0.4, 0);
  EXPECT_GT(b.contact, 20 * b.contact_freedom);
  EXPECT_LT(b.inertia_share(), 0.02);
}

TEST(Balances, AnotherBallOrAnotherLoftNoImpulseMends) {
  EXPECT_GT(of(0, 0.44, 0).inertia, 5 * 120);
  EXPECT_GT(of(0, 0.44, 0).inertia_share(), 0.3);
  EXPECT_GT(of(0, 0.4, radians(2)).inertia, 5 * 120);
}

TEST(Absorption, SharesRivalsAndNullVectors) {
  Eigen::MatrixXd fitted = Eigen::MatrixXd::Zero(6, 1);
  fitted(0, 0) = 2;
  Eigen::VectorXd a = Eigen::VectorXd::Zero(6), b = a, c = a;
  a << 3, 4, 0, 0, 0, 0;     // 9/25 of it is absorbed
  b << 0, 2, 1e-3, 0, 0, 0;  // what is left of a, nearly
  c << 0, 0, 0, 5, 0, 0;
  const Likeness l = likeness({{"a", "p", a}, {"b", "q", b}, {"c", "r", c}}, fitted);
  ASSERT_EQ(l.absorption.size(), 3u);
  EXPECT_NEAR(l.absorption[0].absorbed, 0.36, 1e-12);
  EXPECT_NEAR(l.absorption[0].signal, 4, 1e-12);
  EXPECT_EQ(l.absorption[0].nearest, "b");
  EXPECT_NEAR(l.absorption[1].likeness, 1, 1e-6);
  ASSERT_EQ(l.null_vectors.size(), 1u);
  ASSERT_EQ(l.null_vectors[0].weights.size(), 2u);
  EXPECT_NEAR(l.null_vectors[0].weights[0].second * l.null_vectors[0].weights[1].second, -1, 1e-3);
}

}  // namespace
}  // namespace hosel::loop
