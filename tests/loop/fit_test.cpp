// Fits with several optima, on a deviance that is written down.
#include "loop/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "loop/result.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

/// One parameter x in [-2, 2]. The deviance has a well at -1, and falls again towards 2.5, beyond the bound. `tilt`
/// says how much lower it is there.
class TwoWells final : public Problem {
 public:
  explicit TwoWells(double tilt) : tilt_(tilt) {}
  double at(double x) const { return std::pow((x + 1) * (x - 2.5), 2) + 20 - tilt_ * (x + 1); }

  bool whitened(Part, const Model&, const Eigen::VectorXd& p, Eigen::VectorXd& z, double) const override {
    z = Eigen::VectorXd::Constant(1, std::sqrt(at(p[0])));
    return true;
  }
  bool linearise(Part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z, Eigen::MatrixXd& J,
                 double) const override {
    J = jacobian(Part::select, model, p);
    return whitened(Part::select, model, p, z, Stage::kWhole);
  }
  Eigen::MatrixXd jacobian(Part, const Model&, const Eigen::VectorXd& p) const override {
    const double slope = 2 * (p[0] + 1) * (p[0] - 2.5) * (2 * p[0] - 1.5) - tilt_;
    return Eigen::MatrixXd::Constant(1, 1, slope / 2 / std::sqrt(at(p[0])));
  }
  std::vector<Stage> stages() const override { return {{}}; }

  int width() const override { return 0; }
  const Channel& channel(int) const override { throw std::logic_error("no channels"); }
  void refute(int, bool) override {}
  std::vector<Row> rows() const override { return {}; }
  const Eigen::MatrixXd& measured() const override { return none_; }
  std::vector<Flag> flags() const override { return {}; }
  std::vector<std::string> notes() const override { return {}; }
  std::optional<std::string> too_few() const override { return {}; }
  Eigen::MatrixXd residuals(const Model&, const Eigen::VectorXd&) const override { return none_; }
  Density density(Part) const override { return {}; }
  bool screen(const Selection&) override { return true; }
  Scatter scatter(int, const Eigen::MatrixXd&, int) const override { return {}; }
  double update_noise(const Fit&, const Fit&) override { return 0; }
  StructureMap structure(const Fit&, const Fit&, const Eigen::MatrixXd&, const Rules&) const override { return {}; }
  std::vector<Location> places(const Selection&) const override { return {}; }
  NextExperiment next_experiment(const LoopResult&) const override { return {}; }

 private:
  double tilt_;
  Eigen::MatrixXd none_;
};

Parametrisation one_size() {
  return {.effect = "size", .what = "x", .parameters = {{"x", "1", 1, -2, 2, 1}}, .starts = {{-1.5}, {1.8}}};
}

/// The bound is lower by 2.2 and by 6.7; a parameter costs 4.
TEST(Fit, AnOptimumInRangeGoesBeforeASlightlyLowerBound) {
  const Parametrisation form = one_size();
  const Model model{{&form}};
  const TwoWells slight(1.5), clear(3);
  ASSERT_LT(slight.at(2), slight.at(-1));
  const Fit within = fit(slight, Part::select, model, starts(model), 3);
  EXPECT_FALSE(within.at_bound);
  EXPECT_NEAR(within.p[0], -0.94, .02);
  EXPECT_NEAR(within.deviance, slight.at(within.p[0]), 1e-9);
  ASSERT_EQ(within.others.size(), 1u);
  EXPECT_NEAR(within.others[0][0], 2, 1e-3);

  const Fit beyond = fit(clear, Part::select, model, starts(model), 3);
  EXPECT_TRUE(beyond.at_bound);
  EXPECT_NEAR(beyond.p[0], 2, 1e-3);
  ASSERT_EQ(beyond.others.size(), 1u);
  EXPECT_LT(beyond.others[0][0], 0);
}

}  // namespace
TEST(Parameter, ZeroIsNoEdgeOfARange) {
  const Parameter gain{"gain", "1", 1, 0, 2, 0.1}, loss{"loss", "1", 1, -2, 0, 0.1};
  for (const double x : {0.0, 1.0}) EXPECT_FALSE(gain.at_edge(x) || loss.at_edge(-x)) << x;
  EXPECT_TRUE(gain.at_edge(2) && loss.at_edge(-2));
}

}  // namespace hosel::loop
