// Tuning: known parameters come back, and what the data cannot separate is said.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <random>

#include "app/job.hpp"
#include "build_info.hpp"
#include "golf/units.hpp"
#include "models/parameters.hpp"
#include "models/registry.hpp"
#include "solvers/least_squares.hpp"
#include "tests/app/command.hpp"

namespace hosel::app {
namespace {

/// A box of drives on the published test driver, drawn by the seed.
Blow drive(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  Blow b;
  b.club.head.mass = 0.204;
  b.club.head.cg = {-0.0423, 0.001, 0.0029};
  b.club.head.inertia = Vec3(2.843e-4, 4.085e-4, 5.679e-4).asDiagonal();
  b.club.head.face = {0.305, 0.305};
  b.delivery = {.club_speed = uniform(38, 52),
                .attack_angle = uniform(-0.05, 0.09),
                .club_path = uniform(-0.08, 0.08),
                .dynamic_loft = uniform(0.14, 0.3),
                .face_angle = uniform(-0.06, 0.06),
                .impact_toe = uniform(-0.02, 0.02),
                .impact_high = uniform(-0.012, 0.012)};
  return b;
}

struct Recovery {
  int joint = 0;            ///< seeds with the truth inside the two-sigma region
  double squares = 0;       ///< of the distances from the truth by the covariance that is told, summed over the seeds
  std::vector<int> single;  ///< per parameter: within two standard deviations
};

/// So many shots a seed, five channels with the noise of the specification's example.
Recovery recover(const char* model, const std::vector<std::pair<const char*, double>>& truth, double region, int seeds,
                 int shots) {
  const double noise[5] = {0.25, radians(0.2), radians(0.2), 60 * kRadPerSecPerRpm, 60 * kRadPerSecPerRpm};
  Recovery out;
  out.single.assign(truth.size(), 0);
  models::Options options;
  options.volumetric_solution.tolerance = 1e-5;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    std::vector<Blow> blows;
    for (int i = 0; i < shots; ++i) blows.push_back(drive(random));
    std::vector<solvers::Bounds> bounds;
    Eigen::VectorXd exact(truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      exact[static_cast<Eigen::Index>(i)] = truth[i].second;
      const double a = 0.5 * truth[i].second, b = 1.7 * truth[i].second;
      bounds.push_back({std::min(a, b), std::max(a, b)});
    }
    const auto launch = [&](const Eigen::VectorXd& p, const Blow& blow, double* v) {
      models::Options o = options;
      Blow b = blow;
      for (std::size_t i = 0; i < truth.size(); ++i)
        models::find_parameter(truth[i].first)->set(o, b, p[static_cast<Eigen::Index>(i)]);
      const Launch l = models::find(model)->make(o)->launch(b);
      v[0] = l.ball_speed(), v[1] = l.launch_angle(), v[2] = l.azimuth(), v[3] = l.backspin(), v[4] = l.sidespin();
    };
    Eigen::VectorXd measured(5 * shots);
    for (int i = 0; i < shots; ++i) {
      launch(exact, blows[static_cast<std::size_t>(i)], &measured[5 * i]);
      for (int c = 0; c < 5; ++c) measured[5 * i + c] += noise[c] * normal(random);
    }
    const auto residuals = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
      for (int i = 0; i < shots; ++i) {
        double v[5];
        launch(p, blows[static_cast<std::size_t>(i)], v);
        for (int c = 0; c < 5; ++c) r[5 * i + c] = (v[c] - measured[5 * i + c]) / noise[c];
      }
      return true;
    };
    const Eigen::VectorXd start = 1.25 * exact;
    const auto fit = solvers::least_squares(residuals, 5 * shots, start, bounds, {.starts = 1});
    const auto known = solvers::identifiability(fit.jacobian, bounds);
    const Eigen::VectorXd off = fit.parameters - exact;
    const Eigen::VectorXd sds = off.cwiseQuotient(known.sd);
    const double square = sds.dot(known.correlation.ldlt().solve(sds));
    out.joint += square <= region;
    out.squares += square;
    for (std::size_t i = 0; i < truth.size(); ++i)
      out.single[i] += std::abs(off[static_cast<Eigen::Index>(i)]) <= 2 * known.sd[static_cast<Eigen::Index>(i)];
  }
  return out;
}

