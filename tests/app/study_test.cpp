// Studies: the table has the same bytes whatever was killed, resumed or divided; nothing is computed
// twice, nothing mixed, nothing unconverged passed off as a result.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <sstream>
#include <thread>

#include "build_info.hpp"
#include "child.hpp"
#include "command.hpp"
#include "csv_file.hpp"
#include "post/file.hpp"
#include "solvers/robust_regression.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;
namespace post = hosel::post;

const std::string kSample = R"(kind = "study"
case = "../blow"
[sample]
points = 400
seed = 7
[[axis]]
key = "delivery.club_speed_mps"
range = [30.0, 50.0]
[[axis]]
key = "delivery.impact_toe_mm"
range = [-20.0, 20.0]
)";

/// A sweep with the blow beside it; returns the sweep's directory.
fs::path sweep_case(const std::string& name, const std::string& text) {
  const fs::path dir = fresh_directory(name);
  write(dir / "blow" / "case.toml", kEccentricBlow);
  write(dir / "sweep" / "case.toml", text);
  return dir;
}

/// Point numbers in the order they were written, from every shard.
std::vector<int> recorded(const fs::path& out) {
  std::vector<int> points;
  for (const auto& entry : fs::recursive_directory_iterator(out / "shards"))
    if (entry.path().filename() == "points.jsonl") {
      std::ifstream in(entry.path());
      std::string line;
      std::getline(in, line);
      while (std::getline(in, line))
        if (in.eof()) break;  // cut short
        else points.push_back(nlohmann::json::parse(line).at("point"));
    }
  return points;
}

std::size_t lines(const fs::path& file) {
  const std::string text = content(file);
  return std::size_t(std::ranges::count(text, '\n'));
}

/// A study that is killed `kills` times, each time after at most `few` further points, ends with the bytes of one that
/// was left alone, and computes nothing twice.
void expect_killed_is_whole(const fs::path& dir, const std::string& study, std::size_t size, int kills, unsigned few) {
  const std::string whole = (dir / "whole").string(), killed = (dir / "killed").string();
  ASSERT_EQ(command("run " + study + " --quiet --out " + whole).status, 0);

  std::mt19937 random(20181);
  const fs::path points = dir / "killed" / "shards" / "1-of-1" / "points.jsonl";
  for (int kill_number = 0; kill_number < kills; ++kill_number) {
    const std::size_t until = (fs::exists(points) ? lines(points) : 1) + 1 + random() % few;
    Child run(HOSEL_COMMAND " run " + study + " --quiet --out " + killed);
    ASSERT_TRUE(run.until([&] { return fs::exists(points) && lines(points) >= until; })) << "ended before the kill";
    const int status = run.end(SIGKILL);
    ASSERT_TRUE(WIFSIGNALED(status));  // the kill came while it was at work
    ASSERT_FALSE(fs::exists(dir / "killed" / "points.csv"));
  }
  const std::size_t before = recorded(dir / "killed").size();
  ASSERT_LT(before, size);
  const fs::path left = points.parent_path() / "3768-3.unfinished";  // a kill while the points' file was written new
  write(left, "{");
  ASSERT_EQ(command("run " + study + " --quiet --out " + killed).status, 0);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(content(dir / "killed" / "points.csv"), content(dir / "whole" / "points.csv"));
  EXPECT_EQ(content(dir / "killed" / "summary.json"), content(dir / "whole" / "summary.json"));
  std::vector<int> done = recorded(dir / "killed");
  ASSERT_EQ(done.size(), size);  // none lost, none computed again once it was on disk
  std::ranges::sort(done);
  for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(done[i], int(i));
}

TEST(Study, KilledTenTimesGivesTheSameTable) {
  const fs::path dir = sweep_case("sweep_killed", kSample);
  expect_killed_is_whole(dir, (dir / "sweep").string(), 400, 10, 25);
}

TEST(Study, FiniteElementBlowsThatAreKilledGiveTheSameTable) {
  const fs::path dir = fresh_directory("study_killed_fe");
  write(dir / "case/case.toml", R"(kind = "study"
models = ["fe-free-body", "rigid-eccentric"]
outputs = ["ball_speed_mps", "spin_rate_rpm", "contact_time_ms"]
[[variant]]
name = "one ball"
[[variant]]
name = "a lighter head"
set = ["head.mass_kg=0.19"]
[[axis]]
key = "delivery.dynamic_loft_deg"
values = [10.0, 14.0, 18.0, 22.0]
[delivery]
club_speed_mps = 45.0
[head]
name = "driver-2024"
[ball]
model = "tour"
[mesh]
harmonics = 1
sector = 1
rings = 1
[time]
steps_per_contact = 20
)");
  expect_killed_is_whole(dir, (dir / "case").string(), 16, 3, 3);
}

TEST(Study, BlowsOfSwungClubsThatAreKilledGiveTheSameTable) {
  const fs::path dir = fresh_directory("study_killed_swung");
  write(dir / "case/case.toml", R"(kind = "study"
models = ["fe-free-body"]
outputs = ["ball_speed_mps", "head_spin_rad_per_s", "hands_force_N"]
[[variant]]
name = "free head"
[[variant]]
name = "club loaded"
set = ["models=['fe-full-club']", "grip.hold=forced"]
[[axis]]
key = "delivery.impact_toe_mm"
values = [-20.0, -10.0, 0.0, 10.0, 20.0]
[[part]]
name = "the club"
of = "club loaded"
minus = "free head"
[motion]
begin_s = -0.25
end_s = 0.0
file = ")" + std::string(HOSEL_SOURCE_DIR) +
                                    R"(/cases/swing-driver/grip.csv"
[shaft]
name = "composite-driver"
[head]
name = "driver-2024"
[solution]
elements = 5
step_ms = 2.0
grip_point_mm = 230.0
[ball]
model = "tour"
reduced = "driver"
extrapolate = true
[mesh]
harmonics = 1
sector = 1
rings = 1
[time]
steps_per_contact = 20
)");
  expect_killed_is_whole(dir, (dir / "case").string(), 10, 2, 3);
  EXPECT_EQ(content(dir / "killed" / "parts.csv"), content(dir / "whole" / "parts.csv"));
  EXPECT_EQ(lines(dir / "whole" / "parts.csv"), 6u);
}

/// A rigid ball's speed is (1 + e) M / (M + m) of the club's along the normal: the club's speed that makes a ball's,
/// and what is stated of a launch stands in place of the model's.
const std::string kSolved = R"(kind = "study"
models = ["rigid-planar"]
outputs = ["ball_speed_mps", "launch_angle_deg", "backspin_rpm", "carry_yd"]
[[variant]]
name = "as it is"
[[variant]]
name = "stated"
set = ["launch={launch_angle_deg=12, azimuth_deg=0, backspin_rpm=2500, speed_scale=0.9}"]
[[axis]]
key = "head.mass_kg"
range = [0.19, 0.21]
count = 21
[[solve]]
name = "speed of the club"
key = "delivery.club_speed_mps"
range = [20.0, 80.0]
output = "ball_speed_mps"
value = 60.0
set = ["launch={speed_scale=1}"]
[delivery]
club_speed_mps = 30.0
[head]
mass_kg = 0.2
[contact]
restitution = 0.8
restitution_slope_s_per_m = 0.0
[flight]
)";

TEST(Study, FindsAKeyAndStatesALaunch) {
  const fs::path dir = fresh_directory("study_solved");
  write(dir / "case/case.toml", kSolved);
  const Outcome run = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(run.status, 0) << run.text;
  const std::string table = content(dir / "out" / "points.csv");
  ASSERT_EQ(table.substr(0, table.find('\n')),
            "point,model,variant,head.mass_kg,ball_speed_mps,launch_angle_deg,backspin_rpm,carry_yd,speed of the club,"
            "error");
  const CsvFile points(dir / "out" / "points.csv");
  for (std::size_t i = 0; i < points.rows(); ++i) {
    const double mass = points.number("head.mass_kg", i), ball = 0.04593;
    const bool stated = points.text("variant", i) == "stated";
    EXPECT_NEAR(points.number("speed of the club", i), 60 * (mass + ball) / (1.8 * mass), 1e-6) << i;
    EXPECT_NEAR(points.number("ball_speed_mps", i), stated ? 54 : 60, 1e-6) << i;
    if (stated) {
      EXPECT_NEAR(points.number("launch_angle_deg", i), 12, 1e-9) << i;
      EXPECT_NEAR(points.number("backspin_rpm", i), 2500, 1e-6) << i;
      EXPECT_GT(points.number("carry_yd", i), 100) << i;
    }
  }
  EXPECT_EQ(points.rows(), 42u);
  const Outcome one = command("run " + (dir / "case").string() + " --strict --out " + (dir / "one").string() +
                              " --set \"solve[1].variants=['as it is']\"");
  EXPECT_EQ(one.status, 0) << "the other variant's points lack what is not sought there: " << one.text;
  EXPECT_EQ(CsvFile(dir / "one/points.csv").text("speed of the club", 41), "");
  const auto refused = [&](const std::string& set, const std::string& says) {
    const Outcome o = command("run " + (dir / "case").string() + " --quiet --out " + (dir / "refused").string() + set);
    EXPECT_NE(o.status, 0) << set;
    EXPECT_NE(o.text.find(says), std::string::npos) << set << ": " << o.text;
  };
  refused(" --set solve[1].range=[20,400]", "out of range");
  refused(" --set \"solve[1].variants=['as it was']\"", "did you mean 'as it is'");
  refused(" --set solve[1].output=ball_speed_mqs", "nothing of a blow is called");
  refused(" --set matched_launch=true --set measured.launch_angle_deg=10", "one unknown after another");
  refused(" --force --set solve[1].value=600", "have no answer");
}

