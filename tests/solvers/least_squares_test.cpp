#include "solvers/least_squares.hpp"

#include <gtest/gtest.h>

#include <set>

namespace hosel::solvers {
namespace {

/// Rosenbrock's valley, whose steps are long and bent: residuals 10 (y - x^2) and 1 - x, zero at (1, 1).
bool valley(const Eigen::VectorXd& p, Eigen::VectorXd& r) {
  r << 10 * (p[1] - p[0] * p[0]), 1 - p[0];
  return true;
}

TEST(LeastSquares, DerivativesAreAskedOncePerStepAndNoPointTwice) {
  using Point = std::pair<double, double>;
  std::multiset<Point> values, derivatives;
  LeastSquares problem{.residuals = 2, .bounds = {{-2, 2}, {-1, 3}}, .value = {}};
  problem.value = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
    values.insert({p[0], p[1]});
    return valley(p, r);
  };
  problem.linearised = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
    derivatives.insert({p[0], p[1]});
    J.resize(2, 2);
    J << -20 * p[0], 10, -1, 0;
    return valley(p, r);
  };
  const auto found = minimise(problem, Eigen::Vector2d(-1.2, 1), {});
  ASSERT_TRUE(found && found->converged);
  EXPECT_NEAR(found->parameters[0], 1, 1e-6);
  EXPECT_NEAR(found->parameters[1], 1, 1e-6);
  ASSERT_GT(derivatives.size(), 5U);
  for (const Point& p : derivatives) EXPECT_EQ(derivatives.count(p), 1U) << p.first << " " << p.second;
  for (const Point& p : values) EXPECT_EQ(values.count(p), 1U) << p.first << " " << p.second;
  EXPECT_LE(derivatives.size(), values.size() + 1);  // each but the first where a step ended
}

}  // namespace
}  // namespace hosel::solvers