/// Sliding friction that is set to what it is leaves the law as it is.
TEST(Tune, FrictionAtVanishingSlipKeepsItsRatio) {
  for (const char* name : {"volumetric_friction", "common_friction"}) {
    models::Options o;
    o.volumetric.friction = 0.37;
    o.volumetric.static_friction = 0.8;
    Blow b;
    const models::NamedParameter& p = *models::find_parameter(name);
    p.set(o, b, 0.37);
    EXPECT_DOUBLE_EQ(o.volumetric.static_friction, 0.8) << name;
    p.set(o, b, 0.74);
    EXPECT_DOUBLE_EQ(o.volumetric.static_friction, 1.6) << name;
    o.volumetric.static_friction = o.volumetric.friction;
    p.set(o, b, 0.1 + 0.2);
    EXPECT_EQ(o.volumetric.static_friction, o.volumetric.friction) << name;
  }
}

TEST(Tune, IntervalsCoverWhatTheyClaim) {
  // The two-sigma region of four parameters: chi-squared quantile at 0.9545. Two standard deviations hold 95.45 % of a
  // normal's draws; 400 seeds tell that to three sigma of a binomial, 3.1 %.
  const int seeds = 400;
  const Recovery r =
      recover("rigid-eccentric",
              {{"restitution", 0.84}, {"tangential_restitution", 0.15}, {"cg_x", -0.0423}, {"inertia_z", 5.679e-4}},
              9.716, seeds, 40);
  EXPECT_NEAR(r.joint, 0.9545 * seeds, 0.031 * seeds);
  for (const int inside : r.single) EXPECT_NEAR(inside, 0.9545 * seeds, 0.031 * seeds);
  for (std::size_t i = 0; i < r.single.size(); ++i) RecordProperty("of_400_" + std::to_string(i), r.single[i]);
}

/// Of a model that integrates. Fourteen seeds of three parameters are 42 squares of a normal's draws: the 0.1 and 99.9
/// % quantiles of chi-squared. They are less than a factor of 4 apart: no intervals twice too wide or too narrow pass.
TEST(Tune, KnownParametersComeBackVolumetric) {
  const Recovery r = recover(
      "volumetric", {{"volumetric_damping", 6.42e-3}, {"joint_stiffness", 40.0}, {"cg_x", -0.0423}}, 8.025, 14, 15);
  EXPECT_GT(r.squares, 19.24);
  EXPECT_LT(r.squares, 76.08);
}