TEST(Study, WhoseKeysAreFoundIsKilledAndGivesTheSameTable) {
  const fs::path dir = fresh_directory("study_solved_killed");
  std::string text = kSolved;
  text.replace(text.find("count = 21"), 10, "count = 200");
  write(dir / "case/case.toml", text);
  expect_killed_is_whole(dir, (dir / "case").string(), 400, 4, 30);
}

/// Shots on a plane have that plane's slopes, one wild reading or not; a part over rows that are each one standard
/// deviation away has the interval of their squares.
TEST(Study, RegressesShotsAndPropagatesDeviations) {
  const fs::path dir = fresh_directory("study_regression");
  std::string shots = "shot,club_speed_mps,impact_toe_mm,ball_speed_mps,launch_angle_deg,backspin_rpm,sidespin_rpm\n";
  for (int i = 0; i < 40; ++i) {
    const double speed = 40 + 0.25 * i, toe = (i * 7) % 20 - 10, wild = i == 11 ? 30 : 0;
    std::ostringstream row;
    row << i + 1 << ',' << speed << ',' << toe << ',' << 1.4 * speed - 0.1 * toe + wild + 1e-3 * ((i * 13) % 7 - 3)
        << ",12,2500," << -40 * toe + 0.1 * ((i * 5) % 9 - 4) << '\n';
    shots += row.str();
  }
  shots += shots.substr(shots.rfind('\n', shots.size() - 2) + 1);  // the last one again
  write(dir / "case/shots.csv", shots);
  write(dir / "case/rows.csv",
        "name,head.mass_kg,contact.restitution\nown,0.2,0.8\nheavier,0.204,0.8\nlivelier,0.2,0.82\n");
  write(dir / "case/case.toml", R"(kind = "study"
models = ["rigid-planar"]
outputs = ["ball_speed_mps"]
parts_over = "row"
parts_from = "own"
[rows]
file = "rows.csv"
[[variant]]
name = "fast"
set = ["delivery.club_speed_mps=50"]
[[variant]]
name = "slow"
set = ["delivery.club_speed_mps=40"]
[[part]]
name = "per m/s"
of = "fast"
minus = "slow"
per = 10.0
[regression]
shots = "shots.csv"
of = ["ball_speed_mps", "sidespin_rpm"]
on = ["club_speed_mps", "impact_toe_mm"]
[delivery]
club_speed_mps = 45.0
[head]
mass_kg = 0.2
[contact]
restitution = 0.8
restitution_slope_s_per_m = 0.0
)");
  const Outcome run = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_NE(run.text.find("1 row of the shots repeats an earlier row"), std::string::npos) << run.text;
  const auto said = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  const auto& slopes = said["regression"]["slopes"];
  EXPECT_EQ(said["regression"]["rows"], 40);
  EXPECT_NEAR(slopes["ball_speed_mps"]["club_speed_mps"]["slope"].get<double>(), 1.4, 2e-3);
  EXPECT_NEAR(slopes["ball_speed_mps"]["impact_toe_mm"]["slope"].get<double>(), -0.1, 1e-3);
  EXPECT_NEAR(slopes["sidespin_rpm"]["impact_toe_mm"]["slope"].get<double>(), -40, 0.05);
  EXPECT_EQ(slopes["ball_speed_mps"]["rows_below_half_weight"], 1);
  // Student's 97.5 % with 40 rows less three unknowns.
  Eigen::MatrixXd X(40, 3);
  Eigen::VectorXd spin(40);
  for (int i = 0; i < 40; ++i) {
    X.row(i) << 1, 40 + 0.25 * i, (i * 7) % 20 - 10;
    spin[i] = -40 * X(i, 2) + 0.1 * ((i * 5) % 9 - 4);
  }
  const double half = 2.02619 * std::sqrt(hosel::solvers::robust_regression(X, spin).covariance(2, 2));
  EXPECT_NEAR(slopes["sidespin_rpm"]["impact_toe_mm"]["half_width_95"].get<double>(), half, 1e-4 * half);
  const Outcome few = command("run " + (dir / "case").string() + " --set regression.last_shot=11");
  expect_refused(few, "a regression on 2 inputs needs 12 whole rows");
  const double ball = 0.04593, own = 1.8 * 0.2 / (0.2 + ball), heavier = 1.8 * 0.204 / (0.204 + ball),
               livelier = 1.82 * 0.2 / (0.2 + ball);
  const auto& part = said["parts"]["per m/s"]["mean"]["ball_speed_mps"];
  EXPECT_NEAR(part["from"].get<double>(), own, 1e-9);
  EXPECT_NEAR(part["half_width_95"].get<double>(), 1.96 * std::hypot(heavier - own, livelier - own), 1e-9);
}

/// A sidespin or a tilt that is not recorded is no zero: its row is left out, and where no row has it, `of` is refused.
TEST(Study, ARegressionTakesNoMissingQuantityForZero) {
  const fs::path dir = fresh_directory("study_regression_gaps");
  const auto told = [&](const std::string& spin, const std::string& of, const auto& cells) {
    std::string shots = "shot,club_speed_mps,impact_toe_mm,ball_speed_mps,launch_angle_deg," + spin + "\n";
    for (int i = 0; i < 60; ++i) {
      const int toe = (i * 7) % 20 - 10;
      shots += std::to_string(i + 1) + "," + std::to_string(40 + (i * 11) % 17) + "," + std::to_string(toe) +
               ",62,12," + cells(i, toe) + "\n";
    }
    write(dir / "case/shots.csv", shots);
    write(dir / "case/case.toml",
          "kind = \"study\"\nmodels = [\"rigid-planar\"]\noutputs = [\"ball_speed_mps\"]\n[[axis]]\nkey = "
          "\"delivery.club_speed_mps\"\nvalues = [44, 45]\n[delivery]\nclub_speed_mps = 45.0\n[head]\nmass_kg = "
          "0.2\n[regression]\nshots = \"shots.csv\"\non = [\"impact_toe_mm\", \"club_speed_mps\"]\nof = [" +
              of + "]\n");
    return command("run " + (dir / "case").string() + " --force --out " + (dir / "out").string());
  };
  const auto sidespin = [](int i, int toe) { return std::to_string(-30 * toe + (i * 5) % 9 - 4); };
  const Outcome half = told("backspin_rpm,sidespin_rpm", "\"sidespin_rpm\", \"spin_axis_deg\"",
                            [&](int i, int toe) { return "2500," + (i % 2 ? "" : sidespin(i, toe)); });
  ASSERT_EQ(half.status, 0) << half.text;
  EXPECT_NE(half.text.find("30 of 60 measured rows are whole"), std::string::npos) << half.text;
  const auto summary = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  EXPECT_NEAR(summary["regression"]["slopes"]["sidespin_rpm"]["impact_toe_mm"]["slope"].get<double>(), -30, 0.5);
  const Outcome none = told("backspin_rpm", "\"sidespin_rpm\"", [](int, int) { return "2500"; }),
                rate = told("spin_rate_rpm", "\"backspin_rpm\"", [](int, int) { return "2500"; }),
                rifle = told("backspin_rpm,sidespin_rpm", "\"sidespin_rpm\", \"riflespin_rpm\"",
                             [&](int i, int toe) { return "2500," + sidespin(i, toe); });
  for (const auto& [o, name] : {std::pair{&none, "sidespin_rpm"}, {&rate, "backspin_rpm"}, {&rifle, "riflespin_rpm"}}) {
    EXPECT_EQ(o->status, 2) << o->text;
    EXPECT_NE(o->text.find("regression.of: '" + std::string(name) + "': no row of"), std::string::npos) << o->text;
  }
  const Outcome polar = told("spin_rate_rpm,spin_axis_deg", "\"spin_axis_deg\", \"sidespin_rpm\"",
                             [](int, int toe) { return "2500," + std::to_string(-0.5 * toe); });
  ASSERT_EQ(polar.status, 0) << polar.text;
  EXPECT_NE(polar.text.find("60 of 60 measured rows are whole"), std::string::npos) << polar.text;
}

