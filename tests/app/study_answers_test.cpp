// What a study tells of its points: none goes missing without a word, and nothing is named or counted as what it is
// not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "command.hpp"
#include "csv_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

const std::string kBlow = R"([delivery]
club_speed_mps = 45.0
dynamic_loft_deg = 12.0
[head]
mass_kg = 0.2
cg_mm = [-35.0, 0.0, 0.0]
inertia_kg_m2 = [[3.7e-4, 0, 0], [0, 2.9e-4, 0], [0, 0, 4.8e-4]]
)";
const std::string kMasses = "[[axis]]\nkey = \"head.mass_kg\"\nvalues = [0.19, 0.2]\n";

std::string study(const std::string& top, const std::string& tables = kMasses) {
  return "kind = \"study\"\nmodels = [\"rigid-eccentric\"]\noutputs = [\"ball_speed_mps\"]\n" + top + tables + kBlow;
}

/// The study runs in the folder; its status and what it said.
Outcome run(const fs::path& dir, const std::string& text, const std::string& options = "") {
  write(dir / "case.toml", text);
  return command("run '" + dir.string() + "' --force --out '" + (dir / "out").string() + "' " + options);
}

nlohmann::json summary(const fs::path& dir) { return nlohmann::json::parse(content(dir / "out" / "summary.json")); }

void refused(const std::string& text, const std::string& says) {
  const fs::path dir = fresh_directory("study_refused");
  write(dir / "case.toml", text);
  const Outcome o = command("check '" + dir.string() + "'");
  expect_refused(o, says);
}

TEST(StudyAnswers, AFormulaIsOneConditionThatAssignsNothing) {
  const auto statement = [](const std::string& where) {
    return study("",
                 kMasses + "[[statement]]\ntext = \"s\"\nholds = \"ball_speed_mps > 0\"\nwhere = \"" + where + "\"\n");
  };
  const fs::path dir = fresh_directory("study_formula");
  ASSERT_EQ(run(dir, statement("mass_kg == 0.19 && ball_speed_mps <= max(99, 1) && mass_kg != 0")).status, 0);
  EXPECT_EQ(summary(dir)["statements"][0]["points"], 1);
  refused(statement("mass_kg = 0.19"), "equality is `==`");
  refused(statement("ball_speed_mps > 65,5"), "decimals have a point");
}

TEST(StudyAnswers, WhatIsGivenTwiceIsRefused) {
  const std::string twice = "[[variant]]\nname = \"v\"\nset = [\"head.mass_g=190\", \"head.mass_kg=0.2\"]\n";
  refused(study("", twice), "variant[1].set: gives one quantity twice: 'head.mass_g=190' and 'head.mass_kg=0.2'");
  refused(study("", "[[axis]]\nkey = \"head.mass_kg\"\nvalues = [0.2, 0.19, 0.2]\n"),
          "axis[1].values: 0.2 is there twice");
  refused(study("", "[[variant]]\nname = \"v\"\nset = []\n[[part]]\nname = \"p\"\nof = \"v\"\nminus = \"v\"\n"),
          "part[1].minus: is the variant of `of`");
}

TEST(StudyAnswers, TitlesAndSentencesHaveTheirUnits) {
  const fs::path dir = fresh_directory("study_titles");
  const Outcome o = run(
      dir, std::string(study("")).replace(study("").find("[\"ball_speed_mps\"]"), 18,
                                          "[\"ball_speed_mps\", \"normal_impulse_N_s\"]") +
               "[[variant]]\nname = \"a\"\nset = []\n[[variant]]\nname = \"b\"\nset = []\n[[part]]\nname = \"p\"\n"
               "of = \"a\"\nminus = \"b\"\n[compare]\nwith = \"variant\"\nvariant = \"a\"\nby = \"head.mass_kg\"\n");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("p: no difference in ball speed, normal impulse\n"), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("each variant minus a, mass 0.19 kg"), std::string::npos) << o.text;
}

