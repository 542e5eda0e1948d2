// A law inferred from paths that another law flew: its coefficients, the winds, and what a bad path does to them.
#include "models/flight/flight_inference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "models/flight/flight_budget.hpp"

namespace {
using namespace hosel;
using models::FlightLaw;

FlightLaw radar() { return models::find_flight_law("radar-2022")->make(); }

struct Flown {
  std::vector<models::MeasuredPath> paths;
  std::vector<models::GroupWind> winds;
};

/// Drives of four groups through a law that is not the one from which the search begins, read to 5 cm.
Flown flown(const FlightLaw& truth, int shots) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  Flown out;
  for (int g = 0; g < 4; ++g) out.winds.emplace_back(2 * gauss(random), 2 * gauss(random));
  // The mean of the winds is told to be none, and is.
  models::GroupWind mean = models::GroupWind::Zero();
  for (const auto& w : out.winds) mean += w / 4;
  for (auto& w : out.winds) w -= mean;
  const models::PathModel model;
  for (int i = 0; i < shots; ++i) {
    models::MeasuredPath p{.id = std::to_string(i), .launch = {}, .air = {}, .group = i % 4};
    const double speed = 74 + 5 * gauss(random), up = radians(11 + 3 * gauss(random));
    p.launch.velocity = speed * Vec3(std::cos(up), 0.02 * gauss(random), std::sin(up));
    p.launch.spin = kRadPerSecPerRpm * Vec3(0, -(2800 + 900 * gauss(random)), 0);
    models::ShotUnknowns own = models::ShotUnknowns::Zero();
    own[models::kAxis] = 0.1 * gauss(random);
    own[models::kOwnDrag] = 0.02 * gauss(random);
    p.sd[models::kAxis] = 0.15;
    p.sd[models::kOwnDrag] = 0.03;
    for (int k = 1; k <= 12; ++k) p.times.push_back(0.5 * k);
    for (const auto& at :
         models::follow(models::launched(p.launch, own), model.ball,
                        models::conditions_of(p, model, truth, own, out.winds[std::size_t(p.group)]), p.times))
      p.positions.push_back(at.position + 0.05 * Vec3(gauss(random), gauss(random), gauss(random)));
    out.paths.push_back(p);
  }
  return out;
}

FlightLaw truth() {
  FlightLaw law = radar();
  for (const auto& [k, by] : {std::pair{0, 0.012}, {1, 0.02}, {3, 0.02}, {6, -0.01}, {9, 0.03}})
    models::inferred_coefficient(law, k) += by;
  law.decay.travel = 2.3e-5;
  return law;
}

std::vector<double> law_sd() {
  std::vector<double> sd(models::kInferredCoefficients, 0.1);
  sd.back() = 4e-6;
  return sd;
}

TEST(FlightInference, FindsTheLawThatFlewThePaths) {
  const Flown f = flown(truth(), 48);
  models::PathModel model;
  model.noise = 0.05;
  const models::PathFit fit = models::fit_paths(f.paths, 4, model, radar(), law_sd());
  // Where it was flown through: within three standard errors by the covariance, and that is small.
  for (const double s : {0.07, 0.1, 0.14})
    for (const double re : {1e5, 1.4e5, 1.8e5}) {
      const auto found = fit.law.at(re, s), wanted = truth().at(re, s);
      EXPECT_NEAR(found.drag, wanted.drag, 0.005) << re << ' ' << s;
      EXPECT_NEAR(found.lift, wanted.lift, 0.005) << re << ' ' << s;
    }
  // What the search began with is farther off: the comparison sees a law.
  EXPECT_GT(std::abs(radar().at(1.8e5, 0.14).drag - truth().at(1.8e5, 0.14).drag), 0.015);
  ASSERT_EQ(fit.law.covariance.size(), std::size_t(models::kInferredCoefficients * models::kInferredCoefficients));
  FlightLaw found = fit.law, wanted = truth();
  for (int k = 0; k < models::kInferredCoefficients; ++k) {
    const double sd = std::sqrt(fit.law.covariance[std::size_t(k * (models::kInferredCoefficients + 1))]);
    EXPECT_LT(std::abs(models::inferred_coefficient(found, k) - models::inferred_coefficient(wanted, k)), 4 * sd)
        << models::inferred_coefficient_name(k);
  }
  for (std::size_t g = 0; g < 4; ++g) EXPECT_LT((fit.winds[g] - f.winds[g]).norm(), 0.7) << g;
}