/// Two rows of one value cannot be told apart by it.
TEST(Study, PartsOverAColumnNeedItsValuesToDiffer) {
  const fs::path dir = fresh_directory("study_parts_twice");
  write(dir / "rows.csv", "delivery.club_speed_mps,contact.restitution\n40,0.8\n40,0.81\n45,0.8\n");
  write(dir / "case.toml", R"(kind = "study"
models = ["rigid-planar"]
outputs = ["ball_speed_mps"]
parts_over = "delivery.club_speed_mps"
parts_from = "45"
[rows]
file = "rows.csv"
[[variant]]
name = "heavy"
set = ["head.mass_kg=0.21"]
[[variant]]
name = "light"
set = ["head.mass_kg=0.19"]
[[part]]
name = "heavier"
of = "heavy"
minus = "light"
[delivery]
club_speed_mps = 40
[head]
mass_kg = 0.2
)");
  const Outcome o = command("check " + dir.string());
  expect_refused(o, "stand there twice");
}

TEST(Study, ALineCutShortIsComputedAgain) {
  const fs::path dir = sweep_case("sweep_torn", kSample);
  const std::string sweep = (dir / "sweep").string(), out = (dir / "out").string();
  ASSERT_EQ(command("run " + sweep + " --quiet --out " + out).status, 0);
  const std::string table = content(dir / "out" / "points.csv");
  const fs::path points = dir / "out" / "shards" / "1-of-1" / "points.jsonl";
  fs::resize_file(points, fs::file_size(points) - 30);
  fs::remove(dir / "out" / "summary.json");
  fs::remove(dir / "out" / "points.csv");
  ASSERT_EQ(recorded(dir / "out").size(), 399u);
  ASSERT_EQ(command("run " + sweep + " --quiet --out " + out).status, 0);
  EXPECT_EQ(content(dir / "out" / "points.csv"), table);
  EXPECT_EQ(recorded(dir / "out").size(), 400u);
}

TEST(Study, AnAnswerThatLiesAboutUnsealedIsNotBelieved) {
  const fs::path dir = sweep_case("sweep_unsealed", kSample);
  const std::string sweep = (dir / "sweep").string(), set = " --set sample.points=4 --quiet --out ";
  ASSERT_EQ(command("run " + sweep + set + (dir / "whole").string()).status, 0);
  // As a killed process leaves it, finished but not yet in the store; and a number in it has changed since.
  write(dir / "out/shards/1-of-1/point-000002/summary.json",
        R"({"models": {"rigid-eccentric": {"ball_speed_mps": 99.0}}})");
  ASSERT_EQ(command("run " + sweep + set + (dir / "out").string()).status, 0);
  EXPECT_EQ(content(dir / "out/points.csv"), content(dir / "whole/points.csv"));
}

TEST(Study, TwoShardsInTwoProcessesGiveTheBytesOfOne) {
  const fs::path dir = sweep_case("sweep_shards", kSample);
  const std::string sweep = (dir / "sweep").string(), out = (dir / "out").string();
  ASSERT_EQ(command("run " + sweep + " --quiet --out " + (dir / "one").string()).status, 0);
  ASSERT_EQ(command("sweep plan " + sweep + " --out " + out).status, 0);
  const Outcome early = command("sweep merge " + out);
  expect_refused(early, "0 of 400 points are finished");
  Outcome first, second;
  std::thread other([&] { first = command("sweep run " + out + " --quiet --shard 1/2"); });
  second = command("sweep run " + out + " --quiet --shard 2/2");
  other.join();
  ASSERT_EQ(first.status, 0) << first.text;
  ASSERT_EQ(second.status, 0) << second.text;
  EXPECT_EQ(recorded(dir / "out").size(), 400u);
  EXPECT_NE(command("sweep status " + out).text.find("400 of 400 points finished"), std::string::npos);
  ASSERT_EQ(command("sweep merge " + out).status, 0);
  EXPECT_EQ(content(dir / "out" / "points.csv"), content(dir / "one" / "points.csv"));
  EXPECT_EQ(content(dir / "out" / "summary.json"), content(dir / "one" / "summary.json"));
  // Of the page all but how it was made.
  const auto page = [&](const char* of) {
    const std::string text = content(dir / of / "report.html");
    EXPECT_EQ(text.find("<pre class='command'>\n"), std::string::npos) << "no command";
    return text.substr(0, text.find("<h2>The same again</h2>"));
  };
  EXPECT_EQ(page("out"), page("one"));
  // Another division of the work finds everything done.
  ASSERT_EQ(command("sweep run " + out + " --quiet --shard 3/5").status, 0);
  EXPECT_EQ(recorded(dir / "out").size(), 400u);
}

TEST(Study, MixedCasesAndVersionsAreRefused) {
  const fs::path dir = sweep_case("sweep_mixed", kSample);
  const std::string sweep = (dir / "sweep").string(), out = (dir / "out").string();
  ASSERT_EQ(command("sweep plan " + sweep + " --out " + out).status, 0);
  ASSERT_EQ(command("sweep run " + out + " --quiet").status, 0);

  const fs::path points = dir / "out" / "shards" / "1-of-1" / "points.jsonl";
  const std::string good = content(points);
  // As written by another build.
  nlohmann::json header = nlohmann::json::parse(good.substr(0, good.find('\n')));
  header["fingerprint"] = "another";
  header.erase("check");
  header["check"] = post::digest(header.dump());
  write(points, header.dump() + good.substr(good.find('\n')));
  Outcome o = command("sweep merge " + out);
  expect_refused(o, "another version");
  write(points, good);

  std::string blow = kEccentricBlow;  // the case that is swept changes
  blow.replace(blow.find("mass_kg = 0.2"), 13, "mass_kg = 0.3");
  write(dir / "blow" / "case.toml", blow);
  o = command("sweep merge " + out);
  expect_refused(o, "has changed");
  o = command("run " + sweep + " --quiet --out " + out);
  EXPECT_EQ(o.status, 2);
  EXPECT_FALSE(fs::exists(dir / "out" / "points.csv"));
  write(dir / "blow" / "case.toml", kEccentricBlow);
  EXPECT_EQ(command("sweep merge " + out).status, 0);
}

TEST(Study, LatinHypercubeFillsEveryStratumOnce) {
  const fs::path dir = sweep_case("sweep_latin", kSample);
  ASSERT_EQ(command("run " + (dir / "sweep").string() + " --quiet --out " + (dir / "out").string()).status, 0);
  ASSERT_TRUE(content(dir / "out/points.csv").starts_with("point,delivery.club_speed_mps,delivery.impact_toe_mm,"));
  const CsvFile points(dir / "out" / "points.csv");
  ASSERT_EQ(points.rows(), 400u);
  std::vector<int> speed(400), toe(400);
  double sum = 0;
  for (std::size_t i = 0; i < points.rows(); ++i) {
    const double a = points.number("delivery.club_speed_mps", i), b = points.number("delivery.impact_toe_mm", i);
    ++speed.at(std::size_t((a - 30) / 20 * 400));
    ++toe.at(std::size_t((b + 20) / 40 * 400));
    sum += (a - 40) * b;
  }
  for (int i = 0; i < 400; ++i) {
    EXPECT_EQ(speed[std::size_t(i)], 1);
    EXPECT_EQ(toe[std::size_t(i)], 1);
  }
  // The columns are independent: correlation within four standard errors (1/20 each).
  EXPECT_LT(std::abs(sum / 400 / (20 / std::sqrt(12.0) * 40 / std::sqrt(12.0))), 0.2);
}

