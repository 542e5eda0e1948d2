// Every effect: zero parameters give the base back bit for bit; derivatives agree with finite differences.
#include <gtest/gtest.h>

#include <cmath>

#include "golf/face_library.hpp"
#include "loop/shots/model.hpp"
#include "models/registry.hpp"

namespace hosel::loop {
namespace {

Shot blow_of(int k) {
  Shot t;
  t.blow.club.head = {.mass = 0.2,
                      .cg = Vec3(-0.035, 0.002, 0.003),
                      .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(),
                      .face = {0.3, 0.3}};
  t.blow.delivery = {.club_speed = 38.0 + k,
                     .attack_angle = radians(-2 + 0.5 * k),
                     .club_path = radians(1.0 - 0.3 * k),
                     .dynamic_loft = radians(12 + 3 * k),
                     .face_angle = radians(0.4 * k - 1),
                     .impact_toe = 0.004 * k - 0.01,
                     .impact_high = 0.006 - 0.002 * k};
  t.order = k / 7.0;
  return t;
}

class OnModel : public testing::TestWithParam<const char*> {
 protected:
  OnModel() : model(models::find(GetParam())->make({})), turns(std::string(GetParam()) != "rigid-planar") {
    setting = {
        .head_turns = turns,
        .inertia_declared = true,
        .outputs = {Output::ball_speed, Output::launch_angle, Output::azimuth, Output::backspin, Output::sidespin},
        .face = find_face("modern-driver")->face};
    for (const EffectEntry& e : effects())
      for (Parametrisation& f : e.forms(setting)) forms.push_back(f);
    std::vector<ShotChannel> channels;
    const double noise[] = {0.25, 0.2, 0.25, 60, 60},
                 si[] = {1, kRadPerDeg, kRadPerDeg, kRadPerSecPerRpm, kRadPerSecPerRpm};
    for (std::size_t k = 0; k < setting.outputs.size(); ++k)
      channels.push_back(
          {{.name = std::string(stem(setting.outputs[k])), .si = si[k], .noise = noise[k]}, setting.outputs[k]});
    std::vector<Shot> trials;
    for (int k = 0; k < 8; ++k) {
      trials.push_back(blow_of(k));
      rows.push_back(k);
    }
    shots = std::make_unique<ShotModel>(*model, true, trials, channels, Eigen::MatrixXd::Zero(8, 5));
    shots->set_covariance({}, Model{}, nullptr);
  }
  std::unique_ptr<models::ImpactModel> model;
  bool turns;
  Setting setting;
  std::vector<Parametrisation> forms;
  std::vector<int> rows;
  std::unique_ptr<ShotModel> shots;
};

TEST_P(OnModel, ZeroParametersAreTheBaseBitForBit) {
  ASSERT_GT(forms.size(), 20U);
  for (const Parametrisation& f : forms) {
    const Model m{{&f}};
    const std::vector<double> zero(f.parameters.size(), 0.0);
    for (const int i : rows) {
      double base[5], with[5];
      ASSERT_TRUE(shots->predict(i, Model{}, nullptr, base));
      ASSERT_TRUE(shots->predict(i, m, zero.data(), with));
      for (int c = 0; c < 5; ++c)
        EXPECT_EQ(base[c], with[c]) << f.effect << ", " << f.what << ", shot " << i << ", channel " << c;
    }
  }
}

TEST_P(OnModel, DerivativesAgreeWithFinerDifferences) {
  for (const Parametrisation& f : forms) {
    const Model m{{&f}};
    Eigen::VectorXd p(m.size());
    for (int k = 0; k < p.size(); ++k) p[k] = 0.3 * f.parameters[std::size_t(k)].scale;
    if (f.effect == "friction-limit") p[0] = 8;  // where most of these blows slide
    const Eigen::MatrixXd J = shots->jacobian(rows, m, p);
    for (int k = 0; k < p.size(); ++k) {
      // Fourth-order differences with another step: both errors are far below 1e-4 of the column.
      const double h = 4e-3 * f.parameters[std::size_t(k)].scale;
      const auto at = [&](double s) {
        Eigen::VectorXd q = p;
        q[k] += s * h;
        return shots->whitened(rows, m, q);
      };
      const Eigen::VectorXd reference = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * 4e-3);
      EXPECT_LT((J.col(k) - reference).norm(), 1e-4 * (reference.norm() + 1e-3))
          << f.effect << ", " << f.what << ", parameter " << k;
    }
  }
}

TEST_P(OnModel, EveryEffectChangesSomethingWhereItCanAct) {
  int acting = 0;
  for (const Parametrisation& f : forms) {
    const Model m{{&f}};
    double largest = 0;
    // The far end of a range may be a blow that cannot happen: then a share of it.
    for (const double share : {1.0, 0.3, 0.1}) {
      std::vector<double> p;
      for (const Parameter& q : f.parameters) p.push_back(share * q.max);
      for (const int i : rows) {
        double base[5], with[5];
        ASSERT_TRUE(shots->predict(i, Model{}, nullptr, base));
        if (!shots->predict(i, m, p.data(), with)) continue;
        for (int c = 0; c < 5; ++c) largest = std::max(largest, std::abs(with[c] - base[c]));
      }
      if (largest > 0) break;
    }
    if (largest > 1e-6) ++acting;
    else
      // A planar blow knows no centre of gravity: only then may an effect be silent.
      EXPECT_TRUE(!turns && f.effect == "cg-shift") << f.effect << ", " << f.what;
  }
  EXPECT_GT(acting, 20);
}

INSTANTIATE_TEST_SUITE_P(Loop, OnModel, testing::Values("rigid-planar", "rigid-eccentric"),
                         [](const auto& p) { return std::string(p.param) == "rigid-planar" ? "planar" : "eccentric"; });

}  // namespace
}  // namespace hosel::loop
