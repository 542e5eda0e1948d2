// The loop on records of a clamped shaft that this file makes from beam theory: the closed-form modes of a uniform
// cantilever with a mass at its tip, released from a static load, read at the tip and half way.
#include "loop/history/histories.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <random>
#include <set>

#include "golf/shaft_library.hpp"
#include "loop/history/bench_history.hpp"

namespace hosel::loop {
namespace {

using models::BenchRecord, models::BenchStart, models::Start;

constexpr double kLength = 1, kStiffness = 40, kDensity = 0.06, kDamping = 1e-4, kLoad = 3, kNoise = 0.2;

struct Truth {
  double stiffness = 1;  ///< factor
  double tip_mass = 0;   ///< [kg]
  double ratio = 0;      ///< added damping ratio of every mode
  double delay = 0;      ///< of the second channel [s]
  double gain = 0;       ///< of the first
  double rate = 0;       ///< a tone that no effect has, in the first channel [Hz]
  double colour = 0;     ///< of the noise
  unsigned seed = 1;
  double seconds = 1.5;
};

double shape(double beta, double x) {
  const double s = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  return std::cosh(beta * x) - std::cos(beta * x) - s * (std::sinh(beta * x) - std::sin(beta * x));
}

/// Roots of 1 + cos cosh + r beta (cos sinh - sin cosh) = 0.
std::vector<double> roots(double mass_ratio, int count) {
  const auto f = [&](double b) {
    return (1 + std::cos(b) * std::cosh(b) +
            mass_ratio * b * (std::cos(b) * std::sinh(b) - std::sin(b) * std::cosh(b))) /
           std::cosh(b);
  };
  std::vector<double> out;
  for (double b = 0.1; int(out.size()) < count; b += 0.01) {
    if (f(b) * f(b + 0.01) > 0) continue;
    double low = b, high = b + 0.01;
    for (int k = 0; k < 60; ++k) (f(low) * f(0.5 * (low + high)) <= 0 ? high : low) = 0.5 * (low + high);
    out.push_back(low);
  }
  return out;
}

HistoryRecord record(const Truth& w) {
  std::mt19937 random(w.seed);
  std::normal_distribution<double> gauss;
  HistoryRecord r{.name = "tip.csv"};
  const double rate = 400;
  for (int i = 0; i < int(w.seconds * rate); ++i) r.times.push_back(i / rate);
  r.measured = Eigen::MatrixXd::Zero(std::ptrdiff_t(r.times.size()), 2);
  for (const double beta : roots(w.tip_mass / (kDensity * kLength), 5)) {
    const double omega = beta * beta * std::sqrt(w.stiffness * kStiffness / kDensity) / (kLength * kLength);
    double mass = w.tip_mass * std::pow(shape(beta, 1), 2);
    for (int i = 0; i < 4000; ++i) mass += kDensity * kLength / 4000 * std::pow(shape(beta, (i + 0.5) / 4000), 2);
    const double zeta = 0.5 * omega * kDamping + w.ratio, damped = omega * std::sqrt(1 - zeta * zeta),
                 q0 = kLoad * shape(beta, 1) / (omega * omega * mass);
    const auto q = [&](double t) {
      return t < 0 ? q0
                   : q0 * std::exp(-zeta * omega * t) *
                         (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t));
    };
    for (std::size_t i = 0; i < r.times.size(); ++i) {
      r.measured(std::ptrdiff_t(i), 0) += 1e3 * (1 + w.gain) * shape(beta, 1) * q(r.times[i]);
      r.measured(std::ptrdiff_t(i), 1) += 1e3 * shape(beta, 0.5) * q(r.times[i] - w.delay);
    }
  }
  for (int c = 0; c < 2; ++c) {
    double e = kNoise * gauss(random);
    for (std::size_t i = 0; i < r.times.size(); ++i) {
      e = w.colour * e + std::sqrt(1 - w.colour * w.colour) * kNoise * gauss(random);
      r.measured(std::ptrdiff_t(i), c) += e;
      if (c == 0 && w.rate > 0)
        r.measured(std::ptrdiff_t(i), 0) += 1.0 * std::sin(2 * 3.14159265358979 * w.rate * r.times[i]);
    }
  }
  return r;
}

struct Bench {
  HistoryCase c;
  std::unique_ptr<BenchHistory> model;
};

Bench bench(const Truth& w, bool declared = true, Start start = Start::release) {
  Bench b;
  Club club;
  club.shaft =
      composite_shaft({{0, kStiffness, kStiffness, kDensity, 1e-3}, {kLength, kStiffness, kStiffness, kDensity, 1e-3}});
  club.shaft->damping_time = kDamping;
  HistorySetting& s = b.c.setting;
  s.channels = {{{.name = "lead_mm", .si = 1e-3}, Reading::lead, 0, kLength},
                {{.name = "lead_mid_mm", .si = 1e-3}, Reading::lead, 0, 0.5 * kLength}};
  if (declared)
    for (HistoryChannel& ch : s.channels) ch.declared = kNoise;
  b.c.records = {record(w)};
  BenchRecord drive{.times = b.c.records.front().times};
  b.model = std::make_unique<BenchHistory>(club, false, models::BenchOptions{.shear = false},
                                           BenchStart{.kind = start, .force = Vec3(kLoad, 0, 0)}, std::vector{drive},
                                           s.channels);
  std::tie(s.frequency, s.ratio) = b.model->first_mode();
  s.driven = start != Start::unknown;
  s.compliance = kLength / kStiffness;
  b.c.model = b.model.get();
  return b;
}

const ScoredCandidate& best(const LoopResult& r) { return r.candidates.front(); }

using Names = std::vector<std::string>;

TEST(Histories, NothingIsAdoptedWhereNothingIsHidden) {
  int adopted = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Bench b = bench({.seed = seed}, seed % 2 == 0);
    const LoopResult r = run(b.c);
    ASSERT_EQ(r.channels.size(), 2u);
    EXPECT_LT(r.channels[0].before.holdout_rmse, 1.3 * kNoise);
    adopted += !r.adopted.empty() || !r.ties.empty();
    EXPECT_EQ(r.verdict, Verdict::no_residual) << "seed " << seed;
  }
  EXPECT_EQ(adopted, 0);
}