TEST(Study, AStatementHoldsInAShareOfTheRange) {
  // The ball is fastest where the centre of gravity stands behind it: towards the toe for three quarters of the range.
  const fs::path dir = fresh_directory("sweep_share");
  write(dir / "blow" / "case.toml", R"(kind = "study"
models = ["rigid-eccentric"]
outputs = ["ball_speed_mps"]
figures = false
[compare]
with = "variant"
variant = "own"
[delivery]
club_speed_mps = 45.0
[head]
mass_kg = 0.2
cg_mm = [-35.0, 0.0, 0.0]
inertia_kg_m2 = [[2.0e-4, 0, 0], [0, 3.0e-4, 0], [0, 0, 4.5e-4]]
[grid]
columns = 5
rows = 3
[[variant]]
name = "own"
[[variant]]
name = "heavier"
set = ["head.mass_kg=0.21"]
[[statement]]
text = "fastest towards the toe"
holds = "fastest_club_toe_mm > 0"
)");
  write(dir / "sweep" / "case.toml", R"(kind = "study"
case = "../blow"
outputs = ["statements.0.share", "effect.heavier.figures.fastest_club_toe_mm"]
[sample]
points = 20
seed = 3
[[axis]]
key = "head.cg_mm[2]"
range = [-3.0, 1.0]
[[axis]]
key = "delivery.club_speed_mps"
range = [44.0, 46.0]
)");
  const Outcome run = command("run " + (dir / "sweep").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(run.status, 0) << run.text;
  const auto summary = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  EXPECT_DOUBLE_EQ(summary["mean"]["statements.0.share"], 0.75);  // one point in each stratum
  // The place follows the centre of gravity in a straight line; the speed does nothing to it.
  const auto& effect = summary["main_effects"]["effect.heavier.figures.fastest_club_toe_mm"];
  EXPECT_GT(effect["head.cg_mm[2]"]["share"], 0.99);
  EXPECT_LT(effect["delivery.club_speed_mps"]["share"], 0.01);
  EXPECT_GT(effect["head.cg_mm[2]"]["at_low"], effect["head.cg_mm[2]"]["at_high"]);
  EXPECT_NE(run.text.find("Fastest club toe [mm] goes most with cg 2 [mm]: 100 % of its variance"), std::string::npos)
      << run.text;
  const std::string page = content(dir / "out" / "report.html"), drawn = content(dir / "out" / "figures" / "line.gp");
  EXPECT_TRUE(std::regex_search(run.text, std::regex("statement 1 holds +0 +0.75 +1 +cg 2 \\[mm\\]"))) << run.text;
  EXPECT_NE(page.find("statement 1 holds"), std::string::npos);
  EXPECT_NE(drawn.find("set xlabel 'cg 2 [mm]'"), std::string::npos) << "against what it goes with";
  EXPECT_EQ(drawn.find("set xlabel 'club speed"), std::string::npos);
  const Outcome bad =
      command("run " + (dir / "blow").string() + " --out " + (dir / "bad").string() + " --set 'head.cg_mm[4]=1'");
  expect_refused(bad, "there is no 'cg_mm[4]'");
}

/// A study of blows: head on the centre line, so that the rigid models have closed forms.
const std::string kCentredBlow = R"([delivery]
club_speed_mps = 40.0
[head]
mass_kg = 0.26
cg_mm = [0.0, 0.0, 0.0]
inertia_kg_m2 = [[2.752e-4, 0, 0], [0, 0.577e-4, 0], [0, 0, 2.889e-4]]
)";

nlohmann::json studied(const std::string& name, const std::string& text, Outcome* said = nullptr) {
  const fs::path dir = fresh_directory(name);
  write(dir / "case.toml", "kind = \"study\"\n" + text);
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 0) << o.text;
  if (said) *said = o;
  return nlohmann::json::parse(content(dir / "out" / "summary.json"));
}

/// A rigid head on the centre line: spin goes with speed times sin(loft), ball speed with speed and cos(loft). The
/// largest spin below a ball speed is where that ball speed is reached at the largest loft.
TEST(Study, EmulatorSharesAndOptimumAreThoseOfTheClosedForm) {
  Outcome said;
  const auto summary = studied("study_optimum", R"(models = ["rigid-eccentric"]
outputs = ["spin_rate_rpm", "ball_speed_mps"]
[sample]
points = 60
seed = 2
[[axis]]
key = "delivery.club_speed_mps"
range = [30.0, 50.0]
[[axis]]
key = "delivery.dynamic_loft_deg"
range = [20.0, 40.0]
[optimum]
output = "spin_rate_rpm"
seek = "largest"
where = "ball_speed_mps < 45"
)" + std::string(kCentredBlow),
                               &said);
  ASSERT_TRUE(summary["emulator"].contains("spin_rate_rpm")) << said.text;
  EXPECT_GT(summary["emulator"]["spin_rate_rpm"]["predicted"], 0.9999);
  // f = v sin(a), both uniform: of the variance by v alone Var(v) E(sin)^2, by a alone E(v)^2 Var(sin), and the rest.
  const double a = 20 * M_PI / 180, b = 40 * M_PI / 180;
  const double mean = (std::cos(a) - std::cos(b)) / (b - a),
               square = 0.5 - (std::sin(2 * b) - std::sin(2 * a)) / (4 * (b - a)), var = square - mean * mean;
  const double var_v = 400.0 / 12, all = (var_v + 1600) * square - 1600 * mean * mean;
  const auto& effects = summary["main_effects"]["spin_rate_rpm"];
  EXPECT_NEAR(effects["delivery.club_speed_mps"]["share"], var_v * mean * mean / all, 0.005);
  EXPECT_NEAR(effects["delivery.dynamic_loft_deg"]["together"]["share"], (1600 * var + var_v * var) / all, 0.005);
  const auto& best = summary["optimum"]["rigid-eccentric"];
  EXPECT_TRUE(best["condition_met"]);
  EXPECT_NEAR(best["at"]["delivery.dynamic_loft_deg"], 40, 0.1);
  EXPECT_NEAR(best["confirmed"], best["expected"], 1e-3 * double(best["confirmed"]));
  EXPECT_NE(said.text.find("It lies at an end of the range of delivery.dynamic_loft_deg"), std::string::npos);
}

/// The same where another case answers: the point that confirms is one more run of it, and leaves nothing behind.
TEST(Study, AnotherCaseConfirmsAnOptimumToo) {
  const fs::path dir = sweep_case("sweep_optimum", R"(kind = "study"
case = "../blow"
set = ["delivery.impact_high_mm=0"]
outputs = ["models.rigid-eccentric.ball_speed_mps", "models.rigid-eccentric.spin_rate_rpm"]
[sample]
points = 60
seed = 7
[[axis]]
key = "delivery.club_speed_mps"
range = [30.0, 50.0]
[[axis]]
key = "delivery.impact_toe_mm"
range = [5.0, 20.0]
[optimum]
output = "models.rigid-eccentric.ball_speed_mps"
seek = "largest"
where = "spin_rate_rpm < 100000"
)");
  const Outcome o = command("run " + (dir / "sweep").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto best = nlohmann::json::parse(content(dir / "out" / "summary.json"))["optimum"];
  EXPECT_NEAR(best["at"]["delivery.club_speed_mps"], 50, 0.1) << best;
  EXPECT_NEAR(best["at"]["delivery.impact_toe_mm"], 5, 0.1) << best;
  EXPECT_TRUE(best["condition_met"]);
  EXPECT_FALSE(fs::exists(dir / "out" / "optimum"));
  // The blow by itself, there.
  const Outcome one = command("run " + (dir / "blow").string() + " --out " + (dir / "one").string() +
                              " --set delivery.club_speed_mps=" + best["at"]["delivery.club_speed_mps"].dump() +
                              " --set delivery.impact_toe_mm=" + best["at"]["delivery.impact_toe_mm"].dump());
  ASSERT_EQ(one.status, 0) << one.text;
  const auto told = nlohmann::json::parse(content(dir / "one" / "summary.json"));
  EXPECT_NEAR(best["confirmed"], told["models"]["rigid-eccentric"]["ball_speed_mps"].get<double>(), 1e-9);
}

TEST(Study, NothingIsEmulatedOfWhatThePointsDoNotPredict) {
  // Five points are fewer than three for each of two parameters.
  const auto summary = studied("study_few", R"(models = ["rigid-eccentric"]
outputs = ["spin_rate_rpm"]
[sample]
points = 5
seed = 2
[[axis]]
key = "delivery.club_speed_mps"
range = [30.0, 50.0]
[[axis]]
key = "delivery.dynamic_loft_deg"
range = [20.0, 40.0]
[optimum]
output = "spin_rate_rpm"
seek = "largest"
)" + std::string(kCentredBlow));
  EXPECT_FALSE(summary.contains("emulator"));
  EXPECT_FALSE(summary["optimum"]["rigid-eccentric"]["sought"]);
}

/// Balls whose direction alone scatters, by a normal distribution: the share in the fairway is its integral.
TEST(Study, LandingShareIsThatOfTheNormalDistribution) {
  Outcome said;
  const auto summary = studied("study_landing", R"(models = ["rigid-eccentric"]
outputs = ["carry_m", "side_m"]
[sample]
points = 200
seed = 5
[[axis]]
key = "delivery.face_angle_deg"
mean = 0.0
sd = 2.0
[[axis]]
key = "delivery.club_path_deg"
mean = 0.0
sd = 1e-3
[landing]
fairway_m = 10.0
[flight]
units = "metres"
)" + std::string(kCentredBlow).replace(0, 11, "[delivery]\ndynamic_loft_deg = 20.0\n"),
                               &said);
  const auto& all = summary["landing"]["rigid-eccentric"];
  ASSERT_GT(double(all["side_sd_m"]), 1);
  const double wanted = std::erf(5 / double(all["side_sd_m"]) / std::sqrt(2.0));
  EXPECT_NEAR(all["fairway_share"], wanted, 0.01);            // a Latin hypercube: one ball in each of 200 strata
  EXPECT_NEAR(all["fairway_share_emulated"], wanted, 0.015);  // 10,000 draws: 0.005 is one standard deviation
  EXPECT_LT(double(all["fairway_share_low"]), wanted);
  EXPECT_GT(double(all["fairway_share_high"]), wanted);
  EXPECT_NE(said.text.find("land in the fairway, 10 m wide"), std::string::npos) << said.text;
}

