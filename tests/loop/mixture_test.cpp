// Two populations of shots that no one direction parts: the second has an effect, whose size on a shot is its own.
#include "loop/shots/mixture.hpp"

#include <gtest/gtest.h>

#include <random>

#include "golf/units.hpp"

namespace hosel::loop {
namespace {

constexpr int kShots = 60, kChannels = 3;

/// Readings with unit noise: the effect moves channel 1 by an input of either sign times `size(i)`.
struct Made {
  Eigen::VectorXd input{kShots};
  Eigen::MatrixXd z{kShots, kChannels};

  template <class Size>
  explicit Made(Size&& size) {
    std::mt19937 random(3);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> uniform(0.5, 1.5);
    for (int i = 0; i < kShots; ++i) {
      input[i] = (i % 4 < 2 ? 1 : -1) * uniform(random);
      for (int c = 0; c < kChannels; ++c) z(i, c) = gauss(random);
      z(i, 1) += size(i) * input[i];
    }
  }
  std::optional<Mixture> parted() const {
    const Eigen::VectorXd start = Eigen::VectorXd::Constant(1, 4), high = Eigen::VectorXd::Constant(1, 50);
    const Residuals second = [this](const Eigen::VectorXd& size, Eigen::MatrixXd& out) {
      out = z;
      out.col(1) -= size[0] * input;
      return true;
    };
    // One population may have the effect too, at the size that fits all.
    Eigen::MatrixXd fitted = z;
    fitted.col(1) -= input.dot(z.col(1)) / input.squaredNorm() * input;
    return mixture(z, second, start, -high, high, std::max(one_population(z), one_population(fitted)));
  }
};

TEST(Mixture, ASecondPopulationWithAnEffectIsFoundWhereEveryShotHasItsOwnPlace) {
  const Made made([](int i) { return i % 2 ? 6.0 : 0.0; });
  const auto two = made.parted();
  ASSERT_TRUE(two);
  EXPECT_GT(two->gain, 20);
  EXPECT_NEAR(two->share, 0.5, 0.05);
  EXPECT_NEAR(two->deviation, 1, 0.15);  // of 180 readings
  int right = 0;
  for (int i = 0; i < kShots; ++i) right += bool(two->second[std::size_t(i)]) == (i % 2 == 1);
  EXPECT_GT(right, 0.95 * kShots);
}

TEST(Mixture, AnEffectOfAllShotsOrOneOfManySizesIsNone) {
  const auto all = Made([](int) { return 6.0; }).parted();
  EXPECT_FALSE(all && all->gain > 20);
  const auto growing = Made([](int i) { return 6.0 * i / kShots; }).parted();
  EXPECT_FALSE(growing && growing->gain > 20);
}

/// One population away from zero, or two: zeros in place of what was not read would be another.
TEST(Mixture, WhatWasNotReadIsOfNoPopulation) {
  std::mt19937 random(7);
  std::normal_distribution<double> gauss;
  Eigen::MatrixXd one(300, 2), two(300, 2);
  for (Eigen::Index i = 0; i < one.rows(); ++i)
    for (Eigen::Index c = 0; c < 2; ++c) {
      one(i, c) = gauss(random) + (c == 0 ? 5 : 0);
      two(i, c) = gauss(random) + (c == 0 && i % 2 ? 5 : 0);
    }
  for (Eigen::Index i = 0; i < one.rows(); i += 3) one(i, 0) = two(i, 0) = kNaN;
  EXPECT_FALSE(mixture(one));
  const auto parted = mixture(two);
  ASSERT_TRUE(parted);
  ASSERT_EQ(parted->rows.size(), 200U);
  int right = 0;
  for (std::size_t k = 0; k < parted->rows.size(); ++k) {
    EXPECT_NE(parted->rows[k] % 3, 0);
    right += bool(parted->second[k]) == (parted->rows[k] % 2 == 1);
  }
  EXPECT_GT(right, 190);  // five standard deviations apart: 1 % lie beyond the middle
}

TEST(Mixture, NoiseOfAFlatShapeIsOnePopulation) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::normal_distribution<double> gauss;
  Eigen::MatrixXd flat(300, 2), two(300, 2);
  for (Eigen::Index i = 0; i < flat.rows(); ++i)
    for (Eigen::Index c = 0; c < 2; ++c) {
      flat(i, c) = uniform(random);
      two(i, c) = gauss(random) + (c == 0 && i % 2 ? 4 : 0);
    }
  EXPECT_FALSE(mixture(flat));
  const auto parted = mixture(two);
  ASSERT_TRUE(parted);
  EXPECT_GT(parted->gain, 20);
  EXPECT_NEAR(parted->apart, 4, 0.4);
}

}  // namespace
}  // namespace hosel::loop