TEST(Histories, ColouredNoiseIsNoEffect) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Bench b = bench({.colour = 0.8, .seed = seed}, false);
    const LoopResult r = run(b.c);
    EXPECT_TRUE(r.adopted.empty() && r.ties.empty()) << "seed " << seed;
    EXPECT_EQ(r.verdict, Verdict::no_residual) << "seed " << seed;
  }
}

struct HiddenInRecords {
  const char* effect;
  Truth truth;
  double value, tolerance;  ///< printed unit
};
void PrintTo(const HiddenInRecords& h, std::ostream* out) { *out << h.effect << ' ' << h.value; }

class HistoriesName : public testing::TestWithParam<HiddenInRecords> {};

TEST_P(HistoriesName, TheHiddenEffect) {
  const HiddenInRecords& h = GetParam();
  for (const bool declared : {true, false}) {
    const Bench b = bench(h.truth, declared);
    const LoopResult r = run(b.c);
    EXPECT_EQ(r.verdict, Verdict::explained);
    EXPECT_EQ(r.adopted, Names{h.effect});
    // The event happened: the base was wrong, the model that was adopted is not.
    ASSERT_EQ(r.channels.size(), 2u);
    const auto worst = [&](auto&& of) { return std::max(of(r.channels[0]), of(r.channels[1])); };
    EXPECT_GT(worst([](const ChannelResult& c) { return c.before.holdout_rmse; }), 2 * kNoise);
    EXPECT_LT(worst([](const ChannelResult& c) { return c.after.holdout_rmse; }), 1.2 * kNoise);
    ASSERT_EQ(best(r).candidate.effects, Names{h.effect});
    const Parameter& p = *best(r).candidate.fit.model.parameters().front();
    const double value = best(r).candidate.fit.p[0] / p.si, sd = best(r).sd[0] / p.si;
    EXPECT_NEAR(value, h.value, std::max(4 * sd, h.tolerance)) << best(r).candidate.fit.model.forms.front()->what;
  }
}

