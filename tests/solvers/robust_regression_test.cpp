#include "solvers/robust_regression.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>
#include <random>

#include "solvers/errors.hpp"

namespace {

using namespace hosel::solvers;

struct Drawn {
  Eigen::MatrixXd X;
  Eigen::VectorXd y;
};

/// y = 3 - 42e3 toe + 2 speed with noise 0.1; of which `bad` rows say something else.
Drawn draw(unsigned seed, int rows, int bad) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Drawn d{Eigen::MatrixXd(rows, 3), Eigen::VectorXd(rows)};
  for (int i = 0; i < rows; ++i) {
    d.X.row(i) << 1, 0.01 * normal(random), 45 + 5 * normal(random);
    d.y[i] = 3 - 42e3 * d.X(i, 1) + 2 * d.X(i, 2) + 0.1 * normal(random);
    if (i < bad) d.y[i] = 500 * normal(random);
  }
  return d;
}

/// Bad rows do not move the line, and an ordinary fit of the same rows is far off.
TEST(RobustRegression, BadRowsAreBorne) {
  const Drawn d = draw(1, 100, 15);
  const RobustRegression fit = robust_regression(d.X, d.y);
  EXPECT_GT((fit.weights.head(15).array() < 0.01).count(), 13) << "the bad rows are found";
  // Good rows keep theirs. Beside 15 % of bad rows the scale, a median, is 1.22 of the noise x, so that
  // the mean of (1 - (x/5.7)^2)^2 is 0.94, and 0.7 % of the rows weigh less than 0.6.
  const auto good = fit.weights.tail(85).array();
  EXPECT_NEAR(good.mean(), 0.94, 0.02);
  EXPECT_LT((good < 0.6).count(), 4);
  EXPECT_NEAR(fit.coefficients[1], -42e3, 4 * std::sqrt(fit.covariance(1, 1)));
  EXPECT_NEAR(fit.coefficients[2], 2, 4 * std::sqrt(fit.covariance(2, 2)));
  const Eigen::VectorXd plain = (d.X.transpose() * d.X).ldlt().solve(d.X.transpose() * d.y);
  EXPECT_GT(std::abs(plain[1] + 42e3), 20 * std::sqrt(fit.covariance(1, 1)));
}

/// The stated errors are those of repeated draws: 200 of them know a standard deviation to 5 %.
TEST(RobustRegression, StatedErrorsAreThoseOfRepeatedDraws) {
  constexpr int draws = 200;
  double sum = 0, square = 0, stated = 0;
  for (int k = 0; k < draws; ++k) {
    const Drawn d = draw(100 + unsigned(k), 80, 8);
    const RobustRegression fit = robust_regression(d.X, d.y);
    sum += fit.coefficients[1];
    square += fit.coefficients[1] * fit.coefficients[1];
    stated += std::sqrt(fit.covariance(1, 1)) / draws;
  }
  const double seen = std::sqrt(square / draws - sum / draws * (sum / draws));
  EXPECT_NEAR(stated / seen, 1, 0.15);
}

/// A 95 % interval of twelve clean rows and three unknowns is one: Student's, nine degrees of freedom. Of 400 draws 95
/// +- 1.1 % hold the truth; the weights of so few rows take some.
TEST(RobustRegression, IntervalsOfFewRowsHoldTheTruth) {
  constexpr int draws = 400;
  int inside = 0;
  for (int k = 0; k < draws; ++k) {
    const Drawn d = draw(1000 + unsigned(k), 12, 0);
    const RobustRegression fit = robust_regression(d.X, d.y);
    if (std::abs(fit.coefficients[1] + 42e3) <= 2.262 * std::sqrt(fit.covariance(1, 1))) ++inside;
  }
  EXPECT_GE(inside, 0.90 * draws);
  EXPECT_LE(inside, 0.98 * draws);
}

/// A coefficient that hangs on one row has no error that the others could tell.
TEST(RobustRegression, ARowThatDecidesACoefficientAloneIsRefused) {
  Drawn d = draw(4, 30, 0);
  d.X.col(2).setZero();
  d.X(7, 2) = 1;
  EXPECT_THROW(robust_regression(d.X, d.y), NonConvergence);
}

TEST(RobustRegression, InputsThatDependOnEachOtherAreRefused) {
  Drawn d = draw(3, 30, 0);
  d.X.col(2) = 4 * d.X.col(1);
  EXPECT_THROW(robust_regression(d.X, d.y), NonConvergence);
}

}  // namespace
