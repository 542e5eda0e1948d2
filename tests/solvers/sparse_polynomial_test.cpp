#include "hosel/solvers/sparse_polynomial.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hosel/solvers/random.hpp"

namespace hosel::solvers {
namespace {

Eigen::MatrixXd design(int points, int inputs, unsigned long seed) {
  std::mt19937_64 random(seed);
  Eigen::MatrixXd x(points, inputs);
  for (int k = 0; k < inputs; ++k) {
    const std::vector<double> column = latin_column(-1, 1, std::size_t(points), random);
    for (int i = 0; i < points; ++i) x(i, k) = column[std::size_t(i)];
  }
  return x;
}

/// Twenty inputs, of which two polynomials of degree three use four.
Eigen::MatrixXd few_terms(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd y(x.rows(), 2);
  y.col(0) = 3 + x.col(4).array() - 0.7 * x.col(9).array() * x.col(11).array() + 0.2 * x.col(4).array().cube();
  y.col(1) = 0.5 * x.col(17).array().square() * x.col(9).array();
  return y;
}

TEST(SparsePolynomial, FindsFewTermsAmongManyFromFewerPointsThanCandidates) {
  const Eigen::MatrixXd x = design(150, 20, 1), y = few_terms(x);
  const SparsePolynomial fit(x, y, 3);
  EXPECT_LT(fit.terms(), 12);  // of 611 candidates for each output
  const Eigen::MatrixXd elsewhere = design(50, 20, 2), truth = few_terms(elsewhere);
  for (int i = 0; i < 50; ++i) EXPECT_LT((fit(elsewhere.row(i).transpose()) - truth.row(i).transpose()).norm(), 1e-9);
}

TEST(SparsePolynomial, CrossValidationSeesTheErrorThatNewPointsShow) {
  const auto curve = [](const Eigen::MatrixXd& x) {
    return Eigen::MatrixXd((2 * x.col(0).array() + x.col(1).array()).sin() + 0.3 * (x.col(2).array() - 0.2).exp());
  };
  const Eigen::MatrixXd x = design(200, 8, 3), y = curve(x);
  const SparsePolynomial fit(x, y, 3);
  const double told = std::sqrt((y - fit.left_out()).squaredNorm() / 200);
  const Eigen::MatrixXd elsewhere = design(400, 8, 4), truth = curve(elsewhere);
  double square = 0;
  for (int i = 0; i < 400; ++i) square += (fit(elsewhere.row(i).transpose()) - truth.row(i).transpose()).squaredNorm();
  const double seen = std::sqrt(square / 400);
  ASSERT_GT(seen, 1e-3);  // a sine is no cubic
  EXPECT_NEAR(told / seen, 1,
              0.35);  // two estimates from some hundred points each, one with a tenth fewer to learn from
}

TEST(SparsePolynomial, NoiseIsNotFitted) {
  std::mt19937_64 random(5);
  const Eigen::MatrixXd x = design(120, 15, 6);
  Eigen::MatrixXd y(120, 1);
  for (int i = 0; i < 120; ++i) y(i, 0) = uniform(random) - 0.5;
  // Predicted from the others, noise is no better than its mean: hardly any term may be taken.
  EXPECT_LT(std::sqrt((y - SparsePolynomial(x, y, 3).left_out()).squaredNorm() / 120), 1.25 * std::sqrt(1.0 / 12));
}

}  // namespace
}  // namespace hosel::solvers