/// Status 2 at once, and not when every point was computed.
TEST(StudyAnswers, AMisspeltOutputOfACaseIsToldAtTheFirstPoint) {
  const fs::path dir = fresh_directory("study_misspelt");
  write(dir / "blow/case.toml", "kind = \"impact\"\nmodels = [\"rigid-eccentric\"]\n" + kBlow);
  write(dir / "study/case.toml",
        "kind = \"study\"\ncase = \"../blow\"\noutputs = [\"models.rigid-eccentric.ball_sped_mps\"]\n[[axis]]\nkey = "
        "\"delivery.impact_toe_mm\"\nrange = [-20, 20]\ncount = 200\n");
  const Outcome o = command("run '" + (dir / "study").string() + "' --quiet --out '" + (dir / "out").string() + "'");
  expect_refused(o,
                 "has no number 'models.rigid-eccentric.ball_sped_mps' in its summary; did you mean "
                 "'models.rigid-eccentric.ball_speed_mps'?");
  const std::string points = content(dir / "out/shards/1-of-1/points.jsonl");
  EXPECT_LT(std::ranges::count(points, '\n'), 50);
}

TEST(StudyAnswers, WhatIsNoQuantityOfItsOwnIsRefused) {
  refused(study("matched_launch = true\n", kMasses + "[measured]\nlaunch_angle_deg = [10, 14]\n"), "a range");
  refused(study("matched_launch = true\n", kMasses + "[measured]\nlaunch_angle_mps = 0.2\n"), "is no angle");
  refused(study("", kMasses + "[measured]\nball_speed_mph = 150\nball_speed_kmh = 240\n"), "are one quantity");
  refused(study("keep_bounce_mps = 40\n"), "no model has one");
  const std::string solve =
      "[[solve]]\nname = \"v\"\nkey = \"delivery.club_speed_mps\"\nrange = [20, 60]\n"
      "output = \"ball_speed_mps\"\nvalue = 60\n";
  const std::string again =
      "[[solve]]\nname = \"w\"\nkey = \"delivery.club_speed_mph\"\nrange = [60, 130]\n"
      "output = \"ball_speed_mps\"\nvalue = 70\n";
  refused(study("", kMasses + solve + again), "is sought twice");
  const fs::path dir = fresh_directory("study_sought");
  write(dir / "case.toml", study("", kMasses + solve));
  ASSERT_EQ(command("check '" + dir.string() + "'").status, 0);
  const Outcome o = command("check '" + dir.string() + "' --set delivery.club_speed_mph=77");
  expect_refused(o, "set to one value");
  const std::string regression = "[regression]\nshots = \"not/there.csv\"\non = [\"impact_toe_mm\"]\nof = ";
  refused(study("", kMasses + regression + "[\"launch_angle_m\"]\n"), "launch_angle_m");
  refused(study("", kMasses + std::regex_replace(regression, std::regex("toe_mm"), "toe_s") + "[\"ball_speed_mps\"]\n"),
          "impact_toe_s");
  refused(study("", kMasses +
                        "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"b\"\n[[population]]\nname = \"p\"\n"
                        "file = \"not/there.csv\"\ngiven = \"variant\"\ngiven_measured = \"x\"\n[population.measured]\n"
                        "ball_speed_mps = \"y\"\n"),
          "holds words");
}

TEST(StudyAnswers, StrikesOffTheFaceAreCounted) {
  const fs::path dir = fresh_directory("study_off_face");
  const std::string text =
      study("figures = false\n", "[[axis]]\nkey = \"delivery.impact_toe_mm\"\nvalues = [0, 60, 80, 90]\n");
  const Outcome o = run(dir, text);
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("2 of 4 points are struck off the face. The first, impact toe 80 mm: the ball is struck off"),
            std::string::npos)
      << o.text;
  const Outcome heel = run(dir, std::regex_replace(text, std::regex("0, 60, 80, 90"), "-80, 0"));
  EXPECT_NE(heel.text.find("80 mm towards the heel"), std::string::npos) << heel.text;
  EXPECT_EQ(run(dir, text, "--strict").status, 3);
}

