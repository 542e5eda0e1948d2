#include "solvers/kriging.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "solvers/errors.hpp"
#include "solvers/random.hpp"

namespace hosel::solvers {
namespace {

Eigen::MatrixXd anywhere(int points, int inputs, std::mt19937_64& random) {
  return Eigen::MatrixXd::NullaryExpr(points, inputs, [&] { return 2 * uniform(random) - 1; });
}

/// Two outputs of two inputs that matter; a third does not.
Eigen::MatrixXd bumps(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd y(x.rows(), 2);
  y.col(0) = (3 * x.col(0).array()).sin() * x.col(1).array();
  y.col(1) = 0.1 * (2 * x.col(1).array()).cos();
  return y;
}

TEST(Kriging, AnswersWhereItWasAskedAndTellsItsErrorElsewhere) {
  std::mt19937_64 random(1);
  const Eigen::MatrixXd x = anywhere(150, 3, random), y = bumps(x);
  const Kriging fit(x, y);
  for (int i = 0; i < 150; ++i) {
    EXPECT_LT((fit(x.row(i).transpose()) - y.row(i).transpose()).norm(), 1e-3);
    EXPECT_GE(fit.error(x.row(i).transpose())(0, 0), fit.correlation().nugget * fit.process()(0, 0));
  }
  const Eigen::MatrixXd there = anywhere(300, 3, random), truth = bumps(there);
  Eigen::Vector2d chi = Eigen::Vector2d::Zero();
  double square = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d miss = fit(there.row(i).transpose()) - truth.row(i).transpose();
    square += miss.squaredNorm() / 300;
    chi += (miss.array().square() / fit.error(there.row(i).transpose()).diagonal().array()).matrix() / 300;
  }
  EXPECT_LT(std::sqrt(square), 0.04);  // of a process of 0.4
  for (const double c : chi) {         // told from 150 points, seen on 300 that lie no closer
    EXPECT_GT(c, 0.1);  // sines are smoother than the process takes them for: told up to three times too large
    EXPECT_LT(c, 3);
  }
}

TEST(Kriging, PointsWithoutAPositiveCorrelationAreRefused) {
  std::mt19937_64 random(5);
  Eigen::MatrixXd x = anywhere(20, 2, random);
  const Eigen::MatrixXd y = bumps(x);
  EXPECT_NO_THROW(Kriging(x, y));
  // A negative nugget, and two points at one place.
  x.row(3) = x.row(2);
  const Kriging::Correlation from{.length = Eigen::Vector2d::Constant(3), .nugget = -1e-3};
  EXPECT_THROW(Kriging(x, y, from, {.sweeps = 0}), NonConvergence);
}

TEST(Kriging, AnInputThatMovesNothingHasALongLength) {
  std::mt19937_64 random(5);
  const Eigen::MatrixXd x = anywhere(100, 3, random);
  const Eigen::VectorXd length = Kriging(x, bumps(x)).correlation().length;
  EXPECT_GT(length[2], 5 * length.head(2).maxCoeff());
}

TEST(Kriging, FarFromAllItSaysThePlaneAndItsError) {
  std::mt19937_64 random(2);
  const Eigen::MatrixXd x = anywhere(100, 3, random);
  Eigen::MatrixXd y = 0.01 * bumps(x);
  const Eigen::Vector3d slope(2, -1, 0.5);
  y.colwise() += x * slope;
  const Kriging fit(x, y);
  const Eigen::Vector3d far(1e4, 0, 0);
  const double error = std::sqrt(fit.error(far)(0, 0));
  EXPECT_NEAR(fit(far)[0], 1e4 * slope[0], 3 * error);
  EXPECT_LT(error, 1e4);                                   // half the slope: the plane is seen
  EXPECT_GT(error, 1e2 * std::sqrt(fit.process()(0, 0)));  // but not known to its last digit
  EXPECT_LT(fit.error(x.row(0).transpose())(0, 0), 1e-3 * fit.process()(0, 0));
}

TEST(Kriging, NeighboursErrAlike) {
  std::mt19937_64 random(4);
  const Eigen::MatrixXd x = anywhere(60, 3, random);
  const Kriging fit(x, bumps(x));
  Eigen::MatrixXd at(4, 3);
  at << 0.31, 0.12, 0, 0.315, 0.12, 0, -0.8, 0.7, 0, x.row(0);
  const Eigen::MatrixXd together = fit.errors_together(at);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(together(i, i) * fit.process()(0, 0), fit.error(at.row(i).transpose())(0, 0), 1e-9);
  const auto correlation = [&](int i, int j) { return together(i, j) / std::sqrt(together(i, i) * together(j, j)); };
  EXPECT_GT(correlation(0, 1), 0.5);
  EXPECT_LT(std::abs(correlation(0, 2)), 0.1);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(together).eigenvalues()[0], 0);
}

