// Launch monitors' exports, made by a script in the layouts that their makers and users describe in public: what is
// understood, what is refused, and that a report comes out of two commands.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hosel/loop/shots/shots.hpp"
#include "tests/app/command.hpp"

namespace hosel {
namespace {

namespace fs = std::filesystem;
using test::command;

std::string monitor(const std::string& name) { return HOSEL_SOURCE_DIR "/tests/app/monitors/" + name; }

struct Expected {
  std::string file;
  std::size_t shots;
  std::vector<std::string> columns;  ///< that shots.csv must have
  std::string said;                  ///< a part of what is printed
};

class Monitors : public testing::TestWithParam<Expected> {};

TEST_P(Monitors, ImportWithoutEditingAndRun) {
  const Expected& e = GetParam();
  const fs::path dir = test::fresh_directory("import_" + e.file) / "case";
  const auto imported = command("import '" + monitor(e.file) + "' --out '" + dir.string() + "'");
  ASSERT_EQ(imported.status, 0) << imported.text;
  EXPECT_NE(imported.text.find(e.said), std::string::npos) << imported.text;
  const loop::Shots shots = loop::read_shots(post::read_csv(dir / "shots.csv"));
  EXPECT_EQ(shots.rows(), e.shots);
  for (const std::string& name : e.columns) {
    const loop::Column* column = shots.find(name);
    ASSERT_NE(column, nullptr) << name;
    if (!column->numeric) continue;
    for (const double x : column->value) EXPECT_TRUE(std::isfinite(x)) << name;
  }
  const auto run = command("run '" + dir.string() + "' --quiet --out '" + (dir / "out").string() + "'");
  ASSERT_EQ(run.status, 0) << run.text;
  const auto report = nlohmann::json::parse(test::content(dir / "out" / "report.json"));
  EXPECT_EQ(report["rows"]["read"], e.shots);
  EXPECT_TRUE(fs::exists(dir / "out" / "report.html"));
}

INSTANTIATE_TEST_SUITE_P(
    Layouts, Monitors,
    testing::Values(
        Expected{"trackman.csv",
                 40,
                 {"club_speed_mph", "dynamic_loft_deg", "impact_toe_mm", "spin_rate_rpm"},
                 "decimal comma"},
        Expected{"flightscope.csv",
                 24,
                 {"club_speed_kmh", "spin_axis_deg", "face_angle_deg", "azimuth_deg"},
                 "2 summary rows"},
        Expected{"foresight.csv", 24, {"spin_rate_rpm", "impact_high_mm", "attack_angle_deg"}, "in made mm"},
        Expected{
            "garmin.csv", 30, {"ball_speed_kmh", "dynamic_loft_deg", "player", "session"}, "clubs of several kinds"},
        Expected{"rapsodo.csv", 32, {"ball_speed_mph", "club", "head_mass_kg"}, "1 repeated header"},
        Expected{"connector.json", 20, {"launch_angle_deg", "shot"}, "GSPro Open Connect"},
        Expected{"spreadsheet.txt", 20, {"ball_speed_mph", "dynamic_loft_deg"}, "tabs"}),
    [](const auto& info) { return info.param.file.substr(0, info.param.file.find('.')); });

TEST(Import, LeftAndRightBecomeSigns) {
  const fs::path dir = test::fresh_directory("import_sides");
  test::write(dir / "a.csv",
              "Club,Ball (mph),Club (mph),Launch V (°),Launch H (°),Spin (rpm),Dynamic Loft (°)\n"
              "7 Iron,115,82,16,2.5 L,\"6,400\",22\n7 Iron,116,82,16.5,1.5R,6500,22.5\n7 Iron,114,81,16.2,-,6450,22\n");
  const auto o = command("import '" + (dir / "a.csv").string() + "' --out '" + (dir / "case").string() + "'");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = loop::read_shots(post::read_csv(dir / "case" / "shots.csv"));
  const auto& azimuth = shots.find("azimuth_deg")->value;
  EXPECT_NEAR(azimuth[0], radians(-2.5), 1e-12);
  EXPECT_NEAR(azimuth[1], radians(1.5), 1e-12);
  EXPECT_TRUE(std::isnan(azimuth[2]));
  EXPECT_NEAR(shots.find("spin_rate_rpm")->native(0), 6400, 1e-9);
}

TEST(Import, AWrongUnitIsCaught) {
  const fs::path dir = test::fresh_directory("import_units");
  const auto file = [&](const std::string& club_unit, const std::string& ball_unit) {
    test::write(dir / "a.csv",
                "Club Type,Ball Speed (" + ball_unit + "),Club Speed (" + club_unit +
                    "),Launch Angle,Spin Rate,Dynamic Loft\n7 Iron,115,82,16,6400,22\n7 Iron,116,82,16,6500,22\n");
    return command("import '" + (dir / "a.csv").string() + "' --out '" + (dir / "case").string() + "'");
  };
  const auto ball = file("mph", "m/s");  // 115 m/s is no ball's
  EXPECT_EQ(ball.status, 2);
  EXPECT_NE(ball.text.find("reads like"), std::string::npos) << ball.text;
  const auto club = file("km/h", "mph");  // plausible alone: the two together are not
  EXPECT_EQ(club.status, 2);
  EXPECT_NE(club.text.find("ball over club speed is 2.28"), std::string::npos) << club.text;
  EXPECT_FALSE(fs::exists(dir / "case"));
  EXPECT_EQ(file("mph", "mph").status, 0);
}

TEST(Import, SaysWhatItCannotRead) {
  const fs::path dir = test::fresh_directory("import_refusals");
  const auto refuse = [&](const std::string& text, const std::string& options, const std::string& why) {
    test::write(dir / "a.csv", text);
    const auto o =
        command("import '" + (dir / "a.csv").string() + "' --out '" + (dir / "case").string() + "' " + options);
    EXPECT_EQ(o.status, 2) << o.text;
    EXPECT_NE(o.text.find(why), std::string::npos) << o.text;
    EXPECT_FALSE(fs::exists(dir / "case"));
  };
  const std::string head = "Club Type,Ball Speed,Club Speed,Launch Angle,Spin Rate,Dynamic Loft\n";
  refuse("", "", "looks like the header");
  refuse("a,b,c\n1,2,3\n", "", "looks like the header");
  refuse(head, "", "no shots");
  refuse(head + "7i,115,82,16,6400,22\n", "", "has no unit");
  refuse(head + "7i,fast,82,16,6400,22\n", "--units imperial", "'fast' is not a number");
  refuse(head + "7i,115,82,16,6400,22\n", "--units imperial --club driver", "no shot with club 'driver'");
  refuse(head + "7i,115,82,16,6400,22\n", "--units imperial --column 'Spin Rate=spin_mph'", "no such quantity");
  refuse("{\"a\": ", "", "broken JSON");
  const auto o = command("import '" + (dir / "nowhere.csv").string() + "' --out '" + (dir / "case").string() + "'");
  EXPECT_EQ(o.status, 2);
}

TEST(Import, ByHand) {
  const fs::path dir = test::fresh_directory("import_by_hand");
  test::write(dir / "a.csv",
              "Schlaeger;Ballgeschw.;Kopfgeschw.;Abflug;Drall;Loft dyn.;Wetter\n7i;185,1;132,0;16,4;6400;22,1;warm\n"
              "7i;186,2;133,1;16,1;6500;22,3;kalt\n");
  const auto o =
      command("import '" + (dir / "a.csv").string() + "' --out '" + (dir / "case").string() +
              "' --column 'Ballgeschw.=ball_speed_kmh' --column 'Kopfgeschw.=club_speed_kmh' --column "
              "'Abflug=launch_angle_deg' --column 'Drall=spin_rate_rpm' --column 'Loft dyn.=dynamic_loft_deg' "
              "--keep Wetter --club 7i");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = loop::read_shots(post::read_csv(dir / "case" / "shots.csv"));
  EXPECT_NEAR(shots.find("ball_speed_kmh")->native(0), 185.1, 1e-9);
  EXPECT_EQ(shots.find("head_mass_kg"), nullptr) << "one club: its mass is the head's own";
  EXPECT_NE(test::content(dir / "case" / "case.toml").find("[head]\nmass_kg = 0.269 "), std::string::npos);
  EXPECT_EQ(shots.find("kept_wetter")->text[1], "kalt");
}

}  // namespace
}  // namespace hosel