TEST(FlightInference, APathThatNothingExplainsDoesNotCount) {
  Flown f = flown(radar(), 24);
  for (Vec3& x : f.paths[3].positions) x.z() += 0.15 * x.x();  // rises out of every flight
  models::PathModel model;
  model.noise = 0.05;
  const models::PathFit fit = models::fit_paths(f.paths, 4, model, radar());
  EXPECT_LT(fit.weight[3], 0.05);
  for (std::size_t i = 0; i < fit.weight.size(); ++i)
    EXPECT_TRUE(i == 3 || fit.weight[i] > 0.5) << i << " " << fit.weight[i];
}

TEST(FlightInference, RefusesWhatItCannotFit) {
  const models::PathModel model;
  EXPECT_THROW(models::fit_paths({}, 1, model, radar()), std::invalid_argument);
  Flown f = flown(radar(), 2);
  f.paths[0].positions.pop_back();
  EXPECT_THROW(models::fit_paths(f.paths, 4, model, radar()), std::invalid_argument);
  EXPECT_THROW(models::fit_paths(flown(radar(), 2).paths, 4, model, radar(), {0.1}), std::invalid_argument);
}

TEST(FlightInference, FollowsAsItFlies) {
  // Without ground the path is the flight's up to its landing.
  Launch l;
  l.velocity = Vec3(70, -3, 16);
  l.spin = Vec3(0, -270, -30);
  models::FlightConditions c{.law = radar()};
  c.wind = {.speed = 4, .towards = radians(70)};
  const models::Flight f = models::fly(l, {}, c, {.tolerance = 1e-9, .sample = 0.5});
  std::vector<double> times;
  for (const auto& p : f.path) times.push_back(p.time);
  const auto path = models::follow(l, {}, c, times, {.tolerance = 1e-9});
  ASSERT_GT(path.size(), 10U);
  for (std::size_t k = 0; k < path.size(); ++k)
    EXPECT_LT((path[k].position - f.path[k].position).norm(), 1e-4) << times[k];
  times.push_back(f.time + 1);
  EXPECT_LT(models::follow(l, {}, c, times).back().position.z(), -10);
}

/// Rate and tilt of a spin that has a part along its path: by differences.
TEST(FlightInference, BudgetOfASpinWithAPartAlongThePath) {
  Launch l;
  l.velocity = Vec3(60, 0, 12);
  l.spin = Vec3(150, -200, -50);
  const models::FlightConditions c;
  const double rate = 2.5, tilt = 0.01, across = std::hypot(200.0, 50.0), axis = std::atan2(50.0, 200.0);
  const auto budget = models::flight_budget(
      l, {}, c, {}, {{.source = "rate", .spin_rate = rate}, {.source = "tilt", .spin_axis = tilt}}, {});
  const auto side_and_carry = [&](const Vec3& spin) {
    Launch other = l;
    other.spin = spin;
    const models::Flight f = models::fly(other, {}, c, {.tolerance = 1e-9});
    return std::pair(f.side, f.carry);
  };
  const auto more = side_and_carry((1 + rate / l.spin_rate()) * l.spin), same = side_and_carry(l.spin),
             turned = side_and_carry(Vec3(150, -across * std::cos(axis + tilt), -across * std::sin(axis + tilt)));
  const double by_rate = std::abs(more.second - same.second), by_tilt = std::abs(turned.first - same.first);
  EXPECT_NEAR(budget.launch[0][models::kCarry], by_rate, 0.03 * by_rate);
  EXPECT_NEAR(budget.launch[1][models::kSide], by_tilt, 0.01 * by_tilt);
}