/// What prints as one number goes with no parameter, in the sentence and in the table.
TEST(StudyAnswers, AConstantAnswerGoesWithNothing) {
  const fs::path dir = fresh_directory("study_constant");
  const std::string axes = kMasses + "[[axis]]\nkey = \"delivery.impact_toe_mm\"\nvalues = [-10, 0, 10]\n[flight]\n";
  const Outcome o = run(dir, "figures = false\n" + std::regex_replace(study("", axes), std::regex("\"ball_speed_mps\""),
                                                                      "\"club_speed_mps\", \"side_m\""));
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_TRUE(std::regex_search(o.text, std::regex("club speed \\[m/s\\] +45 +45 +45 +- +-"))) << o.text;
  EXPECT_EQ(content(dir / "out/sensitivity.csv").find("club_speed"), std::string::npos);
  // A full factorial knows its shares: nothing is said of points left out.
  EXPECT_NE(o.text.find("Side [m] goes most with impact toe"), std::string::npos) << o.text;
  EXPECT_EQ(o.text.find("at points left out"), std::string::npos) << o.text;
}

TEST(StudyAnswers, OneNameIsOfOneColumn) {
  const std::string solve =
      "[[solve]]\nname = \"NAME\"\nkey = \"delivery.club_speed_mps\"\nrange = [20, 60]\n"
      "output = \"ball_speed_mps\"\nvalue = 60\n";
  refused(study("", kMasses + std::regex_replace(solve, std::regex("NAME"), "ball_speed_mps")), "is an output too");
  refused(study("", std::regex_replace(kMasses, std::regex("key"), "name = \"ball_speed_mps\"\nkey")),
          "is a column of the design too");
}

/// A ball that no moduli bring to the bounce of the first is without an answer.
TEST(StudyAnswers, ABounceThatCannotBeKeptIsNoAnswer) {
  const fs::path dir = fresh_directory("study_bounce");
  const std::string text = R"(kind = "study"
models = ["fe-free-body"]
outputs = ["ball_speed_mps", "wall_restitution"]
keep_bounce_mps = 30
accuracy = "look"
figures = false
[[ball.layers]]
c10_MPa = 14
bulk_MPa = 2000
branch_moduli_MPa = [60]
branch_times_ms = [0.05]
[contact]
face_friction = 0.3
[[variant]]
name = "as it is"
[[variant]]
name = "softer"
set = ["ball.layers[1].branch_moduli_MPa=[50]"]
[[variant]]
name = "elastic"
set = ["ball.layers[1].branch_times_ms=[50]"]
)" + kBlow;
  const Outcome o = run(dir, text);
  EXPECT_NE(o.text.find("keep_bounce"), std::string::npos) << o.text;
  const CsvFile points(dir / "out" / "points.csv");
  ASSERT_EQ(points.rows(), 3u) << o.text;
  EXPECT_NEAR(points.number("wall_restitution", 1), points.number("wall_restitution", 0), 1.5e-3);
  EXPECT_EQ(points.text("ball_speed_mps", 2), "");
}