constexpr const char* kSampleOfClubSpeeds = R"(kind = "study"
models = ["rigid-eccentric"]
outputs = ["ball_speed_mps"]
[sample]
points = 200
seed = 3
[[axis]]
key = "delivery.club_speed_mps"
mean = 45.0
sd = 2.0
[[axis]]
key = "delivery.dynamic_loft_deg"
mean = 14.0
sd = 2.0
[[population]]
name = "made"
file = "shots/made.csv"
where = "speed > 0"
given = "delivery.club_speed_mps"
given_measured = "speed"
[population.measured]
ball_speed_mps = "0.44704 * ball"
)";

/// 101 shots on a line of known slope, each half a metre per second off it, and one row that does not count.
TEST(Study, APopulationIsComparedByQuantilesAndOverItsClubSpeed) {
  const fs::path dir = fresh_directory("study_population");
  fs::create_directories(dir / "shots");
  write(dir / "case.toml",
        kSampleOfClubSpeeds + kCentredBlow + "[contact]\nrestitution = 0.8\nrestitution_slope_s_per_m = 0\n");
  std::string csv = "speed,ball,note\n0,999,left out\n";
  for (int i = 0; i <= 100; ++i) {
    const double v = 40 + 0.1 * i;
    csv += std::to_string(v) + "," + std::to_string((1.4 * v + (i % 2 ? 0.5 : -0.5)) / 0.44704) + ",text\n";
  }
  write(dir / "shots" / "made.csv", csv);
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto s = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  const auto &all = s["populations"]["made"]["ball_speed_mps"], &seen = all["measured"], &own = all["computed"];
  EXPECT_EQ(seen["shots"], 101);
  EXPECT_NEAR(seen["quantile_50"], 1.4 * 45, 0.5);
  EXPECT_NEAR(seen["at_median"], 1.4 * 45, 0.02);  // one row more lies below the line than above: 1 / 101
  EXPECT_NEAR(seen["slope"], 1.4, 3 * double(seen["slope_error"]));
  EXPECT_NEAR(seen["scatter"], 1.4826 * 0.5, 0.02);
  EXPECT_EQ(own["shots"], 200);
  EXPECT_GT(own["quantile_95"], double(own["quantile_05"]) + 5);
  // A rigid head of constant restitution: the ball's speed goes with the club's.
  EXPECT_NEAR(own["slope"], double(own["at_median"]) / 45, 3 * double(own["slope_error"]));
  EXPECT_NE(o.text.find("ball speed [m/s], measured"), std::string::npos) << o.text;
  EXPECT_TRUE(fs::exists(dir / "out" / "figures" / "made.gp"));

  const Outcome without = command("run " + dir.string() + " --out " + (dir / "none").string() +
                                  " --set population[1].file=not-there/made.csv");
  EXPECT_EQ(without.status, 0) << without.text;
  EXPECT_NE(without.text.find("SKIPPED"), std::string::npos) << without.text;
  const Outcome wrong = command("check " + dir.string() + " --set population[1].given=delivery.club_sped_mps");
  expect_refused(wrong, "did you mean 'delivery.club_speed_mps'");
}

TEST(Study, ModelsAreComparedByPlaceAndCause) {
  const nlohmann::json s = studied("study_compare", R"(models = ["rigid-eccentric", "stick-slip", "volumetric"]
outputs = ["ball_speed_mps", "backspin_rpm", "tangential_impulse_N_s", "contact_time_ms"]
[[axis]]
key = "delivery.dynamic_loft_deg"
values = [10.0, 50.0]
[[axis]]
name = "friction"
keys = ["contact.friction", "volumetric.friction", "volumetric.static_friction"]
values = [0.1, 0.4]
[compare]
with = "model"
model = "rigid-eccentric"
[[statement]]
text = "one closed form on the centre line"
holds = "abs(difference.backspin_rpm) < 1e-6"
[volumetric]
published = "driver"
)" + kCentredBlow);
  EXPECT_EQ(s["points"], 12);
  bool saw = false;
  for (const auto& e : s["compare"]["differences"]) {
    if (e["output"] != "backspin_rpm") continue;
    if (e["model"] == "stick-slip") {
      EXPECT_LT(std::abs(e["largest"].get<double>()), 1e-6);  // one and the same on the centre line
    }
    if (e["model"] == "volumetric") {
      saw = true;
      EXPECT_GT(std::abs(e["largest"].get<double>()), 50);
      EXPECT_FALSE(e["where"].get<std::string>().empty());
      EXPECT_NE(e["differs_most"], "-");
    }
  }
  EXPECT_TRUE(saw);
  ASSERT_EQ(s["statements"].size(), 2U);  // of each model but the reference
  EXPECT_EQ(s["statements"][0]["verdict"], "holds");
  EXPECT_EQ(s["statements"][1]["verdict"], "fails");
}

/// Rolling on the centre line: spin is 5 v sin(loft) / (2 r (1 + m/M + 5/2)), one factor a parameter.
TEST(Study, MainEffectsAreThoseOfTheClosedForm) {
  Outcome o;
  const nlohmann::json s = studied("study_effects", R"(models = ["stick-slip"]
outputs = ["backspin_rpm"]
[contact]
friction = inf
tangential_restitution = 0.0
restitution = 0.8
[[axis]]
key = "delivery.club_speed_mps"
values = [36.0, 40.0, 44.0]
[[axis]]
key = "delivery.dynamic_loft_deg"
values = [20.0, 24.0, 28.0]
[[axis]]
key = "head.mass_kg"
values = [0.25, 0.26, 0.27]
)" + kCentredBlow,
                                   &o);
  // Variance of a product of independent factors: of one factor alone that of its own values over that of the product.
  std::vector<double> speeds = {36, 40, 44}, sines, masses;
  for (const double loft : {20.0, 24.0, 28.0}) sines.push_back(std::sin(loft * std::acos(-1.0) / 180));
  for (const double m : {0.25, 0.26, 0.27}) masses.push_back(1 / (3.5 + 0.04593 / m));
  const auto mean = [](const std::vector<double>& x) { return (x[0] + x[1] + x[2]) / 3; };
  const auto mean_square = [](const std::vector<double>& x) { return (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / 3; };
  const double means = mean(speeds) * mean(sines) * mean(masses);
  const double whole = mean_square(speeds) * mean_square(sines) * mean_square(masses) - means * means;
  const auto share = [&](const std::vector<double>& x) {
    return (mean_square(x) / (mean(x) * mean(x)) - 1) * means * means / whole;
  };
  const auto& e = s["main_effects"]["backspin_rpm"];
  EXPECT_NEAR(e["delivery.club_speed_mps"]["share"], share(speeds), 1e-6);
  EXPECT_NEAR(e["delivery.dynamic_loft_deg"]["share"], share(sines), 1e-6);
  EXPECT_NEAR(e["head.mass_kg"]["share"], share(masses), 1e-6);
  EXPECT_LT(e["delivery.dynamic_loft_deg"]["low"], share(sines));
  EXPECT_GT(e["delivery.dynamic_loft_deg"]["high"], share(sines));
  EXPECT_NE(o.text.find("Backspin [rpm] goes most with dynamic loft [deg]: "), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("Second is club speed [m/s]"), std::string::npos) << o.text;
}

TEST(Study, RowsBringKeysAndMeasuredValues) {
  const fs::path dir = fresh_directory("study_rows");
  write(dir / "blows.csv",
        "name,delivery.club_speed_mps,delivery.dynamic_loft_deg,ball_speed_mph\nslow,30,20,90\nfast,45,12,\n");
  write(dir / "case.toml",
        "kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n"
        "rows.file = \"blows.csv\"\n" +
            kCentredBlow);
  const std::string out = (dir / "out").string();
  ASSERT_EQ(command("run " + dir.string() + " --quiet --out " + out).status, 0);
  const auto s = nlohmann::json::parse(content(dir / "out/summary.json"));
  ASSERT_EQ(s["compare"]["differences"].size(), 1U);
  EXPECT_EQ(s["compare"]["differences"][0]["points"], 1) << "the fast one was not measured";
  EXPECT_NEAR(s["compare"]["differences"][0]["largest"].get<double>(),
              s["range"]["ball_speed_mps"][0].get<double>() - 90 * 0.44704, 1e-9);
  EXPECT_NE(content(dir / "out/points.csv")
                .find("point,model,row,delivery.club_speed_mps,delivery.dynamic_loft_deg,ball_speed_mps,error\n"
                      "0,stick-slip,slow,30,20,"),
            std::string::npos);
  write(dir / "blows.csv", "name;delivery.club_speed_mps;delivery.dynamic_loft_deg\nslow;30;20\n");
  expect_refused(command("check " + dir.string()), "blows.csv:1: cells are separated by semicolons here");
  write(dir / "blows.csv", "name,delivery.club_sped_mps\na,30\n");
  const Outcome bad = command("run " + dir.string() + " --quiet --out " + out + "-bad");
  expect_refused(bad, "did you mean");
}

