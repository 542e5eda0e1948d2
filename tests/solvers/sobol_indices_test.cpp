// Shares of variance against a function whose shares are known in closed form.
#include "solvers/sobol_indices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hosel::solvers {
namespace {

/// Ishigami's function: the third input acts by its interaction with the first alone.
TEST(SobolIndices, OfIshigamisFunctionAreThoseOfTheClosedForm) {
  constexpr double pi = std::numbers::pi, a = 7, b = 0.1;
  const auto f = [pi](const Eigen::VectorXd& u) {
    const Eigen::VectorXd x = (2 * u.array() - 1) * pi;
    return std::sin(x[0]) + a * std::pow(std::sin(x[1]), 2) + b * std::pow(x[2], 4) * std::sin(x[0]);
  };
  const double p4 = std::pow(pi, 4), p8 = p4 * p4;
  const double first = 0.5 * std::pow(1 + b * p4 / 5, 2), second = a * a / 8, both = b * b * p8 * (1.0 / 18 - 1.0 / 50);
  const double all = first + second + both;
  const SobolIndices found = sobol_indices(f, 3, 4096);
  ASSERT_GT(both / all, 0.2) << "an interaction to be found";
  // A quasi-random sequence of 4096 points: some 1 / 4096 of smooth functions, ten times that here.
  constexpr double error = 0.003;
  EXPECT_NEAR(found.first[0], first / all, error);
  EXPECT_NEAR(found.first[1], second / all, error);
  EXPECT_NEAR(found.first[2], 0, error);
  EXPECT_NEAR(found.total[0], (first + both) / all, error);
  EXPECT_NEAR(found.total[1], second / all, error);
  EXPECT_NEAR(found.total[2], both / all, error);
}

TEST(SobolIndices, AreZeroOfAConstantAndRefusedOfNothing) {
  EXPECT_EQ(sobol_indices([](const Eigen::VectorXd&) { return 3.0; }, 2, 16).total.norm(), 0);
  EXPECT_THROW(sobol_indices([](const Eigen::VectorXd&) { return 3.0; }, 0, 16), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::solvers