/// Balls that do not rise to the landing are in no mean, are out of the fairway, and are told.
TEST(StudyAnswers, BallsThatDoNotLandAreTold) {
  const fs::path dir = fresh_directory("study_missing");
  const std::string text = std::regex_replace(study("figures = false\n", R"([[axis]]
key = "delivery.dynamic_loft_deg"
values = [4, 8, 12, 16, 20]
[[axis]]
key = "delivery.face_angle_deg"
values = [-2, 0, 2]
[landing]
fairway_m = 60
[flight]
[flight.ground]
height_m = 11
)"),
                                              std::regex("\"ball_speed_mps\""),
                                              "\"ball_speed_mps\", \"carry_m\", \"side_m\"");
  const Outcome o = run(dir, text);
  ASSERT_EQ(o.status, 0) << o.text;
  const CsvFile points(dir / "out" / "points.csv");
  ASSERT_EQ(points.rows(), 15u);
  const auto missing = std::ranges::count(points.texts("carry_m"), "");
  ASSERT_GT(missing, 0);
  ASSERT_LE(missing, 9);
  EXPECT_NE(o.text.find("carry_m: " + std::to_string(missing) + " of 15 points have none"), std::string::npos)
      << o.text;
  const auto landing = summary(dir)["landing"]["rigid-eccentric"];
  EXPECT_EQ(landing["balls"], 15);
  EXPECT_EQ(landing["landed"], 15 - missing);
  EXPECT_NEAR(landing["fairway_share"].get<double>(), double(15 - missing) / 15, 1e-12);
  EXPECT_FALSE(fs::exists(dir / "out" / "figures" / "landing.png"));
  EXPECT_EQ(run(dir, text, "--strict").status, 3);
}

/// Balls that scatter most to the sides: the longer axis lies across.
TEST(StudyAnswers, TheLongerAxisOfTheEllipseIsWhereItLies) {
  const fs::path dir = fresh_directory("study_across");
  const std::string text = std::regex_replace(study("figures = false\n", R"([sample]
points = 40
seed = 3
[[axis]]
key = "delivery.face_angle_deg"
mean = 0
sd = 3
[landing]
fairway_m = 30
draws = 0
[flight]
units = "metres"
)"),
                                              std::regex("\"ball_speed_mps\""), "\"carry_m\", \"side_m\"");
  const Outcome o = run(dir, text);
  ASSERT_EQ(o.status, 0) << o.text;
  const auto landing = summary(dir)["landing"]["rigid-eccentric"];
  ASSERT_GT(landing["side_sd_m"].get<double>(), 2 * landing["carry_sd_m"].get<double>());
  EXPECT_GT(landing["ellipse_length_m"].get<double>(), landing["ellipse_width_m"].get<double>());
  std::smatch said;
  ASSERT_TRUE(
      std::regex_search(o.text, said,
                        std::regex("The axes of the ellipse for 95 % are ([0-9]+) and ([0-9]+) m, the longer one "
                                   "([0-9]+) deg from the target line\\.")))
      << o.text;
  EXPECT_GT(std::stod(said[1]), std::stod(said[2]));
  EXPECT_GT(std::stod(said[3]), 60);
  EXPECT_EQ(o.text.find(" m long"), std::string::npos) << o.text;
}

/// One table has one unit of length, that which was asked for.
TEST(StudyAnswers, MapsOfOneTableHaveItsUnit) {
  const fs::path dir = fresh_directory("study_map_units");
  const std::string text = study("figures = false\n", R"([grid]
columns = 3
rows = 3
[[variant]]
name = "yards"
[[variant]]
name = "metres"
set = ["flight.units='metres'"]
[flight]
)");
  const auto carries = [&](const std::string& column) {
    const CsvFile map(dir / "out" / "face_map.csv");
    EXPECT_EQ(map.rows(), 18u);
    std::vector<double> all = map.numbers(column);
    for (std::size_t p = 0; p < 9; ++p) EXPECT_EQ(all[p], all[p + 9]);
    return all.front();
  };
  ASSERT_EQ(run(dir, text).status, 0);
  const double yards = carries("carry_yd");
  ASSERT_EQ(run(dir, text, "--units metric").status, 0);
  EXPECT_NEAR(carries("carry_m"), 0.9144 * yards, 1e-6 * yards);
}