TEST(Study, AQuantityThatTheDesignVariesIsSetNowhereElse) {
  const fs::path dir = fresh_directory("study_once");
  const std::string head = "kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n";
  write(dir / "axis/case.toml",
        head + "[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [30, 40]\n" + kCentredBlow);
  write(dir / "variant/case.toml",
        head + "[[variant]]\nname = \"light\"\nset = [\"head.mass_kg=0.19\"]\n" + kCentredBlow);
  write(dir / "rows/blows.csv", "delivery.club_speed_mps\n30\n40\n");
  write(dir / "rows/case.toml", head + "rows.file = \"blows.csv\"\n" + kCentredBlow);
  for (const auto& [study, key] : {std::pair{"axis", "delivery.club_speed_mps"},
                                   {"variant", "head.mass_kg"},
                                   {"rows", "delivery.club_speed_mps"}}) {
    const std::string check = "check " + (dir / study).string();
    const std::string other = key == std::string("head.mass_kg") ? "delivery.club_speed_mps=44" : "head.mass_kg=0.21";
    ASSERT_EQ(command(check + " --set " + other).status, 0) << "another key may be set";
    const Outcome twice = command(check + " --set " + key + "=1.25");
    EXPECT_EQ(twice.status, 2) << study;
    EXPECT_NE(twice.text.find(std::string("'") + key + "' is varied by this study"), std::string::npos) << twice.text;
  }
  const Outcome unit = command("check " + (dir / "axis").string() + " --set delivery.club_speed_mph=90");
  EXPECT_NE(unit.text.find("(delivery.club_speed_mph)"), std::string::npos) << unit.text;
  const std::string both = "[[axis]]\nkey = \"head.mass_kg\"\nvalues = [0.2, 0.21]\n";
  write(dir / "both/case.toml",
        head + both + "[[variant]]\nname = \"light\"\nset = [\"head.mass_g=190\"]\n" + kCentredBlow);
  EXPECT_NE(command("check " + (dir / "both").string()).text.find("twice, as 'head."), std::string::npos);
  write(dir / "rows/blows.csv", "delivery.club_speed_mps,delivery.club_speed_mph\n30,90\n");
  const Outcome units = command("check " + (dir / "rows").string());
  expect_refused(units, "are one quantity");
}

/// A table that is set as a whole leaves no key that was set in it before.
TEST(Study, AWholeTableLeavesNothingOfWhatTheDesignVaries) {
  const fs::path dir = fresh_directory("study_whole_table");
  const auto check = [&](const std::string& design, const std::string& set = "") {
    write(dir / "case.toml",
          "kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n" + design + kCentredBlow);
    return command("check " + dir.string() + (set.empty() ? "" : " --set '" + set + "'"));
  };
  const auto refused = [&](const std::string& design, const std::string& set, const std::string& says) {
    expect_refused(check(design, set), says);
  };
  const std::string blow = "delivery={club_speed_mps=45, dynamic_loft_deg=14}";
  const std::string light = "[[variant]]\nname = \"light\"\nset = [\"head.mass_kg=0.19\"]\n";
  write(dir / "blows.csv", "delivery.attack_angle_deg\n1\n2\n");
  const std::string rows = "rows.file = \"blows.csv\"\n";
  refused(light, "head={name=\"driver-2024\"}", "'head.mass_kg' is varied by this study, and set to one value");
  refused("[[variant]]\nname = \"whole\"\nset = [\"" + blow + "\"]\n", "delivery.club_speed_mps=50",
          "'delivery.club_speed_mps' is varied by this study, and set to one value");
  refused(rows, blow, "'delivery.attack_angle_deg' is varied by this study, and set to one value");
  EXPECT_EQ(check(light, blow).status, 0) << check(light, blow).text;
  // An axis is set after the table: what the table does not hold may be varied.
  const auto axis = [](const std::string& key) {
    return "[[axis]]\nkey = \"delivery." + key + "\"\nvalues = [4, 5]\n";
  };
  refused(axis("club_speed_mph"), blow, "'delivery.club_speed_mph' is varied by this study, and set to one value");
  EXPECT_EQ(check(axis("attack_angle_deg"), blow).status, 0) << check(axis("attack_angle_deg"), blow).text;
  const std::string whole = "[[variant]]\nname = \"whole\"\nset = [\"" + blow + "\"]\n";
  refused(axis("club_speed_mph") + whole, "", "'delivery.club_speed_mps' is varied by this study twice");
  EXPECT_EQ(check(axis("attack_angle_deg") + whole).status, 0) << check(axis("attack_angle_deg") + whole).text;
  refused("[[variant]]\nname = \"v\"\nset = [\"delivery.club_speed_mps=40\", \"" + blow + "\"]\n", "",
          "gives one quantity twice");
  refused(whole +
              "[[solve]]\nname = \"loft\"\nkey = \"delivery.dynamic_loft_deg\"\nrange = [5, 20]\n"
              "output = \"launch_angle_deg\"\nvalue = 10\n",
          "", "is sought, and 'delivery.dynamic_loft_deg' is varied");
  refused("[[variant]]\nname = \"v\"\nset = [\"ball.model='tour'\"]\n",
          "ball.layers=[{law=\"neo-hooke\", young_MPa=60, poisson=0.45, density_kg_per_m3=1130}]",
          "'ball.model' is varied by this study");
}

TEST(Study, WhatIsMeasuredIsAnOutput) {
  const fs::path dir = fresh_directory("study_measured");
  const auto refused = [&](const std::string& text) {
    write(dir / "case.toml",
          "kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n" + text + kCentredBlow);
    const Outcome o = command("check " + dir.string());
    EXPECT_EQ(o.status == 0, o.text.find("is measured and no output of this study") == std::string::npos) << o.text;
    return o.status != 0;
  };
  const std::string axis = "[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [30, 40]\n";
  ASSERT_FALSE(refused(axis + "[measured]\nball_speed_mph = 90\n")) << "another unit of the same";
  EXPECT_TRUE(refused(axis + "[measured]\nball_sped_mps = 40\n"));
  EXPECT_TRUE(refused(axis + "[measured]\nball_speed_deg = 40\n"));
  EXPECT_TRUE(refused(axis + "[measured]\nbackspin_rpm = 4000\n"));
  write(dir / "blows.csv", "delivery.club_speed_mps,dynamic_loft_deg\n30,12\n");
  EXPECT_TRUE(refused("rows.file = \"blows.csv\"\n")) << "a key without its table is no measurement";
}

TEST(Study, NamesThatEndAlikeAreToldApart) {
  const fs::path dir = fresh_directory("study_names");
  const auto checked = [&](const std::string& where) {
    write(dir / "case.toml",
          "kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n"
          "[[axis]]\nkey = \"head.mass_kg\"\nvalues = [0.19, 0.21]\n"
          "[[axis]]\nkey = \"ball.mass_kg\"\nvalues = [0.044, 0.0459]\n"
          "[[statement]]\ntext = \"heavy heads are fast\"\nholds = \"ball_speed_mps > 1\"\nwhere = \"" +
              where + "\"\n" + kCentredBlow);
    return command("run " + dir.string() + " --quiet --force --out " + (dir / "out").string());
  };
  const Outcome either = checked("mass_kg > 0.2");
  expect_refused(either, "head_mass_kg");
  ASSERT_EQ(checked("head_mass_kg > 0.2").status, 0);
  EXPECT_EQ(nlohmann::json::parse(content(dir / "out/summary.json"))["statements"][0]["points"], 2);
}

TEST(Study, DifferencesApartByAColumn) {
  const nlohmann::json s = studied("study_by", R"(models = ["stick-slip", "rigid-eccentric"]
outputs = ["ball_speed_mps"]
[[variant]]
name = "as measured"
measured.ball_speed_mps = [1.0, 100.0]
[[variant]]
name = "off"
measured.ball_speed_mps = 10.0
[compare]
with = "measured"
by = "variant"
)" + kCentredBlow);
  const auto& all = s["compare"]["differences"];
  ASSERT_EQ(all.size(), 4U);
  for (const auto& d : all)
    if (d["of"] == "as measured") EXPECT_EQ(d["rms"], 0.0) << "inside the range";
    else EXPECT_NEAR(d["rms"].get<double>(), s["range"]["stick-slip.ball_speed_mps"][0].get<double>() - 10, 1e-9);
}