/// The budget's error by the law is what draws from its covariance scatter, to the error of 400 draws.
TEST(FlightInference, BudgetByTheLawsCovariance) {
  Launch l;
  l.velocity = Vec3(74, 0, 14);
  l.spin = Vec3(0, -280, 0);
  const models::FlightConditions c{.law = radar()};
  const auto budget = models::flight_budget(l, {}, c, {}, {}, {});
  ASSERT_TRUE(budget.law);
  models::FlightLaw narrow = c.law;  // a range that this flight leaves
  narrow.reynolds.low = 1.2e5;
  const double left = models::flight_budget(l, {}, {.law = narrow}, {}, {}, {}).outside;
  EXPECT_GT(left, 0.1);
  EXPECT_NEAR(left, models::fly(l, {}, {.law = narrow}).outside, 1e-12);
  constexpr int n = models::kInferredCoefficients;
  const Eigen::Map<const Eigen::Matrix<double, n, n>> covariance(c.law.covariance.data());
  const Eigen::Matrix<double, n, n> L = covariance.llt().matrixL();
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  double sum = 0, square = 0;
  constexpr int draws = 400;
  for (int i = 0; i < draws; ++i) {
    Eigen::Matrix<double, n, 1> x;
    for (double& v : x) v = gauss(random);
    models::FlightConditions drawn = c;
    const Eigen::Matrix<double, n, 1> by = L * x;
    for (int k = 0; k < n; ++k) models::inferred_coefficient(drawn.law, k) += by[k];
    const double carry = models::fly(l, {}, drawn).carry - budget.value[models::kCarry];
    sum += carry / draws;
    square += carry * carry / draws;
  }
  const double sd = std::sqrt(square - sum * sum);
  EXPECT_GT(sd, 0.1);
  EXPECT_NEAR((*budget.law)[models::kCarry], sd, 0.15 * sd);
  EXPECT_FALSE(models::flight_budget(l, {}, {}, {}, {}, {}).law);
}

/// Value, slope and curvature meet at both ends of every margin: differences across an edge shrink with the third power
/// of their width at most as fast as inside.
TEST(FlightInference, TheSurfaceMeetsThePublishedLawSmoothly) {
  const FlightLaw law = radar();
  const auto& surface = std::get<models::SurfaceLaw>(law.form);
  const auto third = [&](auto&& at, double x, double h) {
    return std::abs(at(x + 2 * h) - 3 * at(x + h) + 3 * at(x) - at(x - h));
  };
  for (const double s : {surface.spin.none_below, surface.spin.from, surface.spin.to, surface.spin.none_above}) {
    const auto drag = [&](double x) { return law.at(1.5e5, x).drag; };
    const double wide = third(drag, s, 2e-4), narrow = third(drag, s, 1e-4);
    // A kink would leave a half of it, a jump all, a jump of curvature a quarter.
    EXPECT_LT(narrow, 0.2 * wide + 1e-12) << s;
  }
  for (const double re : {surface.reynolds.from, surface.reynolds.to, surface.reynolds.none_above}) {
    const auto lift = [&](double x) { return law.at(x, 0.1).lift; };
    EXPECT_LT(third(lift, re, 100), 0.2 * third(lift, re, 200) + 1e-12) << re;
  }
  // Outside it is the published law to the bit.
  const FlightLaw published = models::find_flight_law("libgolf")->make();
  EXPECT_EQ(law.at(1.5e5, 0.35).drag, published.at(1.5e5, 0.35).drag);
  EXPECT_EQ(law.at(4e4, 0.1).lift, published.at(4e4, 0.1).lift);
  EXPECT_NE(law.at(1.5e5, 0.1).drag, published.at(1.5e5, 0.1).drag);
}

}  // namespace
