#include "solvers/main_effects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hosel::solvers {
namespace {

/// A grid of two factors from -1 to 1: their effects are independent.
std::vector<EffectFactor> grid(int side) {
  std::vector<EffectFactor> f(2);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      f[0].x.push_back(-1 + 2.0 * i / (side - 1));
      f[1].x.push_back(-1 + 2.0 * j / (side - 1));
    }
  return f;
}

std::vector<double> response(const std::vector<EffectFactor>& f, auto&& of) {
  std::vector<double> y;
  for (std::size_t i = 0; i < f[0].x.size(); ++i) y.push_back(of(f[0].x[i], f[1].x[i]));
  return y;
}

TEST(MainEffects, ACurveThatTurnsHasAValueBetweenItsEnds) {
  const std::vector<EffectFactor> f = grid(7);
  // Largest at u = 1/4; the mean of v's part is zero.
  const auto turning = main_effects(f, response(f, [](double u, double v) { return 5 + 0.5 * u - u * u + 0.1 * v; }));
  ASSERT_TRUE(turning);
  ASSERT_EQ(turning->order.front(), 0U);
  const MainEffect& e = turning->factors[0];
  EXPECT_NEAR(e.at_low, 3.5, 1e-9);
  EXPECT_NEAR(e.at_high, 4.5, 1e-9);
  ASSERT_TRUE(e.between);
  EXPECT_NEAR(*e.between, 5 + 1.0 / 16, 1e-9);
  EXPECT_FALSE(turning->factors[1].between) << "a straight line does not turn";
  EXPECT_TRUE(turning->separable);

  const auto valley = main_effects(f, response(f, [](double u, double v) { return u * u - 0.5 * u + 0.1 * v; }));
  ASSERT_TRUE(valley && valley->factors[0].between);
  EXPECT_NEAR(*valley->factors[0].between, -1.0 / 16, 1e-9);

  // It turns at u = 1/2, by an eighth of what its ends differ by: what saturates is fitted so.
  const auto bent = main_effects(f, response(f, [](double u, double) { return u - u * u; }));
  ASSERT_TRUE(bent);
  EXPECT_FALSE(bent->factors[0].between);
}

/// Three by three points hold the squares of both factors: a valley is no reason to name the slight slope across it.
TEST(MainEffects, AFullFactorialOfFewPointsKeepsItsSquares) {
  const std::vector<EffectFactor> f = grid(3);
  const auto valley = main_effects(f, response(f, [](double u, double v) { return 3 * u * u + 0.3 * v; }));
  ASSERT_TRUE(valley);
  EXPECT_TRUE(valley->full_factorial);
  // Variances over -1, 0, 1: of u^2 2/9, of v 2/3.
  const double curved = 9 * 2.0 / 9, straight = 0.09 * 2.0 / 3;
  EXPECT_EQ(valley->order.front(), 0U);
  EXPECT_NEAR(valley->factors[0].share, curved / (curved + straight), 1e-9);
  EXPECT_NEAR(valley->factors[1].share, straight / (curved + straight), 1e-9);

  // Of any curve, where every combination is there: a step is no quadratic.
  const std::vector<EffectFactor> g = grid(6);
  const auto step = main_effects(g, response(g, [](double u, double v) { return (u > 0.8 ? 5 : 0) + 0.1 * v; }));
  ASSERT_TRUE(step);
  EXPECT_GT(step->factors[0].share, 0.99);
  EXPECT_NEAR(step->factors[0].at_low, 0, 1e-9);
  EXPECT_NEAR(step->factors[0].at_high, 5, 1e-9);

  std::vector<EffectFactor> gap = f;  // a point of it is missing
  for (EffectFactor& factor : gap) factor.x.pop_back();
  const auto lines = main_effects(gap, response(gap, [](double u, double v) { return 3 * u * u + 0.3 * v; }));
  ASSERT_TRUE(lines);
  EXPECT_FALSE(lines->full_factorial);
  EXPECT_LT(lines->predicted, 0.2) << "lines predict no valley, and say so";
}

TEST(MainEffects, FactorsThatVaryTogetherHaveNoSharesOfTheirOwn) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  std::vector<EffectFactor> f(2);
  std::vector<double> sum;
  for (int i = 0; i < 60; ++i) {
    const double u = gauss(random);
    f[0].x.push_back(u);
    f[1].x.push_back(u + 0.3 * gauss(random));
    sum.push_back(f[0].x.back() + f[1].x.back());
  }
  const auto together = main_effects(f, sum);
  ASSERT_TRUE(together);
  EXPECT_FALSE(together->separable) << "each has about a quarter of the variance, and both explain all of it";
  EXPECT_NEAR(together->factors[0].share + together->factors[1].share, 0.5, 0.1);

  std::vector<double> difference;
  for (std::size_t i = 0; i < sum.size(); ++i) difference.push_back(2 * f[0].x[i] - f[1].x[i]);
  const auto against = main_effects(f, difference);
  ASSERT_TRUE(against);
  EXPECT_GT(against->factors[0].share, 1);
  EXPECT_FALSE(against->separable);

  const std::vector<EffectFactor> apart = grid(6);
  const auto own = main_effects(apart, response(apart, [](double u, double v) { return u + v; }));
  ASSERT_TRUE(own);
  EXPECT_TRUE(own->separable);
  EXPECT_NEAR(own->factors[0].share, 0.5, 1e-9);
}

}  // namespace
}  // namespace hosel::solvers