TEST(LeastSquares, BlindDirectionIsNamed) {
  // r depends on a + b alone.
  const auto residuals = [](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
    for (int i = 0; i < 5; ++i) r[i] = (p[0] + p[1] - 1.0) * (i + 1) * 10;
    return true;
  };
  const std::vector<solvers::Bounds> bounds = {{0, 2}, {0, 2}};
  const auto fit = solvers::least_squares(residuals, 5, Eigen::Vector2d(0.2, 0.3), bounds, {.starts = 3});
  EXPECT_NEAR(fit.parameters.sum(), 1, 1e-6);
  const auto known = solvers::identifiability(fit.jacobian, bounds);
  ASSERT_EQ(known.blind.size(), 1u);
  EXPECT_NEAR(std::abs(known.blind[0][0]), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(known.blind[0][0], -known.blind[0][1], 1e-6);
  EXPECT_NEAR(known.correlation(0, 1), -1, 1e-9);
  EXPECT_GT(known.sd[0], 2);
}

TEST(LeastSquares, AnEndOfTheBoundsIsTold) {
  const std::vector<solvers::Bounds> bounds{{-1, 1}, {0, 10}, {0, 10}, {-3, 3}};
  const std::vector<bool> expected{false, true, true, false};
  EXPECT_EQ(solvers::at_bounds(Eigen::Vector4d(0, 9.995, 0, 2.9), bounds), expected);
}

TEST(LeastSquares, FewerDataThanParametersLeaveDirectionsBlind) {
  const Eigen::MatrixXd one{{3.0, 0.0}};
  const auto known = solvers::identifiability(one, {{0, 2}, {0, 2}});
  ASSERT_EQ(known.blind.size(), 1u);
  EXPECT_NEAR(std::abs(known.blind[0][1]), 1, 1e-12);
  EXPECT_NEAR(known.sd[0], 1 / 3.0, 1e-12);
  EXPECT_TRUE(std::isinf(known.sd[1]));
  EXPECT_TRUE(std::isinf(known.condition));
}

// ---- the kinds, end to end

nlohmann::json run(const std::filesystem::path& directory) {
  CaseFile file(directory);
  const auto job = read_job(file);
  Output out({.directory = directory / "out", .force = true, .quiet = true, .log = {}}, file.resolved());
  job->run(out);
  return nlohmann::json::parse(std::ifstream(directory / "out" / "summary.json"));
}

TEST(Tune, CaseTellsErrorsAndWhatCannotBeSeparated) {
  const auto d = test::fresh_directory("tune_case");
  std::ofstream(d / "case.toml") << R"(kind = "tune"
model = "rigid-planar"
[head]
mass_kg = 0.26
[data]
shots = "shots.csv"
[data.noise]
ball_speed_mps = 0.25
spin_rate_rpm = 60.0
[split]
train_fraction = 0.5
seed = 3
[[parameters]]
name = "restitution"
min = 0.5
max = 1.0
[[parameters]]
name = "restitution_slope"
min_s_per_m = -0.006
max_s_per_m = 0.0
[[parameters]]
name = "tangential_restitution"
min = -0.2
max = 0.8
)";
  std::ofstream shots(d / "shots.csv");
  shots << "shot,club_speed_mps,attack_angle_deg,dynamic_loft_deg,ball_speed_mps,spin_rate_rpm\n";
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 60; ++i) {
    Blow b;
    b.club.head.mass = 0.26;
    b.delivery = {.club_speed = 40 + 0.1 * normal(random),
                  .attack_angle = radians(-2),
                  .dynamic_loft = radians(20 + 4 * normal(random))};
    b.contact.restitution = 0.8;
    b.contact.tangential_restitution = 0.3;
    const Launch l = models::find("rigid-planar")->make({})->launch(b);
    shots << i + 1 << ',' << b.delivery.club_speed << ",-2," << degrees(b.delivery.dynamic_loft) << ','
          << l.ball_speed() + 0.25 * normal(random) << ',' << rpm(l.spin_rate()) + 60 * normal(random) << '\n';
  }
  shots.close();
  const nlohmann::json s = run(d);
  EXPECT_EQ(s["rows"]["train"], 30);
  EXPECT_EQ(s["rows"]["test"], 30);
  // One club speed: level and slope of the restitution are one direction.
  ASSERT_FALSE(s["inseparable"].empty());
  EXPECT_NE(s["inseparable"][0].get<std::string>().find("restitution_slope"), std::string::npos);
  EXPECT_GT(s["condition"].get<double>(), 10);
  const double et = s["parameters"][2]["value"], sd = s["parameters"][2]["sd"];
  EXPECT_NEAR(et, 0.3, 3 * sd);
  for (const auto& e : s["errors"])
    if (e["channel"] == "spin_rate_rpm") {
      EXPECT_GT(e["before"]["mae"].get<double>(), 500);
      EXPECT_LT(e["after"]["mae"].get<double>(), 90);
    }
  for (const char* name : {"parameters.csv", "correlation.csv", "errors.csv", "residuals.csv", "errors.png"})
    EXPECT_TRUE(std::filesystem::exists(d / "out" / name)) << name;
}