INSTANTIATE_TEST_SUITE_P(Effects, HistoriesName,
                         testing::Values(HiddenInRecords{"shaft-stiffness", {.stiffness = 1.5}, std::log(1.5), 1e-3},
                                         HiddenInRecords{"shaft-stiffness", {.stiffness = 0.93}, std::log(0.93), 1e-3},
                                         HiddenInRecords{"shaft-damping", {.ratio = 0.01}, 0.01, 1e-4},
                                         HiddenInRecords{"tip-mass", {.tip_mass = 0.008}, 8, 0.1},
                                         HiddenInRecords{"sensor-delay", {.delay = 4e-3}, 4, 0.02},
                                         HiddenInRecords{"sensor-gain", {.gain = 0.06}, 0.06, 1e-3}),
                         [](const auto& p) {
                           std::string name = p.param.effect;
                           std::erase(name, '-');
                           return name + std::to_string(p.index);
                         });

TEST(Histories, TwoEffectsAreBothNamed) {
  const Bench b = bench({.tip_mass = 0.01, .delay = 5e-3});
  const LoopResult r = run(b.c);
  EXPECT_EQ(r.verdict, Verdict::explained);
  EXPECT_EQ(r.adopted, (Names{"tip-mass", "sensor-delay"}));
}

TEST(Histories, WhatIsHeldOutCanBeTheEndOfARecord) {
  Bench b = bench({.tip_mass = 0.01});
  b.c.split.span = {1.0, 1.5};
  const LoopResult r = run(b.c);
  ASSERT_EQ(r.adopted, Names{"tip-mass"});
  for (const UsedRow& u : r.rows) EXPECT_EQ(u.holdout, b.c.records.front().times[std::size_t(u.row)] >= 1.0) << u.row;
  EXPECT_EQ(r.channels[0].before.holdout, 200);  // half a second of 400 Hz
  EXPECT_GT(r.channels[0].before.holdout_rmse, 3 * kNoise);
  EXPECT_LT(r.channels[0].after.holdout_rmse, 1.2 * kNoise);  // of 200 readings
}

TEST(Histories, WithAnUnknownStartFrequencyAndShapeStillTell) {
  // Nothing is known of the release: stiffness is seen in the frequencies alone, and one delay between the channels.
  const Bench stiff = bench({.stiffness = 1.3}, true, Start::unknown);
  const LoopResult r = run(stiff.c);
  EXPECT_NE(r.verdict, Verdict::unexplained);
  const bool named = r.adopted == Names{"shaft-stiffness"} ||
                     (!r.ties.empty() && std::ranges::count(r.ties.front(), "shaft-stiffness"));
  EXPECT_TRUE(named);
  const Bench late = bench({.delay = 4e-3}, true, Start::unknown);
  EXPECT_EQ(run(late.c).adopted, Names{"sensor-delay"});
}

TEST(Histories, AToneThatNoEffectHasIsUnexplainedInItsChannel) {
  for (const bool declared : {true, false}) {
    const Bench b = bench({.rate = 29}, declared);
    const LoopResult r = run(b.c);
    EXPECT_EQ(r.verdict, Verdict::unexplained);
    EXPECT_TRUE(r.adopted.empty());
    ASSERT_FALSE(r.unexplained.empty());
    EXPECT_EQ(r.unexplained.front().channel, "lead_mm");
    ASSERT_TRUE(r.unexplained.front().detail.starts_with("oscillation at ")) << r.unexplained.front().detail;
    EXPECT_NEAR(std::stod(r.unexplained.front().detail.substr(15)), 29, 0.5);
  }
}

TEST(Histories, NoiseThatIsNotTheDeclaredIsSaid) {
  Bench b = bench({});
  for (HistoryChannel& c : b.c.setting.channels) c.declared = kNoise / 2;
  const LoopResult r = run(b.c);
  EXPECT_EQ(r.verdict, Verdict::noise_contradicted);
}