/// From 179 to -179 deg are two degrees, in a part as in a comparison, and in radians.
TEST(StudyAnswers, PartsGoTheShorterWayRound) {
  const fs::path dir = fresh_directory("study_circle");
  const Outcome o = run(dir, R"(kind = "study"
outputs = ["spin_axis_deg", "ball_speed_mps", "spin_axis_rad"]
figures = false
[[variant]]
name = "a"
set = ["launch.spin_axis_deg=179"]
[[variant]]
name = "b"
set = ["launch.spin_axis_deg=-179"]
[[part]]
name = "p"
of = "b"
minus = "a"
[compare]
with = "variant"
variant = "a"
[launch]
ball_speed_mps = 60
launch_angle_deg = 10
spin_rate_rpm = 2500
)");
  ASSERT_EQ(o.status, 0) << o.text;
  const CsvFile parts(dir / "out" / "parts.csv"), differences(dir / "out" / "differences.csv");
  EXPECT_NEAR(parts.number("spin_axis_deg", 0), 2, 1e-9);
  EXPECT_NEAR(parts.number("spin_axis_rad", 0), 0.0349066, 1e-7);
  EXPECT_NE(o.text.find("change\n"), std::string::npos) << "at one place there is no mean: " << o.text;
  // What is the same in both is said once, not shown as zeros.
  EXPECT_EQ(parts.number("ball_speed_mps", 0), 0);
  EXPECT_NE(o.text.find("p: no difference in ball speed\n"), std::string::npos) << o.text;
  EXPECT_EQ(o.text.find("ball speed [m/s]  +0"), std::string::npos) << o.text;
  for (std::size_t i = 0; i < differences.rows(); ++i)
    if (differences.text("output", i) == "spin_axis_rad" && differences.number("largest", i) != 0) {
      EXPECT_NEAR(differences.number("largest", i), 0.0349066, 1e-7);
    }
}

/// One speed in two units: what the variants differ by is round-off, in the tables.
TEST(StudyAnswers, RoundOffIsShownAsZero) {
  const fs::path dir = fresh_directory("study_zero");
  const Outcome o = run(dir, R"(kind = "study"
models = ["rigid-eccentric"]
outputs = ["ball_speed_mps", "sidespin_rpm"]
figures = false
[[variant]]
name = "a"
[[variant]]
name = "b"
set = ["delivery.club_speed_mph=100.66213314244811"]
[[part]]
name = "p"
of = "b"
minus = "a"
[[axis]]
key = "delivery.impact_toe_mm"
values = [-10, -7, -3, 3, 7, 10]
[delivery]
club_speed_mps = 45
dynamic_loft_deg = 12
[head]
name = "driver-460"
)");
  ASSERT_EQ(o.status, 0) << o.text;
  const CsvFile parts(dir / "out" / "parts.csv");
  double most = 0;
  for (std::size_t i = 0; i < parts.rows(); ++i) most = std::max(most, std::abs(parts.number("sidespin_rpm", i)));
  ASSERT_GT(most, 0) << "there is round-off";
  ASSERT_LT(most, 1e-9);
  EXPECT_FALSE(std::regex_search(o.text, std::regex("[0-9]e-1[0-9]|[ -]-0[ \n]"))) << o.text;
}

/// A curve that turns is told by its turning point too, a straight one by its ends.
TEST(StudyAnswers, SaysWhereACurveTurns) {
  const fs::path dir = fresh_directory("study_turns");
  const std::string masses = "[[axis]]\nkey = \"head.mass_kg\"\nvalues = [0.199, 0.2, 0.201]\n";
  const auto said = [&](const std::string& toes) {
    const Outcome o =
        run(dir, study("", masses + "[[axis]]\nkey = \"delivery.impact_toe_mm\"\nvalues = " + toes + "\n"));
    EXPECT_EQ(o.status, 0) << o.text;
    return o.text;
  };
  const std::regex sentence(
      "Ball speed \\[m/s\\] goes most with impact toe \\[mm\\]: .*, from ([0-9.]+) (through "
      "([0-9.]+) )?to ([0-9.]+) over its range\\.");
  std::smatch found;
  // The ball is fastest from the centre.
  const std::string both_sides = said("[-20, -10, 0, 10, 20]"), one_side = said("[0, 5, 10, 15, 20]");
  ASSERT_TRUE(std::regex_search(both_sides, found, sentence)) << both_sides;
  ASSERT_TRUE(found[2].matched) << found.str();
  EXPECT_GT(std::stod(found[3]), std::max(std::stod(found[1]), std::stod(found[4])));
  ASSERT_TRUE(std::regex_search(one_side, found, sentence)) << one_side;
  EXPECT_FALSE(found[2].matched) << found.str();
  EXPECT_GT(std::stod(found[1]), std::stod(found[4]));
}