/// A parameter that moves nothing is told so, in a summary like any other.
TEST(Tune, WhatTheDataDoNotShowIsTold) {
  const auto d = test::fresh_directory("tune_blind");
  std::ofstream(d / "case.toml") << R"(kind = "tune"
model = "rigid-planar"
[head]
mass_kg = 0.26
[data]
shots = "shots.csv"
[data.noise]
ball_speed_mps = 0.25
[[parameters]]
name = "restitution"
min = 0.5
max = 1.0
[[parameters]]
name = "tangential_restitution"
min = -0.2
max = 0.8
)";
  std::ofstream shots(d / "shots.csv");
  shots << "shot,club_speed_mps,attack_angle_deg,dynamic_loft_deg,ball_speed_mps\n";
  for (int i = 0; i < 12; ++i) {
    Blow b;  // without a loft nothing is tangential
    b.club.head.mass = 0.26;
    b.delivery.club_speed = 40 + 0.5 * i;
    b.delivery.dynamic_loft = b.delivery.attack_angle = 0;
    b.contact.restitution = 0.8;
    shots << i + 1 << ',' << b.delivery.club_speed << ",0,0,"
          << models::find("rigid-planar")->make({})->launch(b).ball_speed() + (i % 2 ? 0.1 : -0.1) << '\n';
  }
  shots.close();
  const nlohmann::json s = run(d);
  EXPECT_NEAR(s["parameters"][0]["value"].get<double>(), 0.8, 0.01);
  EXPECT_TRUE(s["parameters"][0]["sd"].is_number());
  EXPECT_TRUE(s["parameters"][1]["sd"].is_null());
  EXPECT_TRUE(s["condition"].is_null());
  EXPECT_FALSE(s["blind"].empty());
}

TEST(Tune, AChannelThatIsOnlyComparedMovesNothing) {
  const auto d = test::fresh_directory("tune_compared");
  std::ofstream(d / "case.toml") << R"(kind = "tune"
model = "rigid-planar"
[head]
mass_kg = 0.26
[data]
shots = "shots.csv"
compared_only = ["spin_rate_rpm"]
[data.noise]
ball_speed_mps = 0.25
spin_rate_rpm = 60.0
[[parameters]]
name = "restitution"
min = 0.5
max = 1.0
)";
  std::vector<nlohmann::json> told;
  for (const double spin : {4000.0, 8000.0}) {
    std::ofstream shots(d / "shots.csv");
    shots << "shot,club_speed_mps,attack_angle_deg,dynamic_loft_deg,ball_speed_mps,spin_rate_rpm\n";
    for (int i = 0; i < 12; ++i) shots << i + 1 << ',' << 38 + i % 3 << ",-2,20," << 53 + i % 3 << ',' << spin << '\n';
    shots.close();
    told.push_back(run(d));
  }
  EXPECT_GT(told[0]["parameters"][0]["value"].get<double>(), 0.7);
  EXPECT_EQ(told[0]["parameters"][0]["value"], told[1]["parameters"][0]["value"]);
  EXPECT_NEAR(told[1]["errors"][1]["after"]["mean"].get<double>(),
              told[0]["errors"][1]["after"]["mean"].get<double>() - 4000, 1e-6);
}

/// A ball that the case's ground is too high for leaves the other rows their errors.
TEST(Tune, ABallThatDoesNotLandIsOneRow) {
  const auto d = test::fresh_directory("tune_lost");
  std::ofstream(d / "case.toml") << R"(kind = "tune"
model = "rigid-planar"
[head]
mass_kg = 0.26
[flight]
[flight.ground]
height_m = 11
[data]
shots = "shots.csv"
compared_only = ["carry_m"]
[data.noise]
ball_speed_mps = 0.25
carry_m = 2.0
[[parameters]]
name = "restitution"
min = 0.5
max = 1.0
[split]
train_fraction = 1
)";
  std::ofstream shots(d / "shots.csv");
  shots << "shot,club_speed_mps,attack_angle_deg,dynamic_loft_deg,ball_speed_mps,carry_m\n";
  for (int i = 0; i < 12; ++i)
    shots << i + 1 << ',' << 38 + i % 3 << ",-2," << (i == 5 ? 4 : 20) << ',' << 53 + i % 3 << ",150\n";
  shots.close();
  const nlohmann::json s = run(d);
  ASSERT_EQ(s["rows"]["train"], 12);
  ASSERT_EQ(s["errors"].size(), 2U) << s;
  for (const auto& e : s["errors"]) EXPECT_EQ(e["rows"], 11) << e;
}