TEST(Histories, AChannelThatEndsEarlyHasTheErrorOfItsReadings) {
  const Bench b = bench({});
  const HistoryProblem problem(*b.model, b.c.setting, b.c.records, Split{.holdout_fraction = 0});
  Eigen::MatrixXd noise = Eigen::MatrixXd::Random(problem.measured().rows(), problem.width());
  noise.col(1).tail(noise.rows() - 64).setConstant(NAN);
  EXPECT_DOUBLE_EQ(problem.scatter(0, noise, 0).error, 2 / std::sqrt(double(noise.rows())));
  EXPECT_DOUBLE_EQ(problem.scatter(1, noise, 0).error, 2 / std::sqrt(64.0));
}

TEST(Histories, ZeroParametersAreTheBaseBitForBit) {
  const Bench b = bench({});
  std::vector<Prediction> base, zero;
  ASSERT_TRUE(b.model->answer(TestSetup(2), base));
  const HistoryProblem problem(*b.model, b.c.setting, b.c.records, {});
  ASSERT_GT(problem.forms().size(), 8U);
  for (const Parametrisation& f : problem.forms()) {
    TestSetup setup(2);
    const std::vector<double> none(f.parameters.size(), 0.0);
    f.setup(none, setup);
    ASSERT_TRUE(b.model->answer(setup, zero));
    EXPECT_EQ((zero[0].value - base[0].value).cwiseAbs().maxCoeff(), 0.0) << f.effect;
    EXPECT_EQ(setup.gain[0] + setup.gain[1] + setup.offset[0] + setup.offset[1], 0.0);
  }
}

/// A club with its head on a bench that turns, released by a load in both planes and a twist: every effect acts.
struct Turning {
  std::vector<Parametrisation> forms;
  std::unique_ptr<BenchHistory> model;
  std::unique_ptr<HistoryProblem> problem;

  explicit Turning(Start start) {
    Club club;
    club.shaft = composite_shaft(
        {{0, kStiffness, 1.1 * kStiffness, kDensity, 1e-3}, {kLength, kStiffness, 1.1 * kStiffness, kDensity, 1e-3}});
    club.shaft->damping_time = kDamping;
    club.head = {.mass = 0.2,
                 .cg = Vec3(-0.02, 0.004, 0.006),
                 .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(),
                 .face = {0.3, 0.3}};
    HistorySetting setting;
    setting.channels = {{{.name = "lead_mm", .si = 1e-3, .declared = 0.2}, Reading::lead, 0, kLength},
                        {{.name = "droop_mm", .si = 1e-3, .declared = 0.2}, Reading::droop, 0, kLength},
                        {{.name = "twist_deg", .si = kRadPerDeg, .declared = 0.05}, Reading::twist, 0, kLength}};
    HistoryRecord record{.name = "tip.csv"};
    for (int i = 0; i < 300; ++i) record.times.push_back(0.004 * i);
    record.measured = Eigen::MatrixXd::Zero(300, 3);
    // What is left of it by a start that is fitted: the declared club's own record, shifted a little in time.
    BenchRecord drive{.times = record.times, .rotation_rate = 6};
    const models::BenchOptions options{.hub = 0.2};
    const BenchStart release{.kind = Start::release, .at = -0.1, .force = Vec3(3, 2, 0), .moment = Vec3(0, 0, 0.3)};
    std::vector<Prediction> as_declared;
    TestSetup late(3);
    late.club.bending = -0.1;
    EXPECT_TRUE(BenchHistory(club, true, options, release, {drive}, setting.channels).answer(late, as_declared));
    for (int c = 0; c < 3; ++c)
      record.measured.col(c) = as_declared.front().value.col(c) / setting.channels[std::size_t(c)].si;
    model = std::make_unique<BenchHistory>(club, true, options,
                                           start == Start::release ? release : BenchStart{.kind = start},
                                           std::vector{drive}, setting.channels);
    std::tie(setting.frequency, setting.ratio) = model->first_mode();
    setting.driven = start != Start::unknown;
    setting.head = setting.turning = true;
    setting.compliance = kLength / kStiffness;
    problem = std::make_unique<HistoryProblem>(*model, setting, std::vector{record}, Split{.holdout_fraction = 0});
    forms = problem->forms();
  }
};

