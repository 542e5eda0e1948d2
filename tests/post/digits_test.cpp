#include "post/digits.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hosel::post {
namespace {

TEST(Digits, EndAtTheSecondDigitOfTheDeviation) {
  const auto said = [](double x, double sd) { return with_deviation(x, sd); };
  EXPECT_EQ(said(1.23456, 0.0561), "1.235 ± 0.056");
  EXPECT_EQ(said(-2738.4, 35.2), "-2738 ± 35");
  EXPECT_EQ(said(0.86, 0.25), "0.86 ± 0.25");
  EXPECT_EQ(said(12.3, 3.4), "12.3 ± 3.4");
  EXPECT_EQ(said(-0.001, 0.12), "0.00 ± 0.12");
  EXPECT_EQ(said(0, 0.0012), "0.0000 ± 0.0012");
  EXPECT_EQ(said(3.2156e7, 2.1e5), "3.216e+07 ± 2.1e+05");
  EXPECT_EQ(said(2.15e-9, 3e-11), "2.150e-09 ± 3.0e-11");
}

TEST(Digits, FourDigitsWithoutADeviation) {
  for (const double sd : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(with_deviation(1.23456, sd), "1.235 ± –");
  EXPECT_EQ(with_deviation(std::numeric_limits<double>::quiet_NaN(), 1), "– ± –");
}

TEST(Digits, RoundOffIsZero) {
  EXPECT_EQ(beside(1.761e-10, 60), "0");
  EXPECT_EQ(beside(-2.8734e-14, 3e-14), "0");
  EXPECT_EQ(beside(-2.87341e-8, 3e-8), "-2.873e-08") << "a compliance [m/N]";
  EXPECT_EQ(beside(0.25, 60, true), "+0.25");
}

TEST(Digits, WhatPrintsAsZeroHasNoSign) {
  EXPECT_EQ(fixed(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed(-0.5, 0), "0") << "a tie goes to the even digit";
  EXPECT_EQ(fixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(fixed(0.04, 1, true), "0.0");
  EXPECT_EQ(fixed(0.06, 1, true), "+0.1");
  EXPECT_EQ(fixed(-71.255, 1), "-71.3");
  EXPECT_EQ(beside(-2.8172e-13, 4, false, 5), "0") << "a side [m]";
  EXPECT_EQ(beside(1.23456, 4, false, 5), "1.2346");
}

TEST(Digits, AnErrorIsRoundedUpAndNeverZero) {
  EXPECT_EQ(error_bound(0.0241, 2), "0.03");
  EXPECT_EQ(error_bound(13.2, 0), "14");
  EXPECT_EQ(error_bound(0, 0), "1");
  EXPECT_EQ(error_bound(1e-7, 2), "0.01");
  EXPECT_EQ(error_bound(0.02 * (1 + 1e-14), 2), "0.02") << "round-off is no error";
}

}  // namespace
}  // namespace hosel::post