/// Twelve shots whose `ball_type` is 1 or 2 in turn and whose `make` is a word.
std::filesystem::path chosen_shots(const char* name, const std::string& more) {
  const auto d = test::fresh_directory(name);
  std::ofstream(d / "case.toml")
      << "kind = \"tune\"\nmodel = \"rigid-planar\"\n[head]\nmass_kg = 0.26\n[data]\nshots = "
         "\"shots.csv\"\n[data.noise]\nball_speed_mps = 0.25\n[[parameters]]\nname = "
         "\"restitution\"\nmin = 0.5\nmax = 1.0\n[search]\nstarts = 1\n"
      << more;
  std::ofstream shots(d / "shots.csv");
  // In another order than that of the shots' numbers: the text belongs to its row.
  shots << "shot,club_speed_mps,attack_angle_deg,dynamic_loft_deg,ball_speed_mps,ball_type,make\n";
  for (int i = 12; i > 0; --i)
    shots << i << ',' << 38 + i % 3 << ",-2,20," << (i % 4 == 1 ? 50 : 56) << ',' << (i % 4 == 1 ? 1 : 2)
          << (i % 3 == 0 ? ",soft\n" : ",hard\n");
  return d;
}

double tuned_restitution(const nlohmann::json& told) { return told["parameters"][0]["value"]; }

std::string refused(const std::filesystem::path& directory) {
  try {
    run(directory);
  } catch (const InputError& e) { return e.what(); }
  return "";
}

TEST(Tune, RowsAreKeptByTheTextOfAColumnOfNumbers) {
  const std::string keep = "[[data.keep]]\ncolumn = \"ball_type\"\n";
  const auto all = run(chosen_shots("tune_keep_all", "")),
             slow = run(chosen_shots("tune_keep_text", keep + "equals = \"1\"\n")),
             same = run(chosen_shots("tune_keep_numbers", keep + "max = 1\n"));
  ASSERT_EQ(all["rows"]["train"].get<int>() + all["rows"]["test"].get<int>(), 12);
  EXPECT_EQ(slow["rows"]["train"].get<int>() + slow["rows"]["test"].get<int>(), 3);
  EXPECT_EQ(slow["left_out"]["ball_type outside what the case keeps"], 9);
  EXPECT_LT(tuned_restitution(slow), tuned_restitution(all) - 0.03);
  EXPECT_EQ(tuned_restitution(slow), tuned_restitution(same)) << "the rows whose number is 1";
  // A text and a bound both hold; another spelling of the number is another text.
  EXPECT_NE(refused(chosen_shots("tune_keep_both", keep + "equals = \"1\"\nmin = 2\n")).find("0 training rows"),
            std::string::npos);
  EXPECT_NE(refused(chosen_shots("tune_keep_spelt", keep + "equals = \"1.0\"\n")).find("0 training rows"),
            std::string::npos);
}

TEST(Tune, BoundsOnAColumnOfWordsAreRefused) {
  const std::string keep = "[[data.keep]]\ncolumn = \"make\"\n";
  const auto soft = run(chosen_shots("tune_words", keep + "equals = \"soft\"\n"));
  ASSERT_EQ(soft["rows"]["train"].get<int>() + soft["rows"]["test"].get<int>(), 4);
  for (const char* bound : {"min", "max"}) {
    const std::string said = refused(chosen_shots("tune_words", keep + "equals = \"soft\"\n" + bound + " = 3\n"));
    EXPECT_NE(said.find(std::string("data.keep[1].") + bound + ": 3: the column 'make'"), std::string::npos) << said;
    EXPECT_NE(said.find("case.toml:18"), std::string::npos) << said;
    EXPECT_NE(said.find("(allowed: equals)"), std::string::npos) << said;
  }
}

