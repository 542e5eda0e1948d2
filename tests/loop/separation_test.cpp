// How far two sets of effects are apart: by least squares, and one shot at a time.
#include "loop/shots/separation.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include <random>

namespace hosel::loop {
namespace {

/// Each shot more says the same as all of them at once, and that is what least squares leaves. The prior of 1e-6 on
/// each parameter, which least squares has not, is a millionth of what the shots say.
TEST(Separation, AShotMoreTellsWhatAllTogetherTell) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return normal(random); };
  constexpr Eigen::Index channels = 4, parameters = 3, shots = 6;
  Separation apart(parameters);
  Eigen::MatrixXd J(0, parameters);
  Eigen::VectorXd d(0);
  for (Eigen::Index k = 0; k < shots; ++k) {
    const Separation::Site site{Eigen::VectorXd::NullaryExpr(channels, any),
                                Eigen::MatrixXd::NullaryExpr(channels, parameters, any)};
    const double foretold = squared_with(apart.nearest(), site);
    apart.add(site);
    J.conservativeResize(J.rows() + channels, Eigen::NoChange);
    d.conservativeResize(d.size() + channels);
    J.bottomRows(channels) = site.J;
    d.tail(channels) = site.d;
    const double left = (d - J * J.colPivHouseholderQr().solve(d)).squaredNorm();
    EXPECT_GT(left, 0.1);
    EXPECT_NEAR(apart.nearest().squared, left, 1e-5 * d.squaredNorm());
    EXPECT_NEAR(foretold, left, 1e-5 * d.squaredNorm());
  }
}

}  // namespace
}  // namespace hosel::loop
