#include "mesh/gauss.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hosel::mesh {
namespace {

double integral(int points, int degree) {
  double sum = 0;
  for (const auto& [x, w] : gauss(points)) sum += w * std::pow(x, degree);
  return sum;
}

TEST(Gauss, IntegratesWhatItShouldAndNothingMore) {
  for (int n = 1; n <= 5; ++n) {
    ASSERT_EQ(gauss(n).size(), std::size_t(n));
    for (int degree = 0; degree < 2 * n; ++degree)
      EXPECT_NEAR(integral(n, degree), degree % 2 ? 0 : 2.0 / (degree + 1), 1e-15) << n << " points, x^" << degree;
    // The error of the next even power: f^(2n) = (2n)! in 2^(2n+1) (n!)^4 / ((2n+1) ((2n)!)^3) f^(2n).
    double factorial = 1, twice = 1;
    for (int k = 1; k <= n; ++k) factorial *= k;
    for (int k = 1; k <= 2 * n; ++k) twice *= k;
    const double missing = std::pow(2.0, 2 * n + 1) * std::pow(factorial, 4) / ((2 * n + 1) * twice * twice);
    EXPECT_NEAR(2.0 / (2 * n + 1) - integral(n, 2 * n), missing, 1e-15) << n << " points";
  }
}

TEST(Gauss, PointsStandInOrder) {
  for (int n = 2; n <= 5; ++n) {
    const auto rule = gauss(n);
    for (std::size_t i = 1; i < rule.size(); ++i) EXPECT_LT(rule[i - 1].first, rule[i].first);
    EXPECT_LT(rule.back().first, 1);
  }
  EXPECT_THROW(gauss(0), std::invalid_argument);
  EXPECT_THROW(gauss(6), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::mesh