/// Twelve shots with a column of totals, which is compared only.
std::filesystem::path shots_with_totals(const std::string& header, const std::string& fourth) {
  const auto d = test::fresh_directory("tune_totals");
  std::ofstream(d / "case.toml") << R"(kind = "tune"
model = "rigid-planar"
[head]
mass_kg = 0.26
[flight.turf]
[data]
shots = "shots.csv"
compared_only = ["total_m"]
[data.noise]
ball_speed_mps = 0.25
total_m = 5.0
[[parameters]]
name = "restitution"
min = 0.5
max = 1.0
[search]
starts = 1
)";
  std::ofstream shots(d / "shots.csv");
  shots << "shot,club_speed_mps,attack_angle_deg,dynamic_loft_deg,ball_speed_mps," << header << '\n';
  for (int i = 0; i < 12; ++i)
    shots << i + 1 << ',' << 44 + i % 3 << ",-2,16," << 62 + i % 3 << ',' << (i == 3 ? fourth : std::to_string(230 + i))
          << '\n';
  return d;
}

/// A word makes a column one of words, and a number without a unit may be in yards.
TEST(Tune, AChannelNeedsAColumnOfNumbersInItsUnit) {
  EXPECT_EQ(refused(shots_with_totals("total_m", "233")), "");
  EXPECT_EQ(refused(shots_with_totals("total_m", "")), "");
  const std::string word = refused(shots_with_totals("total_m", "n/a")),
                    bare = refused(shots_with_totals("total", "9")), other = refused(shots_with_totals("total_s", "9"));
  EXPECT_NE(word.find("shots.csv:5: column 'total_m': 'n/a' is not a number"), std::string::npos) << word;
  EXPECT_NE(bare.find("shots.csv:1: column 'total' needs a unit of length"), std::string::npos) << bare;
  EXPECT_NE(other.find("shots.csv:1: column 'total_s' needs a unit of length"), std::string::npos) << other;
}

TEST(Tune, NoiseHasAUnitOfItsChannel) {
  const auto d = chosen_shots("tune_noise", "");
  std::string text = test::content(d / "case.toml");
  text.replace(text.find("ball_speed_mps = 0.25"), 21, "ball_speed_kg = 0.25 ");
  test::write(d / "case.toml", text);
  EXPECT_NE(refused(d).find("ball_speed_kg"), std::string::npos) << refused(d);
}

TEST(Tune, AnEndOfAParameterIsItselfInAnyUnit) {
  const std::string mass = "[[parameters]]\nname = \"head_mass\"\n";
  CaseFile file(chosen_shots("tune_grams", mass + "min_g = 150\nmax_g = 350\n"));
  EXPECT_NO_THROW(read_job(file));
  EXPECT_NE(refused(chosen_shots("tune_grams", mass + "max_g = 350.001\n")).find("350.001 is out of range"),
            std::string::npos);
}

TEST(Tune, ErrorsOfRecordedAnglesEndAtARoundOne) {
  const std::string loft = "[[parameters]]\nname = \"loft_error\"\n";
  const auto inside = chosen_shots("tune_loft_error", loft + "min_deg = -10\nmax_deg = 10\n");
  EXPECT_EQ(test::command("check " + inside.string()).status, 0);
  const std::string said = refused(chosen_shots("tune_loft_error", loft + "max_deg = 10.5\n"));
  EXPECT_NE(said.find("-10 to 10 deg"), std::string::npos) << said;
}

TEST(Tune, AStartOutsideItsBoundsIsRefused) {
  const std::string said = refused(
      chosen_shots("tune_start", "[[parameters]]\nname = \"head_mass\"\nmin_g = 180\nmax_g = 220\nstart_g = 230\n"));
  EXPECT_NE(said.find("parameters[2].start_g: 0.23 lies outside the bounds of the fit (0.18 to 0.22 kg)"),
            std::string::npos)
      << said;
}