/// Noise of which no input tells anything is foretold by its mean; a wave below as much noise is found, along its
/// input.
TEST(Kriging, OfNoisyPointsOnlyWhatTheOthersForetellIsSaid) {
  std::mt19937_64 random(6);
  const Eigen::MatrixXd x = anywhere(120, 6, random), noise = anywhere(120, 1, random),
                        there = anywhere(400, 6, random);
  const Eigen::MatrixXd wave = 0.8 * (3 * x.col(2).array()).sin();
  const Kriging none(x, noise, Kriging::noisy()), some(x, noise + wave, Kriging::noisy());
  double of_none = 0, of_some = 0, left = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::VectorXd at = there.row(i).transpose();
    of_none += std::pow(none(at)[0], 2) / 400;
    of_some += std::pow(0.8 * std::sin(3 * at[2]), 2) / 400;
    left += std::pow(some(at)[0] - 0.8 * std::sin(3 * at[2]), 2) / 400;
  }
  EXPECT_GT(of_some, 0.2);  // the wave is there
  EXPECT_LT(left, 0.2 * of_some);
  EXPECT_LT(of_none, 0.1 / 3);  // of a variance of 1/3
  Eigen::Index shortest = 0;
  some.correlation().length.minCoeff(&shortest);
  EXPECT_EQ(shortest, 2);
}

TEST(Kriging, NoiseIsNotInterpolated) {
  std::mt19937_64 random(3);
  const Eigen::MatrixXd x = anywhere(120, 3, random);
  const Eigen::MatrixXd noise = anywhere(120, 1, random);
  const Kriging fit(x, noise);
  double square = 0;
  for (int i = 0; i < 120; ++i) square += fit(x.row(i).transpose()).squaredNorm() / 120;
  EXPECT_LT(square, 0.1 / 3);  // of a variance of 1/3: a plane through it takes 4/120
  EXPECT_NEAR(fit.error(Eigen::Vector3d(0.1, 0.2, 0.3))(0, 0), 1.0 / 3, 0.1);
}

/// Through its own points a process is itself; through many more it comes nearer to what they scatter about.
TEST(Kriging, GoesThroughMorePointsThanItHas) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd x = anywhere(1500, 3, random), truth = bumps(x);
  const Eigen::MatrixXd y = truth + 0.3 * Eigen::MatrixXd::NullaryExpr(1500, 2, [&] { return normal(random); });
  const Eigen::MatrixXd few = x.topRows(120), of = y.topRows(120);
  for (const bool plane : {false, true}) {
    Kriging::Search search = Kriging::noisy();
    search.plane = plane;
    const Kriging fit(few, of, search), same = fit.through(few, of), more = fit.through(x, y);
    const Eigen::MatrixXd there = anywhere(200, 3, random), meant = bumps(there);
    double change = 0, before = 0, after = 0;
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd at = there.row(i).transpose();
      change = std::max(change, (same(at) - fit(at)).norm());
      before += std::pow(fit(at)[0] - meant(i, 0), 2);
      after += std::pow(more(at)[0] - meant(i, 0), 2);
    }
    EXPECT_LT(change, 1e-5);         // round-off, as large as the points' correlation is nearly singular
    EXPECT_LT(after, 0.3 * before);  // twelve times the points: a twelfth, but for what 120 of them cannot make up
  }
}

}  // namespace
}  // namespace hosel::solvers