/// Two parameters that rise together: neither is named as the one that moves the answer.
TEST(StudyAnswers, NamesNoParameterThatVariesWithAnother) {
  const fs::path dir = fresh_directory("study_together");
  const auto said = [&](const std::string& lofts) {
    std::string rows = "delivery.club_speed_mps,delivery.dynamic_loft_deg\n";
    for (int i = 0; i < 6; ++i) rows += std::to_string(40 + i) + "," + lofts[std::size_t(i)] + "\n";
    write(dir / "rows.csv", rows);
    const Outcome o = run(dir, study("", "[rows]\nfile = \"rows.csv\"\n"));
    EXPECT_EQ(o.status, 0) << o.text;
    return o.text;
  };
  EXPECT_NE(said("345678").find("These points do not tell what moves ball speed [m/s] most: "), std::string::npos);
  EXPECT_NE(said("583647").find("Ball speed [m/s] goes most with club speed [m/s]:"), std::string::npos);
}

/// A key that no model of the study reads: said, where the design's combinations are all there.
TEST(StudyAnswers, SaysWhatChangesNoAnswer) {
  const fs::path dir = fresh_directory("study_idle");
  const auto said = [&](const std::string& key) {
    const Outcome o =
        run(dir, study("", "[[axis]]\nkey = \"delivery.impact_toe_mm\"\nvalues = [-10, 0, 5]\n[[axis]]\nkey = \"" +
                               key + "\"\nvalues = [0.2, 0.25, 0.3]\n"));
    EXPECT_EQ(o.status, 0) << o.text;
    return o.text;
  };
  EXPECT_NE(said("contact.face_friction").find("No answer depends on face friction.\n"), std::string::npos);
  EXPECT_EQ(said("head.mass_kg").find("No answer depends on"), std::string::npos);
  // From heel and toe the sidespin is as large: in the mean the speed changes none of it, and yet it does.
  std::string text = study("",
                           "[[axis]]\nkey = \"delivery.impact_toe_mm\"\nvalues = [-10, 0, 10]\n[[axis]]\nkey = "
                           "\"delivery.club_speed_mps\"\nvalues = [40, 45, 50]\n");
  text.replace(text.find("ball_speed_mps"), 14, "sidespin_rpm");
  const Outcome together = run(dir, text);
  ASSERT_EQ(together.status, 0) << together.text;
  EXPECT_EQ(together.text.find("No answer depends on"), std::string::npos) << together.text;
}

/// Where every point of a sample differs in all parameters, each that looks idle is changed alone.
TEST(StudyAnswers, SaysWhatChangesNoAnswerOfASample) {
  const fs::path dir = fresh_directory("study_idle_sample");
  const auto said = [&](const std::string& key, const std::string& models) {
    std::string text = study("",
                             "[sample]\npoints = 30\nseed = 3\n[[axis]]\nkey = \"delivery.club_speed_mps\"\nrange = "
                             "[40, 50]\n[[axis]]\nkey = \"" +
                                 key + "\"\nrange = [0.2, 0.3]\n");
    text.replace(text.find("\"rigid-eccentric\""), 17, models);
    const Outcome o = run(dir, text);
    EXPECT_EQ(o.status, 0) << o.text;
    EXPECT_NE(o.text.find("goes most with club speed"), std::string::npos) << o.text;
    return o.text;
  };
  EXPECT_NE(said("contact.face_friction", "\"rigid-eccentric\"").find("No answer depends on face friction.\n"),
            std::string::npos);
  EXPECT_NE(content(dir / "out/figures/tornado.gp").find("face friction: no effect"), std::string::npos);
  EXPECT_NE(content(dir / "out/figures/tornado.gp").find("a curve fitted to all points"), std::string::npos);
  EXPECT_EQ(said("head.mass_kg", "\"rigid-eccentric\"").find("No answer"), std::string::npos);
  // What one model reads and the other does not.
  const std::string two = said("hertz_maw.friction", "\"rigid-eccentric\", \"hertz-maw\"");
  EXPECT_NE(two.find("No answer of rigid-eccentric depends on friction.\n"), std::string::npos) << two;
  EXPECT_EQ(two.find("No answer of hertz-maw"), std::string::npos) << two;
}