/// The case's own value is the first guess: where it is none, a guess is asked for.
TEST(Tune, ACaseOutsideTheBoundsAsksForAStart) {
  const std::string mass = "[[parameters]]\nname = \"head_mass\"\nmin_g = 180\nmax_g = 220\n";  // the head has 260 g
  const std::string said = refused(chosen_shots("tune_default_start", mass));
  EXPECT_NE(
      said.find("parameters[2].name: 'head_mass' is 0.26 in the case, outside the bounds of the fit (0.18 to 0.22 "
                "kg): state a `start`"),
      std::string::npos)
      << said;
  const auto stated = chosen_shots("tune_stated_start", mass + "start_g = 200\n");
  EXPECT_EQ(test::command("check " + stated.string()).status, 0);
}

/// A ball that is faster than any blow makes it stays in, and its row is named.
TEST(Tune, AShotThatNoBlowMakesIsDoubted) {
  const auto d = chosen_shots("tune_implausible", "");
  std::ofstream(d / "shots.csv", std::ios::app) << "13,38,-2,20,76,2,hard\n14,38,-2,88,50,2,hard\n";
  const nlohmann::json s = run(d);
  ASSERT_EQ(s["rows"]["train"].get<int>() + s["rows"]["test"].get<int>(), 14);
  const std::string doubts = s["doubts"].dump();
  EXPECT_NE(doubts.find("1 of 14 shots: ball speed over club speed is 2 at the worst"), std::string::npos) << doubts;
  EXPECT_NE(doubts.find("1 of 14 shots: dynamic loft is 88 deg at the worst"), std::string::npos) << doubts;
  EXPECT_NE(doubts.find("shots.csv:14"), std::string::npos) << doubts;
}

TEST(Tune, AllRowsMayBeFitted) {
  const auto s = run(chosen_shots("tune_all", "[split]\ntrain_fraction = 1\n"));
  ASSERT_EQ(s["rows"]["train"], 12);
  ASSERT_EQ(s["rows"]["test"], 0);
  ASSERT_EQ(s["errors"].size(), 1U);
  EXPECT_EQ(s["errors"][0]["set"], "train");
  EXPECT_LT(s["errors"][0]["after"]["mae"].get<double>(), 4);
}

TEST(Tune, ALoadedClubStartsAsInABlow) {
  const std::string club = R"(
[head]
mass_kg = 0.204
cg_mm = [-42.3, 1.0, 2.9]
inertia_kg_m2 = [[2.843e-4, 0, 0], [0, 4.085e-4, 0], [0, 0, 5.679e-4]]
bulge_mm = 305.0
roll_mm = 305.0
[shaft]
name = "composite-driver"
[hosel]
position_mm = [-15.0, 55.0, 10.0]
[volumetric]
published = "driver"
)";
  const std::string hands = "[grip]\nforce_N = [-55, 2, 332]\nmoment_N_m = [-1, 40, -1]\n";
  const auto d = test::fresh_directory("tune_loaded");
  std::ofstream table(d / "shots.csv");
  table << std::setprecision(12) << "shot,club_speed_mps,dynamic_loft_deg,ball_speed_mps,backspin_rpm\n";
  for (const int speed : {41, 43, 45, 47}) {
    std::filesystem::create_directories(d / "blow");
    std::ofstream(d / "blow" / "case.toml")
        << "kind = \"impact\"\nmodels = [\"shaft-coupled\"]\n"
        << club << hands << "[delivery]\nclub_speed_mps = " << speed << "\ndynamic_loft_deg = 14\n";
    const nlohmann::json launch = run(d / "blow")["models"]["shaft-coupled"];
    table << speed << ',' << speed << ",14," << launch["ball_speed_mps"].get<double>() << ','
          << launch["backspin_rpm"].get<double>() << '\n';
  }
  table.close();
  std::vector<double> off;
  for (const std::string& held : {hands, std::string{}}) {
    std::ofstream(d / "case.toml") << "kind = \"tune\"\nmodel = \"shaft-coupled\"\n"
                                   << club << held << R"([data]
shots = "shots.csv"
[data.noise]
ball_speed_mps = 0.25
backspin_rpm = 60.0
[search]
starts = 1
[[parameters]]
name = "volumetric_damping"
min_s_per_m = 0.0
max_s_per_m = 3.0e-2
)";
    const nlohmann::json told = run(d);
    for (const auto& e : told["errors"])
      if (e["channel"] == "backspin_rpm" && e["set"] == "train") off.push_back(e["before"]["mae"].get<double>());
  }
  ASSERT_EQ(off.size(), 2U);
  EXPECT_LT(off[0], 1e-6);  // the same blows, written with twelve digits
  EXPECT_GT(off[1], 20);    // what the hands change in them
}

