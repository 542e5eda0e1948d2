// Blows side by side in vector registers: each as if it were alone, whatever its neighbours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "golf/face_library.hpp"
#include "models/checked_launch.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "solvers/random.hpp"
#include "tests/properties/random_blows.hpp"

namespace hosel::models {
namespace {

/// Every bit of a launch.
void expect_same(const Launch& a, const Launch& b) {
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.spin, b.spin);
  EXPECT_EQ(a.head_velocity, b.head_velocity);
  EXPECT_EQ(a.head_spin, b.head_spin);
  EXPECT_EQ(a.contact_time, b.contact_time);
  EXPECT_EQ(a.peak_force, b.peak_force);
  EXPECT_EQ(a.peak_compression, b.peak_compression);
}

/// 500 blows of many clubs and speeds: rigid and yielding faces, walls, and heads that move away.
std::vector<Blow> random_drives_and_walls() {
  test::Random random(20261126);
  std::vector<Blow> out;
  while (out.size() < 500) {
    Blow b = test::random_trial(random, false).blow;
    if (random.chance(0.3)) b.club.head.compliance = find_face("modern-driver")->face;
    if (random.chance(0.05)) {
      b.club.head.mass = INFINITY;
      b.club.head.compliance.reset();
    }
    if (random.chance(0.05)) b.delivery.dynamic_loft = radians(120);
    out.push_back(b);
  }
  return out;
}

TEST(SideBySide, EachIsAsAlone) {
  const std::vector<Blow> all = random_drives_and_walls();
  const Volumetric model({}, {Integrator::rosenbrock, 1e-3});
  const std::vector<Answer> together = model.launches(all);
  ASSERT_EQ(together.size(), all.size());
  int walls = 0, yielding = 0, refused = 0;
  std::vector<double> times;
  for (std::size_t k = 0; k < all.size(); ++k) {
    walls += std::isinf(all[k].club.head.mass);
    yielding += all[k].club.head.compliance.has_value();
    if (together[k].failure) {
      ++refused;
      EXPECT_THROW(together[k].value(), std::invalid_argument);
      EXPECT_THROW(model.launch(all[k]), std::invalid_argument);
      continue;
    }
    expect_same(together[k].launch, model.launch(all[k]));
    times.push_back(*together[k].launch.contact_time);
  }
  // Lanes end one by one: contacts of a half to twice the usual time stood side by side.
  EXPECT_GT(walls, 5);
  EXPECT_GT(yielding, 50);
  EXPECT_GT(refused, 5);
  EXPECT_GT(times.size(), 400u);
  EXPECT_GT(*std::ranges::max_element(times), 2 * *std::ranges::min_element(times));
  // Other neighbours, and lanes that stand empty.
  std::mt19937_64 random(1);
  const std::vector<std::size_t> order = solvers::shuffled(all.size(), random);
  for (std::size_t first = 0; first < order.size(); first += 7) {
    std::vector<Blow> few;
    for (std::size_t i = first; i < std::min(order.size(), first + 7); ++i) few.push_back(all[order[i]]);
    const std::vector<Answer> again = model.launches(few);
    for (std::size_t i = 0; i < few.size(); ++i)
      if (!again[i].failure) expect_same(again[i].launch, together[order[first + i]].launch);
  }
}

/// The answers of CVODE, whose equations are of single numbers, to what tolerance and blow make of them: a step may err
/// by the tolerance of the blow's scales, and some tens of steps add up.
TEST(SideBySide, AgreeWithTheReference) {
  std::vector<Blow> all = random_drives_and_walls();
  all.resize(60);
  for (const double tolerance : {1e-3, 1e-5}) {
    int compared = 0;
    const std::vector<Answer> found = Volumetric({}, {Integrator::rosenbrock, tolerance}).launches(all);
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (found[k].failure) continue;
      const Launch exact = volumetric_impact(all[k], {}, {Integrator::cvode, 1e-9}).launch;
      const double speed = all[k].delivery.club_speed;
      EXPECT_LT((found[k].launch.velocity - exact.velocity).norm(), 5 * tolerance * speed) << k;
      EXPECT_LT((found[k].launch.spin - exact.spin).norm(), 5 * tolerance * speed / all[k].ball.radius) << k;
      ++compared;
    }
    EXPECT_GT(compared, 50);
  }
}

TEST(SideBySide, ClubsWithTheirShafts) {
  test::Random random(3);
  std::vector<Blow> all;
  for (int club = 0; club < 4; ++club) {
    const Blow of = test::random_trial(random, false).blow;
    for (int k = 0; k < 6; ++k) {
      all.push_back(of);
      all.back().delivery.impact_toe = random.between(-0.02, 0.02);
      if (club == 1) all.back().club.head.compliance = find_face("modern-driver")->face;
      if (club == 2) all.back().club.shaft.reset();
    }
  }
  const ShaftCoupled model({}, {Integrator::rosenbrock, 1e-3});
  const std::vector<Answer> together = model.launches(all);
  ASSERT_EQ(together.size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!all[k].club.shaft) {
      EXPECT_THROW(together[k].value(), std::invalid_argument);
      continue;
    }
    expect_same(together[k].value(), model.launch(all[k]));
    // The shaft takes part.
    EXPECT_NE(together[k].value().velocity, Volumetric({}, {Integrator::rosenbrock, 1e-3}).launch(all[k]).velocity);
  }
}

/// The gate and a model that goes one after the other.
TEST(SideBySide, FailuresStayWithTheirBlow) {
  std::vector<Blow> three(3, random_drives_and_walls().front());
  three[1].delivery.dynamic_loft = radians(120);
  const std::vector<Answer> found = checked_launches(RigidEccentric(), three);
  expect_same(found[0].value(), RigidEccentric().launch(three[0]));
  EXPECT_THROW(found[1].value(), std::invalid_argument);
  expect_same(found[2].value(), found[0].value());
}

}  // namespace
}  // namespace hosel::models