/// A value that the case refuses is named where the design has it.
TEST(StudyAnswers, ARefusedValueIsSaidWithItsLine) {
  const std::string speed = "[[axis]]\nkey = \"delivery.club_speed_mps\"\n";
  refused(study("", speed + "values = [45, 4500]\n"),
          "case.toml:6: axis[1].values: delivery.club_speed_mps: 4500 is out of range");
  refused(study("", speed + "range = [45, 4500]\ncount = 3\n"),
          "case.toml:6: axis[1].range: delivery.club_speed_mps: ");
  refused(study("", "[sample]\npoints = 4\nseed = 1\n" + speed + "range = [4500, 4600]\n"),
          "case.toml:9: axis[1].range: delivery.club_speed_mps: ");
  refused(study("", "[[variant]]\nname = \"a\"\nset = [\"head.mass_kg=20\"]\n"),
          "case.toml:6: variant[1].set: head.mass_kg: 20 is out of range");
}

/// A few scattered points over a valley: lines predict none of it, and no parameter is named.
TEST(StudyAnswers, NamesNoParameterThatPredictsNothing) {
  const fs::path dir = fresh_directory("study_scattered");
  write(dir / "rows.csv",
        "delivery.impact_toe_mm,head.mass_kg\n-20,0.2\n-14,0.201\n-8,0.199\n-3,0.201\n4,0.199\n9,0.2\n15,0.199\n20,"
        "0.201\n");
  const Outcome o = run(dir, study("", "[rows]\nfile = \"rows.csv\"\n"));
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("These points do not tell what moves ball speed [m/s] most: one parameter at a time predicts "),
            std::string::npos)
      << o.text;
  EXPECT_EQ(o.text.find("goes most with impact"), std::string::npos) << o.text;
}

/// Each variant is compared with one of them, and the title says with which.
TEST(StudyAnswers, AComparisonOfVariantsNamesTheOne) {
  const fs::path dir = fresh_directory("study_title");
  const Outcome o = run(dir, study("",
                                   "[[variant]]\nname = \"today\"\n[[variant]]\nname = \"heavier\"\nset = "
                                   "[\"head.mass_kg=0.21\"]\n[compare]\nwith = \"variant\"\nvariant = \"today\"\n"));
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("each variant minus today\n"), std::string::npos) << o.text;
  EXPECT_NE(content(dir / "out" / "report.html").find("each variant minus today"), std::string::npos);
}