TEST(RollingIrons, FiguresOfTheSecondSource) {
  // [@rolling-irons], to the digits printed there.
  const auto ran = [](const char* name, const char* what) {
    const auto d = test::fresh_directory(name);
    std::filesystem::copy(std::filesystem::path(HOSEL_SOURCE_DIR) / "cases" / what, d,
                          std::filesystem::copy_options::recursive);
    return run(d);
  };
  const nlohmann::json clubs = ran("rolling_irons", "rolling-irons"),
                       theory = ran("rolling_theory", "rolling-irons/theory");
  const auto bias = [&](const char* output) {
    for (const auto& d : clubs["compare"]["differences"])
      if (d["output"] == output) return std::pair{d["mean"].get<double>(), d["rms"].get<double>()};
    return std::pair<double, double>{NAN, NAN};
  };
  EXPECT_NEAR(bias("spin_rate_rpm").first, -2103, 0.5);
  EXPECT_NEAR(bias("spin_rate_rpm").second, 2161, 0.5);
  EXPECT_NEAR(bias("launch_angle_deg").first, 1.330, 5e-4);
  EXPECT_NEAR(bias("ball_speed_mph").first, -0.592, 5e-4);
  EXPECT_EQ(theory["statements"][0]["share"], 1.0);  // spin over sin(loft): 11205.4 and 11119.7 rpm
  EXPECT_EQ(theory["statements"][1]["verdict"], "holds");
  EXPECT_NEAR(theory["range"]["launch_angle_deg"][1].get<double>(), 44.684, 5e-4);  // of the other ball; own 44.683
}

/// Without speed and loft there is no blow; what else no column says is zero, and that is told.
TEST(Tune, AnAbsentColumnIsNoSilentZero) {
  const auto d = test::fresh_directory("tune_absent");
  const auto tuned = [&](const std::string& columns, const std::string& cells) {
    test::write(d / "shots.csv", "shot," + columns + ",ball_speed_mps\n1," + cells + ",60\n2," + cells + ",61\n");
    test::write(d / "case.toml",
                "kind = \"tune\"\nmodel = \"rigid-planar\"\n[head]\nmass_kg = 0.2\n[data]\nshots = "
                "\"shots.csv\"\n[data.noise]\nball_speed_mps = 0.5\n[split]\ntrain_fraction = 1\n"
                "[[parameters]]\nname = \"restitution\"\n");
    return test::command("run " + d.string() + " --force --out " + (d / "out").string());
  };
  test::expect_refused(tuned("club_speed_mps,attack_angle_deg", "45,0"), "no column for dynamic_loft");
  test::expect_refused(tuned("dynamic_loft_deg,attack_angle_deg", "12,0"), "no column for club_speed");
  const test::Outcome o = tuned("club_speed_mps,dynamic_loft_deg,impact_toe_mm,impact_high_mm", "45,12,1,1");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("warning: shots.csv has no column for attack_angle, club_path, face_angle: zero in every shot"),
            std::string::npos)
      << o.text;
  // Of several sets none is the one: each shot has its loft, and nothing is swung.
  test::write(d / "case.toml",
              "kind = \"tune\"\nmodel = \"rigid-eccentric\"\n[head]\nname = \"driver-460\"\n[ball]\n"
              "model = \"tour\"\n");
  test::expect_refused(test::command("check " + d.string()), "each shot has a loft of its own: say which by `reduced`");
}

}  // namespace
}  // namespace hosel::app