TEST(Histories, DerivativesAgreeWithFinerDifferences) {
  constexpr double kFine =
      2.5e-4;  // of a scale: modes of the two planes that nearly meet bend a column within a few thousandths
  for (const Start start : {Start::release, Start::unknown}) {
    const Turning t(start);
    ASSERT_GT(t.forms.size(), 20U);
    std::set<std::string> acting, every;
    for (const Parametrisation& f : t.forms) {
      every.insert(f.effect);
      const Model m{{&f}};
      for (int k = 0; k < m.size(); ++k) {
        const Parameter& q = f.parameters[std::size_t(k)];
        // Inside the plausible range, and at its edge, where the base is.
        for (const double place : {0.3, 0.0}) {
          Eigen::VectorXd p = Eigen::VectorXd::Constant(m.size(), 0);
          p[k] = place * q.scale;
          const auto at = [&](double steps) {
            Eigen::VectorXd x = p, z;
            x[k] += steps * kFine * q.scale;
            EXPECT_TRUE(t.problem->whitened(Part::train, m, x, z));
            return z;
          };
          // Of fourth order; one-sided where zero is the least value.
          const bool edge = p[k] - 2 * kFine * q.scale < q.min;
          const Eigen::VectorXd reference =
              edge ? Eigen::VectorXd((-25 * at(0) + 48 * at(1) - 36 * at(2) + 16 * at(3) - 3 * at(4)) / (12 * kFine))
                   : Eigen::VectorXd((8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * kFine));
          const Eigen::VectorXd column = t.problem->jacobian(Part::train, m, p).col(k);
          if (reference.norm() > 1e-3) acting.insert(f.effect);
          EXPECT_LT((column - reference).norm(), 1e-4 * (reference.norm() + 1e-3))
              << f.effect << ", " << f.what << ", parameter " << k << " at " << place << " scales, start " << int(start)
              << ", norm " << reference.norm();
        }
      }
    }
    EXPECT_EQ(acting, every) << "start " << int(start);
  }
}

TEST(Histories, AModeThatNoChannelShowsIsNoUnknown) {
  // The droop plane moves alone when only its clamp yields: nothing that a lead channel reads may follow.
  const Bench b = bench({.stiffness = 1.02}, true, Start::unknown);
  const HistoryProblem problem(*b.model, b.c.setting, b.c.records, Split{.holdout_fraction = 0});
  const std::vector<Parametrisation> forms = problem.forms();
  const auto droop = std::ranges::find(forms, "in the droop plane", &Parametrisation::what);
  ASSERT_NE(droop, forms.end());
  ASSERT_EQ(droop->effect, "clamp-compliance");
  Eigen::VectorXd rigid, yields;
  ASSERT_TRUE(problem.whitened(Part::train, Model{}, {}, rigid));
  ASSERT_TRUE(problem.whitened(Part::train, Model{{&*droop}}, Eigen::VectorXd::Constant(1, droop->parameters[0].scale),
                               yields));
  EXPECT_GT(rigid.norm(), 10);  // there is a residual to be taken up
  EXPECT_LT((yields - rigid).norm(), 1e-4 * rigid.norm());
}

TEST(Histories, ASpikeIsFlaggedAndDoesNoHarm) {
  Bench b = bench({.gain = 0.06});
  b.c.records.front().measured(200, 1) += 30;
  b.c.records.front().measured(333, 0) = std::nan("");
  const LoopResult r = run(b.c);
  EXPECT_EQ(r.adopted, Names{"sensor-gain"});
  ASSERT_EQ(r.flagged.size(), 1u);
  EXPECT_EQ(r.flagged.front().row, 200);
  EXPECT_EQ(r.flagged.front().column, "lead_mid_mm");
}

}  // namespace
}  // namespace hosel::loop