/// A variant may answer by another model: its histories bear that one's name.
TEST(StudyAnswers, AHistoryIsThatOfTheModelThatAnswered) {
  const fs::path dir = fresh_directory("study_models");
  const std::string text = R"(kind = "study"
models = ["volumetric"]
outputs = ["ball_speed_mps"]
histories = true
figures = false
[volumetric]
published = "driver"
[hertz_maw]
damping_s_per_m = 0.002
[[variant]]
name = "a"
[[variant]]
name = "b"
set = ['models=["OTHER"]']
)" + kBlow;
  const auto with = [&](const char* model) { return std::regex_replace(text, std::regex("OTHER"), model); };
  const Outcome o = run(dir, with("hertz-maw"));
  ASSERT_EQ(o.status, 0) << o.text;
  const CsvFile points(dir / "out" / "points.csv"), histories(dir / "out" / "histories.csv");
  ASSERT_EQ(points.text("model", 1), "hertz-maw");
  ASSERT_GT(histories.rows(), 20u);
  for (std::size_t i = 0; i < histories.rows(); ++i)
    EXPECT_EQ(histories.text("model", i), points.text("model", std::size_t(histories.number("point", i))));
  EXPECT_FALSE(fs::exists(dir / "out" / "figures" / "histories.png"));
  refused(with("rigid-eccentric"), "forces over time");
}

/// Without the answer of one row an interval by the deviations of all rows would be too narrow: there is none.
TEST(StudyAnswers, AnIntervalNeedsTheAnswerOfEveryRow) {
  const fs::path dir = fresh_directory("study_interval");
  write(dir / "rows.csv",
        "name,delivery.attack_angle_deg,delivery.dynamic_loft_deg\nbase,0,14\nattack,1,14\nloft,0,4\n");
  const std::string text = R"(kind = "study"
models = ["rigid-eccentric"]
outputs = ["carry_m"]
figures = false
parts_over = "row"
parts_from = "base"
[rows]
file = "rows.csv"
[[variant]]
name = "up"
set = ["delivery.club_speed_mps=46"]
[[variant]]
name = "down"
[[part]]
name = "p"
of = "up"
minus = "down"
[flight]
[flight.ground]
height_m = HEIGHT
)" + kBlow;
  const auto at = [&](const char* height) {
    const Outcome o = run(dir, std::regex_replace(text, std::regex("HEIGHT"), height));
    EXPECT_EQ(o.status, 0) << o.text;
    return summary(dir)["parts"]["p"]["mean"]["carry_m"];
  };
  EXPECT_TRUE(at("0").contains("half_width_95"));
  const auto without = at("11");
  ASSERT_EQ(without["each"].size(), 2u) << without;
  EXPECT_FALSE(without.contains("half_width_95")) << without;
}

/// What face and head make of a strike is theirs, whichever model answers; a model that knows no face takes a plate
/// too.
TEST(StudyAnswers, TheClubsFaceIsItsOwnWhicheverModelAnswers) {
  const fs::path dir = fresh_directory("study_own_face");
  const std::string plate = "[face.plate]\nthickness = {value_mm = 3.0}\n";
  const auto told = [&](const std::string& models, const std::string& face) {
    const Outcome o = run(dir, "kind = \"study\"\nmodels = [" + models +
                                   "]\noutputs = [\"characteristic_time_us\", \"face_restitution\"]\n[[axis]]\nkey = "
                                   "\"delivery.club_path_deg\"\nvalues = [0, 1]\n" +
                                   "[delivery]\nclub_speed_mps = 48.77\ndynamic_loft_deg = 12\n[head]\n"
                                   "name = \"driver-460\"\n[volumetric]\npublished = \"driver\"\n" +
                                   face);
    EXPECT_EQ(o.status, 0) << o.text;
    const CsvFile points(dir / "out/points.csv");
    return std::pair{points.number("characteristic_time_us", 0), points.number("face_restitution", 0)};
  };
  const auto reduced = told("\"volumetric\"", ""), rigid = told("\"rigid-eccentric\"", "");
  EXPECT_GT(reduced.first, 200);  // of a rigid face 33 us
  EXPECT_EQ(rigid, reduced);
  EXPECT_LT(told("\"rigid-eccentric\"", "[face]\nname = \"rigid\"\n").first, 50);
  EXPECT_GT(told("\"rigid-eccentric\"", plate).first, 100);
  // Where no output asks for the face, a key that changes nothing is refused as before.
  refused(study("", "[face]\nname = \"modern-driver\"\n" + kMasses), "face");
}

}  // namespace
