// Dormand and Prince's method against closed forms, smooth and with corners in the rate.
#include "solvers/dormand_prince.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace {
using hosel::solvers::DormandPrince;

template <std::size_t N, class Rate, class Piece>
auto solver_of(Rate rate, Piece piece, double tolerance) {
  std::array<double, N> absolute;
  absolute.fill(tolerance);
  return DormandPrince<N, Rate, Piece>(rate, piece, tolerance, absolute);
}
const auto kSmooth = [](const auto&) { return 0L; };

TEST(DormandPrince, ErrorFollowsTheToleranceAndTheOrder) {
  using State = std::array<double, 2>;
  const auto swing = [](const State& y, State& dy, long) { dy = {y[1], -y[0]}; };
  long coarse = 0;
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    auto s = solver_of<2>(swing, kSmooth, tolerance);
    s.start(0, {1, 0}, 0.01);
    double between = 0;
    while (s.time() < 10) {
      s.step(10);
      const double t = 0.5 * (s.before() + s.time());
      between = std::max(between, std::abs(s.at(t)[0] - std::cos(t)));
    }
    ASSERT_DOUBLE_EQ(s.time(), 10);
    // Ten radians of a swing: an error of a step at its tolerance at most adds up over some dozens of steps.
    EXPECT_LT(std::abs(s.state()[0] - std::cos(10)), 50 * tolerance);
    EXPECT_LT(between, 50 * tolerance);
    // A thousandth of the tolerance takes the fifth root of a thousand, four times the steps.
    if (coarse) { EXPECT_NEAR(double(s.steps) / double(coarse), std::pow(1e3, 0.2), 1); }
    coarse = s.steps;
  }
}

TEST(DormandPrince, StopsAtACorner) {
  // y' = 1 up to y = 1, then 1 + 5 (y - 1): afterwards y = 1 + (exp(5 (t - 1)) - 1) / 5. A clock beside it.
  using State = std::array<double, 2>;
  const auto bent = [](const State& y, State& dy, bool beyond) { dy = {beyond ? 1 + 5 * (y[0] - 1) : 1, 1}; };
  const auto error = [&](auto rate, auto piece) {
    auto s = solver_of<2>(rate, piece, 1e-6);
    s.start(0, {0, 0}, 0.3);
    while (s.time() < 2) s.step(2);
    EXPECT_NEAR(s.state()[1], 2, 1e-12);
    return std::abs(s.state()[0] - (1 + std::expm1(5.0) / 5)) / std::exp(5.0);
  };
  const double told = error([&](const State& y, State& dy, long piece) { bent(y, dy, piece == 1); },
                            [](const State& y) { return long(y[0] > 1); });
  const double blind = error([&](const State& y, State& dy, long) { bent(y, dy, y[0] > 1); }, kSmooth);
  EXPECT_LT(told, 1e-5);
  EXPECT_LT(5 * told, blind);
}

TEST(DormandPrince, EndsWhereItIsAsked) {
  using State = std::array<double, 1>;
  auto s = solver_of<1>([](const State& y, State& dy, long) { dy[0] = -y[0]; }, kSmooth, 1e-5);
  int rounded = 0;
  for (int k = 1; k <= 2000; ++k) {
    const double latest = 1.5e-4 * k;
    s.start(0, {1}, 1e-3);
    while (s.time() < latest) ASSERT_NO_THROW(s.step(latest)) << latest;
    ASSERT_EQ(s.time(), latest);
    rounded += s.before() + (latest - s.before()) < latest;
  }
  EXPECT_GT(rounded, 0) << "no sum of a start and its step misses the end";
}

TEST(DormandPrince, TakesAStepAgain) {
  using State = std::array<double, 1>;
  auto s = solver_of<1>([](const State& y, State& dy, long) { dy[0] = -y[0]; }, kSmooth, 1e-8);
  s.start(0, {1}, 0.2);
  while (s.time() < 1) s.step(3);
  const double t = 0.5 * (s.before() + s.time());
  s.retake(t);
  EXPECT_DOUBLE_EQ(s.time(), t);
  EXPECT_NEAR(s.state()[0], std::exp(-t), 1e-8);
  s.step(3);
  EXPECT_NEAR(s.state()[0], std::exp(-s.time()), 1e-7);
}

TEST(DormandPrince, GivesUpWhereThereIsNoAnswer) {
  using State = std::array<double, 1>;
  auto s = solver_of<1>([](const State&, State& dy, long) { dy[0] = std::numeric_limits<double>::quiet_NaN(); },
                        kSmooth, 1e-6);
  s.start(0, {1}, 0.1);
  EXPECT_THROW(s.step(1), hosel::solvers::NonConvergence);
  // Of one of two components, and not of the last.
  using Two = std::array<double, 2>;
  auto half = solver_of<2>(
      [](const Two& y, Two& dy, long) {
        dy = {y[1] > 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1, 1};
      },
      kSmooth, 1e-6);
  half.start(0, {0, 0}, 0.1);
  EXPECT_THROW(while (half.time() < 1) half.step(1), hosel::solvers::NonConvergence);
  // y' = y^2 runs away at t = 1.
  auto pole = solver_of<1>([](const State& y, State& dy, long) { dy[0] = y[0] * y[0]; }, kSmooth, 1e-6);
  pole.start(0, {1}, 0.1);
  EXPECT_THROW(while (pole.time() < 2) pole.step(2), hosel::solvers::NonConvergence);
}

}  // namespace