TEST(Study, AFormerKindSaysWhatItIsNow) {
  for (const char* kind :
       {"sweep", "variants", "cross-check", "curves", "clubs", "bounce", "restitution-face", "flight"}) {
    const fs::path dir = fresh_directory("study_former");
    write(dir / "case.toml", std::string("kind = \"") + kind + "\"\n");
    const Outcome o = command("check " + dir.string());
    expect_refused(o, std::string("'") + kind + "' is now 'study': ");
  }
}

TEST(Study, AStatementThatCannotBeReadIsRefused) {
  const fs::path dir = fresh_directory("study_statement");
  for (const char* formula : {"ball_sped_mps > 1", "ball_speed_mps >", "difference.ball_speed_mps > 1",
                              "ball_speed_mps", "0", "2 * ball_speed_mps - 80"}) {
    write(dir / "case.toml",
          std::string("kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n"
                      "[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [40.0]\n[[statement]]\ntext = \"it is\"\n"
                      "holds = \"") +
              formula + "\"\n" + kCentredBlow);
    const Outcome o = command("check " + dir.string());
    EXPECT_EQ(o.status, 2) << formula;
    EXPECT_NE(o.text.find("statement[1].holds"), std::string::npos) << o.text;
  }
}

TEST(Study, AStatementComparesWithThePointsThatItSpeaksOf) {
  // The slower of two clubs makes the fastest ball among the blows of slow clubs, and not among all.
  const fs::path dir = fresh_directory("study_statement_where");
  write(dir / "case.toml", std::string(R"(kind = "study"
models = ["stick-slip"]
outputs = ["ball_speed_mps"]
[[axis]]
key = "delivery.club_speed_mps"
values = [40.0, 50.0]
[[statement]]
text = "among the slow ones"
where = "club_speed_mps < 45"
holds = "ball_speed_mps == largest.ball_speed_mps"
[[statement]]
text = "among all"
where = "club_speed_mps < 45 && ball_speed_mps == largest.ball_speed_mps"
holds = "club_speed_mps < 45"
)") + kCentredBlow);
  const std::string out = (dir / "out").string();
  ASSERT_EQ(command("run " + dir.string() + " --out " + out + " --quiet").status, 0);
  const auto statements = nlohmann::json::parse(content(dir / "out" / "summary.json"))["statements"];
  EXPECT_EQ(statements[0]["points"], 1);
  EXPECT_EQ(statements[0]["verdict"], "holds");
  EXPECT_EQ(statements[1]["points"], 0);
}

TEST(Study, GridTakesNumbersAndWords) {
  const fs::path dir = sweep_case("sweep_grid", R"(kind = "study"
case = "../blow"
outputs = ["models.rigid-planar.ball_speed_mps"]
keep_outputs = true
[[axis]]
key = "models"
values = ["rigid-planar"]
[[axis]]
key = "delivery.club_speed_mph"
values = [90, 100.5]
[[axis]]
key = "delivery.dynamic_loft_deg"
values = [0.0, 20.0, 40.0]
)");
  write(dir / "blow" / "case.toml",
        std::string(kEccentricBlow).replace(kEccentricBlow.find("[\"rigid-eccentric\"]"), 19, "[\"rigid-planar\"]"));
  // `models` is a list, and a word is not: the error is the case's own.
  const Outcome refused = command("run " + (dir / "sweep").string() + " --out " + (dir / "out").string());
  expect_refused(refused, "expected a list of texts");
  EXPECT_FALSE(fs::exists(dir / "out"));

  std::string text = content(dir / "sweep" / "case.toml");
  text.replace(text.find("key = \"models\""), 14, "key = \"title\"");
  write(dir / "sweep" / "case.toml", text);
  const Outcome done = command("run " + (dir / "sweep").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(done.status, 0) << done.text;
  EXPECT_EQ(lines(dir / "out" / "points.csv"), 7u);
  EXPECT_NE(content(dir / "out" / "points.csv").find("\n3,rigid-planar,100.5,0,"), std::string::npos)
      << content(dir / "out" / "points.csv");
  EXPECT_TRUE(fs::exists(dir / "out" / "shards" / "1-of-1" / "point-000003" / "summary.json"));
  EXPECT_TRUE(fs::exists(dir / "out" / "figures" / "line.png"));
  const std::string drawn = content(dir / "out" / "figures" / "line.gp");
  EXPECT_NE(drawn.find("set xlabel 'dynamic loft [deg]'"), std::string::npos) << "across: what has most values";
  for (const char* line : {"title 'club speed 90 mph'", "title 'club speed 100.5 mph'"})
    EXPECT_NE(drawn.find(line), std::string::npos) << "a line for each value of the other";
}

TEST(Study, APointWithoutAnAnswerIsSaid) {
  const fs::path dir = sweep_case("sweep_failed", R"(kind = "study"
case = "../blow"
[[axis]]
key = "delivery.club_path_deg"
values = [0.0, 89.0]
[[axis]]
key = "delivery.face_angle_deg"
values = [0.0, -60.0]
)");
  const Outcome o = command("run " + (dir / "sweep").string() + " --quiet --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 3);
  EXPECT_NE(o.text.find("1 of 4 points have no answer; the first is point 3"), std::string::npos) << o.text;
  EXPECT_EQ(nlohmann::json::parse(content(dir / "out" / "summary.json")).at("failed"), 1);
  EXPECT_NE(content(dir / "out" / "points.csv").find("the head moves away from the ball"), std::string::npos);
}

TEST(Study, OverMeasuredDataThatAreNotHereIsSkipped) {
  const fs::path dir = fresh_directory("sweep_not_here");
  setenv("HOSEL_DATA", (dir / "nowhere").c_str(), 1);
  const Outcome o = command("run swing-speed --out " + (dir / "out").string());
  unsetenv("HOSEL_DATA");
  EXPECT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("SKIPPED"), std::string::npos) << o.text;
}

TEST(Study, BadInputIsRefusedBeforeAnythingIsWritten) {
  const std::map<std::string, std::string> wrong = {
      {"key = \"delivery.club_sped_mps\"\nvalues = [1.0]", "did you mean 'club_speed_mps'"},
      {"key = \"delivery.club_speed_mps\"\nvalues = [45.0, -1.0]", "out of range"},
      {"key = \"delivery.club_speed_mps\"\nvalues = []", "expected a list of values"},
      {"key = \"delivery.club_speed_mps\"\nvalue = [1.0]", "unknown key"},
  };
  for (const auto& [parameter, hint] : wrong) {
    const fs::path dir =
        sweep_case("sweep_wrong", "kind = \"study\"\ncase = \"../blow\"\n[[axis]]\n" + parameter + "\n");
    const Outcome o = command("run " + (dir / "sweep").string() + " --out " + (dir / "out").string());
    EXPECT_EQ(o.status, 2) << parameter;
    EXPECT_EQ(std::ranges::count(o.text, '\n'), 1) << o.text;
    EXPECT_TRUE(o.text.find(hint) != std::string::npos || o.text.find("'values' is missing") != std::string::npos)
        << o.text;
    EXPECT_FALSE(fs::exists(dir / "out"));
  }
  EXPECT_EQ(command("sweep run " + fresh_directory("no_plan").string()).status, 2);
  const fs::path dir = sweep_case("sweep_shard_text", kSample);
  ASSERT_EQ(command("sweep plan " + (dir / "sweep").string() + " --out " + (dir / "out").string()).status, 0);
  for (const char* shard : {"0/2", "3/2", "1", "a/b", "1/2x"})
    EXPECT_EQ(command("sweep run " + (dir / "out").string() + " --shard " + shard).status, 2) << shard;
}

TEST(Study, AChangedBitOfAStoreIsNotTakenForAResult) {
  const fs::path dir = sweep_case("sweep_bits", kSample);
  const std::string sweep = (dir / "sweep").string(), out = (dir / "out").string();
  ASSERT_EQ(command("sweep plan " + sweep + " --set sample.points=12 --out " + out).status, 0);
  ASSERT_EQ(command("sweep run " + out + " --quiet").status, 0);
  ASSERT_EQ(command("sweep merge " + out + " --quiet").status, 0);
  const std::string table = content(dir / "out/points.csv");
  const fs::path points = dir / "out/shards/1-of-1/points.jsonl";
  const std::string good = content(points);
  std::mt19937 random(9);
  int refused = 0;
  for (int k = 0; k < 24; ++k) {
    std::string bad = good;
    bad[random() % bad.size()] ^= char(1 << random() % 8);
    write(points, bad);
    const Outcome o = command("sweep merge " + out + " --quiet --force");
    ASSERT_TRUE(o.status == 2 || content(dir / "out/points.csv") == table) << "flip " << k;
    refused += o.status == 2;
  }
  EXPECT_GT(refused, 20);
  write(points, good);
  const std::string plan = content(dir / "out/plan.json");
  std::string flipped = plan;
  flipped[plan.find("fingerprint")] ^= 1;  // a key, not a value
  for (const std::string& bad : {plan.substr(0, 60), flipped}) {
    write(dir / "out/plan.json", bad);
    const Outcome o = command("sweep merge " + out + " --force");
    expect_refused(o, "the plan is damaged");
  }
}

TEST(Study, PointsMadeByHandAreNoResults) {
  const fs::path dir = sweep_case("sweep_hand", kSample);
  write(dir / "map/case.toml", study_of_blow() + "[grid]\ncolumns = 3\nrows = 3\n");
  const auto merged = [&](const char* of, const std::string& more, std::size_t size,
                          const std::function<nlohmann::json(std::size_t)>& made) {
    const std::string out = (dir / "out").string();
    fs::remove_all(out);
    EXPECT_EQ(command("sweep plan " + (dir / of).string() + more + " --out " + out).status, 0);
    const auto plan = nlohmann::json::parse(content(dir / "out/plan.json"));
    const auto sealed = [](nlohmann::json entry) {
      entry["check"] = post::digest(entry.dump());
      return entry.dump() + '\n';
    };
    std::string text = sealed({{"fingerprint", plan["fingerprint"]}, {"version", plan["version"]}});
    for (std::size_t k = 0; k < size; ++k) {
      nlohmann::json point = made(k);
      if (!point.contains("point")) point = {{"point", k}, {"seconds", 1.0}, {"result", point}};
      text += sealed(point);
    }
    write(dir / "out/shards/1-of-1/points.jsonl", text);
    const Outcome o = command("sweep merge " + out + " --quiet --force");
    EXPECT_FALSE(o.status == 0 && !fs::exists(dir / "out/summary.json"));
    EXPECT_EQ(std::ranges::count(o.text, '\n'), o.status == 0 ? 0 : 1) << o.text;
    return o.status;
  };
  const auto launch = [](std::size_t) -> nlohmann::json {
    const auto still = {0, 0, 0};
    return {{"launch",
             {{"velocity", {60, 0, 10}}, {"spin", {0, -300, 0}}, {"head_velocity", {40, 0, 0}}, {"head_spin", still}}}};
  };
  ASSERT_EQ(merged("map", "", 9, launch), 0) << "the seals are right";
  for (const char* hosel : {R"({"impulse":[],"history":[]})", R"({"impulse":[[],[]]})", "{}", "5"})
    EXPECT_EQ(merged("map", "", 9,
                     [&](std::size_t k) {
                       nlohmann::json j = launch(k);
                       if (k == 0) j["hosel"] = nlohmann::json::parse(hosel);
                       return j;
                     }),
              2)
        << hosel;
  for (const char* result : {"3", "null", R"({"error":5})", R"({"a":"x"})", R"({"skipped":5})"})
    EXPECT_EQ(merged("sweep", " --set sample.points=2", 2, [&](std::size_t) { return nlohmann::json::parse(result); }),
              2)
        << result;
  for (const int number : {5, -1})
    EXPECT_EQ(merged("sweep", " --set sample.points=2", 2,
                     [&](std::size_t k) -> nlohmann::json {
                       return {{"point", k ? number : 0}, {"seconds", 1.0}, {"result", {{"x", 1.0}}}};
                     }),
              2)
        << number;
}

TEST(Study, ASweepThatNamesItselfIsRefused) {
  const fs::path dir = sweep_case("sweep_self", kSample);
  std::string self = kSample;
  self.replace(self.find("../blow"), 7, "../sweep");
  write(dir / "sweep/case.toml", self);
  Outcome o = command("check " + (dir / "sweep").string());
  expect_refused(o, "names itself");
  // By way of another.
  self.replace(self.find("../sweep"), 8, "../other");
  write(dir / "sweep/case.toml", self);
  self.replace(self.find("../other"), 8, "../sweep");
  write(dir / "other/case.toml", self);
  o = command("check " + (dir / "sweep").string());
  expect_refused(o, "names itself");
}

TEST(Study, AGridTooLargeToCountIsRefused) {
  std::string text = "kind = \"study\"\ncase = \"../blow\"\n";
  const char* keys[] = {"club_speed_mps", "attack_angle_deg", "club_path_deg", "dynamic_loft_deg",
                        "face_angle_deg", "impact_toe_mm",    "impact_high_mm"};
  for (const char* key : keys) {
    text += std::string("[[axis]]\nkey = \"delivery.") + key + "\"\nvalues = [1.0";
    for (int i = 1; i < 1024; ++i) text += ",1.0";  // 1024^7 is 2^70, zero in 64 bits
    text += "]\n";
  }
  const fs::path dir = sweep_case("sweep_large", text);
  const Outcome o = command("check " + (dir / "sweep").string());
  expect_refused(o, "more than 100000 points");
}

TEST(Study, AKeySweptTwiceIsRefused) {
  for (const char* again : {"club_speed_mps", "club_speed_mph"}) {
    const fs::path dir =
        sweep_case("sweep_twice", kSample + "[[axis]]\nkey = \"delivery." + again + "\"\nrange = [40.0, 45.0]\n");
    const Outcome o = command("check " + (dir / "sweep").string());
    expect_refused(o, "'delivery.club_speed_mps' is an axis already");
  }
}

/// Two of one name, or one that the table has for something else, would end as a broken table at the last point.
TEST(Study, EveryColumnOfThePointsHasANameOfItsOwn) {
  const fs::path dir = fresh_directory("study_columns");
  const auto check = [&](const std::string& design) {
    write(dir / "case.toml",
          "kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n" + design + kCentredBlow);
    return command("check " + dir.string());
  };
  const auto axis = [](const std::string& name, const std::string& key) {
    return "[[axis]]\nname = \"" + name + "\"\nkey = \"delivery." + key + "\"\nvalues = [1, 2]\n";
  };
  ASSERT_EQ(check(axis("x", "attack_angle_deg") + axis("y", "club_path_deg")).status, 0);
  const std::string says = " is another column of points.csv";
  expect_refused(check(axis("x", "attack_angle_deg") + axis("x", "club_path_deg")),
                 "case.toml:9: axis[2].name: 'x'" + says);
  expect_refused(check("[[variant]]\nname = \"v\"\nset = []\n" + axis("variant", "attack_angle_deg")), says);
  for (const char* name : {"model", "point", "error"}) expect_refused(check(axis(name, "attack_angle_deg")), says);
  expect_refused(check(axis("ball_speed_mps", "attack_angle_deg")), "is a column of the design too");
  for (const char* name : {"error", "doubts", "launch", "history", "hosel", "heavier", "skipped", "point", "model"})
    expect_refused(check(axis("x", "attack_angle_deg") + "[[solve]]\nname = \"" + name +
                         "\"\nkey = \"delivery.dynamic_loft_deg\"\nrange = [5, 20]\n"
                         "output = \"launch_angle_deg\"\nvalue = 10\n"),
                   "case.toml:9: solve[1].name: '" + std::string(name) + "' is something else of every point");
}

TEST(Study, ARangeHasTwoEnds) {
  const fs::path dir = fresh_directory("study_range");
  for (const std::string more : {"count = 3\n", "[sample]\npoints = 4\nseed = 1\n"}) {
    write(dir / "case.toml",
          "kind = \"study\"\nmodels = [\"stick-slip\"]\noutputs = [\"ball_speed_mps\"]\n[[axis]]\n"
          "key = \"delivery.attack_angle_deg\"\nrange = [5, 5]\n" +
              more + kCentredBlow);
    expect_refused(command("check " + dir.string()), "axis[1].range: both ends are the same");
  }
}

TEST(Study, AnEditHalfWayMixesNothing) {
  const fs::path dir = sweep_case("sweep_edit", kSample);
  const std::string sweep = (dir / "sweep").string();
  ASSERT_EQ(command("run " + sweep + " --quiet --out " + (dir / "whole").string()).status, 0);
  Child run(HOSEL_COMMAND " run " + sweep + " --quiet --out " + (dir / "out").string());
  const fs::path points = dir / "out/shards/1-of-1/points.jsonl";
  ASSERT_TRUE(run.until([&] { return fs::exists(points) && lines(points) >= 20; }));
  std::string blow = kEccentricBlow;
  blow.replace(blow.find("mass_kg = 0.2"), 13, "mass_kg = 0.3");
  write(dir / "blow/case.toml", blow);
  const bool in_time = !fs::exists(dir / "out/points.csv");
  const int status = run.wait();
  ASSERT_TRUE(in_time) << "the sweep had ended before the edit";
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(content(dir / "out/points.csv"), content(dir / "whole/points.csv"));
}

}  // namespace
