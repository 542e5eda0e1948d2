// Launch monitors' exports, made by a script in the layouts that their makers and users describe in public: what is
// understood, what is refused, and that a report comes out of two commands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "app/kinds/loop_landings.hpp"
#include "golf/units.hpp"
#include "loop/shots/shots.hpp"
#include "models/flight/flight.hpp"
#include "tests/app/command.hpp"

namespace hosel {
namespace {

namespace fs = std::filesystem;
using test::command;

std::string monitor(const std::string& name) { return HOSEL_SOURCE_DIR "/tests/app/monitors/" + name; }

/// `hosel import` of a file with this text in DIR, into DIR/case.
test::Outcome import_text(const fs::path& dir, const std::string& text, const std::string& options = "") {
  const fs::path file = dir / (text.starts_with('{') || text.starts_with('[') ? "a.json" : "a.csv");
  test::write(file, text);
  return command("import '" + file.string() + "' --out '" + (dir / "case").string() + "' " + options);
}

loop::Shots imported_shots(const fs::path& dir) { return loop::read_shots(post::read_csv(dir / "case" / "shots.csv")); }

struct Expected {
  std::string file;
  std::size_t shots;
  std::vector<std::string> columns;  ///< that shots.csv must have
  std::string said;                  ///< a part of what is printed
};
void PrintTo(const Expected& e, std::ostream* out) { *out << e.file; }

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
    testing::Values(Expected{"trackman.csv",
                             40,
                             {"club_speed_mph", "dynamic_loft_deg", "impact_toe_mm", "spin_rate_rpm"},
                             "decimal comma"},
                    Expected{"flightscope.csv",
                             24,
                             {"club_speed_kmh", "spin_axis_deg", "face_angle_deg", "azimuth_deg"},
                             "2 summary rows"},
                    Expected{
                        "foresight.csv", 24, {"spin_rate_rpm", "impact_high_mm", "attack_angle_deg"}, "in made mm"},
                    Expected{"garmin.csv",
                             30,
                             {"ball_speed_kmh", "dynamic_loft_deg", "player", "session"},
                             "woods and irons in one file"},
                    Expected{"rapsodo.csv", 32, {"ball_speed_mph", "club", "head_mass_kg"}, "1 repeated header"},
                    Expected{"connector.json", 20, {"launch_angle_deg", "shot"}, "GSPro Open Connect"},
                    Expected{"spreadsheet.txt", 20, {"ball_speed_mph", "dynamic_loft_deg"}, "tabs"}),
    [](const auto& info) { return info.param.file.substr(0, info.param.file.find('.')); });

TEST(Import, LeftAndRightBecomeSigns) {
  const fs::path dir = test::fresh_directory("import_sides");
  const auto o = import_text(
      dir,
      "Club,Ball (mph),Club (mph),Launch V (°),Launch H (°),Spin (rpm),Dynamic Loft (°)\n"
      "7 Iron,115,82,16,2.5 L,\"6,400\",22\n7 Iron,116,82,16.5,1.5R,6500,22.5\n7 Iron,114,81,16.2,-,6450,22\n");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  const auto& azimuth = shots.find("azimuth_deg")->value;
  EXPECT_NEAR(azimuth[0], radians(-2.5), 1e-12);
  EXPECT_NEAR(azimuth[1], radians(1.5), 1e-12);
  EXPECT_TRUE(std::isnan(azimuth[2]));
  EXPECT_NEAR(shots.find("spin_rate_rpm")->native(0), 6400, 1e-9);
}

/// Header, cells and what they mean in our unit and sign, under a column of its own.
TEST(Import, UnitsAndSidesMeanWhatTheyMeanForTheirQuantity) {
  struct Told {
    std::string header, cells, column;
    double first, second;
  };
  const fs::path dir = test::fresh_directory("import_meanings");
  for (const Told& t : {Told{"Impact Lateral (in mm)", "-2,3", "impact_toe_mm", -2, 3},
                        {"Impact Lateral (in)", "-0.2,0.3", "impact_toe_mm", -5.08, 7.62},
                        {"Impact Lateral (in toe+/heel-)", "-0.2,0.3", "impact_toe_mm", -5.08, 7.62},
                        {"Impact Vertical (mm)", "6.0 H,2.0 L", "impact_high_mm", 6, -2},
                        {"Impact Lateral (mm)", "6.0 H,2.0 T", "impact_toe_mm", -6, 2},
                        {"Sidespin (L+/R-)", "300,-200", "sidespin_rpm", -300, 200},
                        {"Sidespin (L+/R-) [rpm]", "300,-200", "sidespin_rpm", -300, 200},
                        {"Spin Axis (deg L+ R-)", "3,-4", "spin_axis_deg", -3, 4},
                        {"Launch Direction (deg left positive)", "3,-4", "azimuth_deg", -3, 4},
                        {"Launch Direction (+ = left)", "3,-4", "azimuth_deg", -3, 4},
                        {"Launch Direction (right + / left -)", "3,-4", "azimuth_deg", 3, -4},
                        {"Attack Angle (deg)", "3 D,4 U", "attack_angle_deg", -3, 4},
                        {"Lateral Impact (mm, + heel)", "3,-4", "impact_toe_mm", -3, 4},
                        {"Lateral Impact (mm + heel)", "3,-4", "impact_toe_mm", -3, 4},
                        {"Lateral Impact (mm; heel +ve)", "3,-4", "impact_toe_mm", -3, 4},
                        {"Lateral Impact (+toe-heel)", "3,-4", "impact_toe_mm", 3, -4},
                        {"Lateral Impact (mm, T/H)", "3 T,4 H", "impact_toe_mm", 3, -4},
                        {"Impact Height (mm, - high)", "3,-4", "impact_high_mm", -3, 4},
                        {"Face Angle (deg, + closed)", "3,-4", "face_angle_deg", -3, 4},
                        {"Face Angle (Grad)", "3,-4", "face_angle_deg", 3, -4},
                        {"Launch Direction (-L+R)", "3,-4", "azimuth_deg", 3, -4},
                        {"Launch Direction (L+R-)", "3,-4", "azimuth_deg", -3, 4},
                        {"Club Path (deg, in-out +)", "3,-4", "club_path_deg", 3, -4},
                        {"Club Path (out-in+)", "3,-4", "club_path_deg", -3, 4},
                        {"Club Path (deg in to out +)", "3,-4", "club_path_deg", 3, -4}}) {
    fs::remove_all(dir / "case");
    const auto comma = t.cells.find(',');
    const auto o =
        import_text(dir, "Club,Ball Speed (mph),Club Speed (mph),Launch Angle (in degrees),Spin Rate (rpm),\"" +
                             t.header + "\"\n7i,115,82,16,6400," + t.cells.substr(0, comma) + "\n7i,116,82,16,6500," +
                             t.cells.substr(comma + 1) + "\n");
    ASSERT_EQ(o.status, 0) << t.header << o.text;
    EXPECT_EQ(o.text.find("not understood"), std::string::npos) << o.text;
    const loop::Shots shots = imported_shots(dir);
    ASSERT_TRUE(shots.find(t.column)) << t.header << o.text;
    EXPECT_NEAR(shots.find(t.column)->native(0), t.first, 1e-9) << t.header;
    EXPECT_NEAR(shots.find(t.column)->native(1), t.second, 1e-9) << t.header;
    ASSERT_TRUE(shots.find("launch_angle_deg")) << o.text;
  }
}

TEST(Import, UnitsThatOnlyOthersUseAreConverted) {
  const fs::path dir = test::fresh_directory("import_other_units");
  const auto o = import_text(dir,
                             "Club,Ball Speed (ft/s),Club Speed (knots),Launch Angle (mrad),Spin Rate (rad/s)\n"
                             "7i,168.7,71.3,280,675.4\n7i,170.1,71.5,281,680.6\n");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  EXPECT_NEAR(shots.find("ball_speed_mps")->native(0), 168.7 * 0.3048, 1e-4);
  EXPECT_NEAR(shots.find("club_speed_mps")->native(0), 71.3 * 1852 / 3600, 1e-4);
  EXPECT_NEAR(shots.find("launch_angle_deg")->native(0), degrees(0.28), 1e-4);
  EXPECT_NEAR(shots.find("spin_rate_rad_per_s")->native(0), 675.4, 1e-9);
}

TEST(Import, AWrongUnitIsCaught) {
  const fs::path dir = test::fresh_directory("import_units");
  const auto file = [&](const std::string& club_unit, const std::string& ball_unit) {
    return import_text(
        dir, "Club Type,Ball Speed (" + ball_unit + "),Club Speed (" + club_unit +
                 "),Launch Angle,Spin Rate,Dynamic Loft\n7 Iron,115,82,16,6400,22\n7 Iron,116,82,16,6500,22\n");
  };
  const auto ball = file("mph", "m/s");  // 115 m/s is no ball's
  EXPECT_EQ(ball.status, 2);
  EXPECT_NE(ball.text.find("reads like"), std::string::npos) << ball.text;
  const auto club = file("km/h", "mph");  // plausible alone: the two together are not
  EXPECT_EQ(club.status, 2);
  EXPECT_NE(club.text.find("ball over club speed is 2.27"), std::string::npos) << club.text;
  EXPECT_FALSE(fs::exists(dir / "case"));
  EXPECT_EQ(file("mph", "mph").status, 0);
}

TEST(Import, SaysWhatItCannotRead) {
  const fs::path dir = test::fresh_directory("import_refusals");
  const auto refuse = [&](const std::string& text, const std::string& options, const std::string& why) {
    const auto o = import_text(dir, text, options);
    EXPECT_EQ(o.status, 2) << o.text;
    EXPECT_NE(o.text.find(why), std::string::npos) << o.text;
    EXPECT_FALSE(fs::exists(dir / "case"));
  };
  const std::string head = "Club Type,Ball Speed,Club Speed,Launch Angle,Spin Rate,Dynamic Loft\n";
  refuse("", "", "a.csv: the file is empty");
  refuse(" \n\n", "", "a.csv: the file is empty");
  refuse("a,b,c\n1,2,3\n", "", "looks like the header");
  refuse(head, "", "no shots");
  refuse(head + "7i,115,82,16,6400,22\n", "", "has no unit");
  refuse(head + "7i,fast,82,16,6400,22\n", "--units imperial", "'fast' is not a number");
  refuse(head + "7i,115,82,16,6400,22\n", "--units imperial --club driver", "no shot with club 'driver'");
  refuse(head + "7i,115,82,16,6400,22\n", "--units imperial --column 'Spin Rate=spin_mph'", "no such quantity");
  refuse("Club,Ball Speed (mph),Club Speed (mph),Launch Angle (deg),Spin Rate (turns/min)\n7i,115,82,16,6400\n", "",
         "the unit 'turns/min' is not known");
  const std::string speeds = "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft";
  for (const char* unit : {"(furlongs)", "[foo]", "(parsec)"})
    refuse(speeds + ",Impact Toe " + unit + "\n7i,115,82,16,6400,22,1\n", "",
           "column 'Impact Toe " + std::string(unit) + "': the unit '" +
               std::string(unit).substr(1, std::string(unit).size() - 2) + "' is not known; --column 'Impact Toe " +
               unit + "=impact_toe_mm' states one");
  refuse("Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate (furlongs)\n7i,115,82,16,6400\n", "",
         "the unit 'furlongs' is not known");
  refuse("Club,Ball Speed (mph),Club Speed (mph),Launch Angle (mm),Spin Rate (rpm)\n7i,115,82,16,6400\n", "",
         "mm is no unit of launch_angle");
  refuse("Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Impact Lateral (mm)\n7i,115,82,16,6400,3 R\n",
         "", "'3 R' is not a number");
  refuse("{\"a\": ", "", "broken JSON");
  // The range stands in the unit of the value.
  refuse(head + "7i,115,82,16,6.5,22\n", "--units imperial",
         "6.5 rpm is no spin_rate (allowed: 381.972 to 15278.9 rpm)");
  // Words in a column of clubs make it no empty column of their speed.
  refuse("club,ball_speed_mph,launch_angle_deg,spin_rpm\n7i,112,16,6500\n8i,111,16.5,6600\n", "",
         "no column of club speed; --column 'header=club_speed_mph'");
  refuse("#,Name,Ball Speed (mph),Club Speed (mph),Launch Angle\n1,7i,115,82,16\n2,8i,112,81,18\n", "",
         "no column of clubs; --column 'Name=club' names one");
  const auto refuse_file = [&](const fs::path& file, const std::string& why) {
    test::expect_refused(command("import '" + file.string() + "' --out '" + (dir / "case").string() + "'"), why);
  };
  refuse_file(dir / "nowhere.csv", "no such file");
  refuse_file(dir, "a directory: the exported file itself is wanted");
}

TEST(Import, WordsInBracketsThatAreNoUnitAreRead) {
  const fs::path dir = test::fresh_directory("import_brackets");
  const auto o = import_text(dir,
                             "Club,Ball Speed (avg) (mph),Club Speed (mph),Launch Angle (vertical),Spin Rate [calc],"
                             "Dynamic Loft (measured),Side Angle [L/R]\n7i,115,82,16,6400,22,2 R\n");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NEAR(imported_shots(dir).find("spin_rate_rpm")->value.front(), 6400 * kRadPerSecPerRpm, 1e-9);
}

/// What --column says comes before a header that is known by itself, wherever the two stand.
TEST(Import, ByHandComesFirst) {
  const fs::path dir = test::fresh_directory("import_by_hand_first");
  const auto text = [](const char* mine) {
    return std::string(
               "Club,Ball Speed,Club Speed,Launch Angle,Spin Rate,Dynamic Loft,My Spin\n7i,115,82,16,6400,22,") +
           mine + "\n7i,116,82,16,6500,22,6700\n";
  };
  const auto o = import_text(dir, text("6600"), "--units imperial --column 'My Spin=spin_rate_rpm'");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  EXPECT_NEAR(shots.find("spin_rate_rpm")->value[0], 6600 * kRadPerSecPerRpm, 1e-9);
  EXPECT_NEAR(shots.find("spin_rate_rpm")->value[1], 6700 * kRadPerSecPerRpm, 1e-9);
  EXPECT_NE(o.text.find("a second column of spin rate"), std::string::npos) << o.text;
  fs::remove_all(dir / "case");
  test::expect_refused(import_text(dir, text("much"), "--units imperial --column 'My Spin=spin_rate_rpm'"),
                       "column 'My Spin', shot 1: 'much' is not a number");
}

/// What is said by hand of a column that is not there, or cannot be so, is no silent nothing.
TEST(Import, ByHandOnlyWhatIsThere) {
  const fs::path dir = test::fresh_directory("import_by_hand_wrong");
  const std::string text =
      "Club,Ball Speed,Club Speed,Launch Angle,Spin Rate,Dynamic Loft,Lie,Side (deg)\n7i,115,82,16,6400,22,1,2\n";
  const auto refuse = [&](const std::string& options, const std::string& why) {
    test::expect_refused(import_text(dir, text, "--units imperial " + options), why);
  };
  refuse("--column 'Lei=attack_angle_deg'", "--column 'Lei=attack_angle_deg': no column 'Lei'; did you mean 'Lie'?");
  refuse("--column 'Lei='", "no column 'Lei'; did you mean 'Lie'?");
  refuse("--column 'Klub=club'", "no column 'Klub'; did you mean 'Club'?");
  refuse("--column 'Lie (mm)=impact_toe_mm'", "no column 'Lie (mm)'");
  refuse("--keep Lei", "--keep 'Lei': no column 'Lei'; did you mean 'Lie'?");
  refuse("--keep Wetter", "no column 'Wetter'; there are: Club, Ball Speed, ");
  refuse("--column 'Lie=attack_angle_mm'",
         "'mm' is a unit of length, attack_angle wants one of angle (attack_angle_deg)");
  const auto good = import_text(dir, text, "--units imperial --column 'lie=attack_angle_deg' --column 'Side (deg)='");
  ASSERT_EQ(good.status, 0) << good.text;
  EXPECT_TRUE(imported_shots(dir).find("attack_angle_deg"));
}

/// A file of one layout: its text, and what its shots must be in our units and signs.
struct Layout {
  std::string name, text;
  std::string options;
  std::map<std::string, std::vector<double>> columns;  ///< column of shots.csv; NaN: an empty cell
  std::vector<std::string> said;
};
void PrintTo(const Layout& l, std::ostream* out) { *out << l.name; }

class Layouts : public testing::TestWithParam<Layout> {};

TEST_P(Layouts, ReadAsTheyCome) {
  const Layout& e = GetParam();
  const fs::path dir = test::fresh_directory("layout_" + e.name);
  const auto o = import_text(dir, e.text, e.options);
  ASSERT_EQ(o.status, 0) << o.text;
  for (const std::string& part : e.said) EXPECT_NE(o.text.find(part), std::string::npos) << part << "\n" << o.text;
  const loop::Shots shots = imported_shots(dir);
  for (const auto& [name, values] : e.columns) {
    const loop::Column* c = shots.find(name);
    ASSERT_NE(c, nullptr) << name << "\n" << o.text;
    ASSERT_EQ(c->value.size(), values.size()) << name;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::isnan(values[i])) EXPECT_TRUE(std::isnan(c->value[i])) << name << " " << i;
      else EXPECT_NEAR(c->native(i), values[i], 2e-5 * std::abs(values[i])) << name << " " << i;
  }
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Made after the layouts that makers and users show in public; the numbers are ours.
INSTANTIATE_TEST_SUITE_P(
    Quirks, Layouts,
    testing::Values(
        Layout{
            "TrackManBallType",
            "Date,Club,Ball,Ball Speed,Club Speed,Launch Angle,Spin Rate,Dyn. Loft\n,,,[mph],[mph],[deg],[rpm],[deg]\n"
            "2024-05-01,7 Iron,Premium,115.2,82.4,16.1,6400,22.1\n2024-05-01,7Iron,Range,116.1,82.9,16.4,6500,22.4\n"
            "2024-05-01,Iron 7,Range,114.9,82.0,16.2,6450,22.0\n",
            "",
            {{"ball_speed_mph", {115.2, 116.1, 114.9}}, {"club_speed_mph", {82.4, 82.9, 82.0}}},
            {"clubs: 7 Iron 3", "'7Iron' is '7 Iron'", "head_mass_kg"}},
        Layout{"WordsWithoutBlanks",
               "Club,BallSpeed[mph],clubHeadSpeed[mph],launchAngle,TotalSpin,FaceToTarget,FacetoPath\n"
               "7 Iron,115.2,82.4,16.1,6400,1.5,-0.5\n7 Iron,116.1,82.9,16.4,6500,0.5,0.5\n",
               "",
               {{"face_angle_deg", {1.5, 0.5}}, {"club_speed_mph", {82.4, 82.9}}, {"spin_rate_rpm", {6400, 6500}}},
               {"face minus path"}},
        Layout{
            "GarminUnitsAndEstimates",
            "Date,Player,Club Type,Club Speed,Ball Speed,Launch Angle,Launch Direction,Spin Rate,Spin Rate Type,Spin "
            "Axis,Air Density,Temperature,Air Pressure,Relative Humidity\n"
            ",,,[mph],[mph],[deg],[deg],[rpm],[],[deg],[g/L],[deg F],[kPa],[%]\n"
            "04/20/24,Jo,7 Iron,82.1,115.0,16.0,1.1,6400.2,Measured,2.5,1.2,70,101,40\n"
            "04/20/24,Jo,7 Iron,82.3,116.2,16.3,-0.4,6012.7,Estimated,-1.5,1.2,70,101,40\n"
            ",Average,,82.2,115.6,16.1,0.4,6206.4,,0.5,1.2,70,101,40\n",
            "",
            {{"spin_rate_rpm", {6400.2, kNone}}, {"azimuth_deg", {1.1, -0.4}}},
            {"1 summary row", "left out (--modelled takes it): 1 of 2"}},
        Layout{
            "ForesightWords",
            "Club,Ball Speed (mph),Club Speed (mph),Launch Angle (deg),Side Angle (deg),Total Spin (rpm),Angle of "
            "Attack "
            "(deg),Club Path (deg),Face to Target (deg),Loft (deg),Face Impact Lateral (mm),Face Impact Vertical (mm)\n"
            "7 Iron,113.5,82.9,16.5,1.2 R,6043,6.1 Down,2.3 In-Out,1.5 Open,22.6,12 Toe,3 Low\n"
            "7 Iron,114.5,83.1,16.1,0.8 L,6143,5.2 Down,1.1 Out-In,0.5 Closed,22.1,4 Heel,2 High\n",
            "",
            {{"attack_angle_deg", {-6.1, -5.2}},
             {"club_path_deg", {2.3, -1.1}},
             {"face_angle_deg", {1.5, -0.5}},
             {"impact_toe_mm", {12, -4}},
             {"impact_high_mm", {-3, 2}}},
            {}},
        Layout{"UneekorSentinels",
               "Club,Ball Speed(mph),Club Speed(mph),Launch Angle(deg),Back Spin(rpm),Side Spin(rpm),Dynamic "
               "Loft(deg),Attack "
               "Angle(deg)\n7I,115.1,82.1,16.1,6400,120,22.1,99999\n7I,115.9,82.6,16.4,6350,-99999,22.4,-4.1\n",
               "",
               {{"attack_angle_deg", {kNone, -4.1}}, {"sidespin_rpm", {120, kNone}}},
               {"cells without a reading: 1"}},
        Layout{"CellsWithUnits",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle (deg),Spin Rate,Dynamic Loft\n"
               "7i,115,82,16,6400,22\n7i,185.075 km/h,36.5 m/s,0.28 rad,6400,22\n7i,117 mph,82,16,6400,22\n",
               "",
               {{"ball_speed_mph", {115, 115.0002, 117}},
                {"club_speed_mph", {82, 81.6482, 82}},
                {"launch_angle_deg", {16, 16.0428, 16}}},
               {"cells in a unit of their own: 1"}},
        Layout{"LeftHanded",
               "Club,Handed,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate,Spin Axis,Club "
               "Path,Face Angle,Dynamic Loft,Impact Offset (mm toe-/heel+)\n"
               "7i,LH,115,82,16,1.5,6400,-3,2.0,-1.0,22,4\n7i,RH,116,82,16,1.5,6400,-3,2.0,-1.0,22,-6\n",
               "",
               {{"azimuth_deg", {-1.5, 1.5}},
                {"spin_axis_deg", {3, -3}},
                {"club_path_deg", {-2, 2}},
                {"face_angle_deg", {1, -1}},
                {"impact_toe_mm", {-4, 6}}},
               {"mirrored to a right-handed player's: 1 of 2", "sign turned"}},
        Layout{"FaceToPathNamedAPlace",
               "Club,Ball Speed (mph),Club Speed (mph),VLA,HLA,Total Spin,Loft,Path,Face to "
               "Target,HorizontalFaceImpact\n7i,115,82,16,1.5,6400,22,2.0,-1.0,-3.0\n7i,116,82,16,1.5,6400,22,1.0,0.5,-"
               "0.5\n"
               "7i,117,82,16,1.5,6400,22,0.4,0.9,0.5\n",
               "",
               {{"club_path_deg", {2, 1, 0.4}}},
               {"holds face angle minus path"}},
        Layout{"FaceToPathBesideAnglesInRadians",
               "Club,Ball Speed (mph),Club Speed (mph),VLA,HLA,Total Spin,Loft,Path (rad),Face to Target (rad),"
               "HorizontalFaceImpact\n7i,115,82,16,1.5,6400,22,0.0349,-0.0175,-3.0\n"
               "7i,116,82,16,1.5,6400,22,0.0175,0.0087,-0.5\n7i,117,82,16,1.5,6400,22,0.0070,0.0157,0.5\n",
               "",
               {{"ball_speed_mph", {115, 116, 117}}},
               {"holds face angle minus path"}},
        Layout{
            "EventInSI",
            R"({"eventType":"Live.Completed","data":{"Model":{"Measurement":{"PlayerDexterity":"Right","ImpactOffset":-0.0059,
"ImpactHeight":0.0091,"AttackAngle":4.2,"LaunchDirection":-2.777,"BallSpeed":75.7939,"ClubPath":-0.2,"ClubSpeed":51.076,
"DynamicLoft":11.748,"FaceAngle":-3.366,"LaunchAngle":10.305,"SpinAxis":-10.419,"SpinRate":2617.05,
"ReducedAccuracy":["SpinAxisFit"],"BallTrajectory":[{"Kind":"Flight","SpinRate":1},{"Kind":"Bounce"}]}}}})",
            "--club driver",
            {{"ball_speed_mps", {75.7939}},
             {"impact_toe_mm", {-5.9}},
             {"impact_high_mm", {9.1}},
             {"spin_rate_rpm", {2617.05}}},
            {"TrackMan event"}},
        Layout{"BallsAreNumbered",
               "Club,Ball,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n"
               "7i,1,115,82,16,6400,22\n7i,2,116,82,16,6500,22\n",
               "",
               {{"ball_speed_mph", {115, 116}}},
               {}},
        Layout{"ZerosAreNoReadings",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Total Spin,Spin Axis,Loft,Path,AoA\n"
               "7i,115,82,16,6400,2,22,2.0,0\n7i,116,0,16,0,0,0,0,0\n7i,117,83,0,6300,0,21,0,0\n",
               "",
               {{"club_speed_mph", {82, kNone, 83}},
                {"spin_rate_rpm", {6400, kNone, 6300}},
                {"dynamic_loft_deg", {22, kNone, 21}},
                {"club_path_deg", {2, kNone, 0}},
                {"launch_angle_deg", {16, 16, 0}}},
               {"0 taken as not measured: 1", "AoA (0 taken as not measured: 3"}},
        Layout{
            "LeftHandedYes",
            "Club,Left Handed,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate,Dynamic Loft\n"
            "7i,Yes,115,82,16,1.5,6400,22\n7i,No,116,82,16,1.5,6400,22\n",
            "",
            {{"azimuth_deg", {-1.5, 1.5}}},
            {"mirrored to a right-handed player's: 1 of 2"}},
        Layout{
            "TheHandStandsAboveTheHeader",
            "Session,Player: Jo,Handedness: Left\n"
            "Club,Hand Speed,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate,Dynamic Loft\n"
            "7i,22,115,82,16,1.5,6400,22\n7i,23,116,82,16,-1.5,6400,22\n",
            "",
            {{"azimuth_deg", {-1.5, 1.5}}},
            {"2 of 2"}},
        Layout{"ARightHandAboveTheHeaderStaysOne",
               "Handedness: Right,Bay: left\n"
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate,Dynamic Loft\n"
               "7i,115,82,16,1.5,6400,22\n7i,116,82,16,-1.5,6400,22\n",
               "",
               {{"azimuth_deg", {1.5, -1.5}}},
               {}},
        Layout{"FaceByPathAndFaceToPath",
               "Club,Ball Speed (mph),Club Speed (mph),VLA,HLA,Total Spin,Loft,Club Path,Face to Path\n"
               "7i,115,82,16,1.5,6400,22,2.0 I-O,1.5 Closed\n7i,116,82,16,1.5,6400,22,1.0 O-I,0.5 Open\n",
               "",
               {{"club_path_deg", {2, -1}}, {"face_angle_deg", {0.5, -0.5}}},
               {"Face to Path + Club Path"}},
        Layout{"ClubNamedByHand",
               "Schlaeger,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin "
               "Rate\n7i,115,82,16,6400\n8i,116,82,16,6400\n",
               "--column Schlaeger=club",
               {{"dynamic_loft_deg", {23.5, 26.5}}},
               {"clubs: 7i 1, 8i 1"}},
        Layout{
            "BlocksOfClubsWithUnitsEach",
            "Report;;;;;\nPlayer:;Jo;;;;\n7 Iron;;;;;\nNo.;Club Speed;Ball Speed;Launch Angle;Spin Rate;Dyn. Loft\n"
            ";km/h;km/h;deg;rpm;deg\n1;132,5;181,3;17,3;6523;23,4\n2;129,7;172,9;17,6;6790;24,8\nAverage;131,1;177,1;"
            "17,5;6656;24,1\n9 Iron;;;;;\nNo.;Club Speed;Ball Speed;Launch Angle;Spin Rate;Dyn. Loft\n"
            ";km/h;km/h;deg;rpm;deg\n1;120,5;155,0;24,3;8523;31,0\n",
            "",
            {{"ball_speed_kmh", {181.3, 172.9, 155.0}}, {"dynamic_loft_deg", {23.4, 24.8, 31.0}}},
            {"clubs: 7 Iron 2, 9 Iron 1", "1 repeated header", "1 repeated row of units", "1 summary row"}},
        Layout{"SummariesInAnotherLanguage",
               "Hit,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n"
               "1,7i,115,82,16,6400,22\n2,7i,116,82,16,6500,22\n3,7i,117,83,16,6500,22\n"
               "Snitt,7i,116,82.3,16,6466,22\nAvvik,7i,1,0.6,0,57,0\n",
               "",
               {{"ball_speed_mph", {115, 116, 117}}},
               {"2 summary rows"}},
        Layout{"SummariesUnderDates",
               "Date,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n"
               "2024-05-12 10:01,7i,115,82,16,6400,22\n2024-05-12 10:02,7i,116,82,16,6500,22\n"
               "2024-05-12 10:03,7i,115,81,16,6400,21\n2024-05-12 10:04,7i,116,83,16,6600,22\n"
               "2024-05-12 10:05,7i,117,83,16,6500,22\n"
               "Average,7i,115.5,82,16,6450,22\nStd. Dev.,7i,0.7,0,0,71,0\nSession average,7i,115.5,82,16,6450,22\n"
               "Max,7i,116,82,16,6500,22\n",
               "",
               {{"ball_speed_mph", {115, 116, 115, 116, 117}}},
               {"4 summary rows"}},
        Layout{"SessionsByNameMayBeCalledSo",
               "Session,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n"
               "Range 1,7i,115,82,16,6400,22\nAverage day,7i,116,82,16,6500,22\nRange 2,7i,114,82,16,6500,22\n"
               "Best,7i,117,82,16,6400,21\n",
               "",
               {{"ball_speed_mph", {115, 116, 114, 117}}},
               {}},
        Layout{"InputsThatAreNotRecordedAreUnknown",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Side Angle,Total Spin,Spin Axis\n"
               "7i,115,82,16,0.5,6400,1\n7i,116,82,16,-0.5,6500,2\n",
               "",
               {{"attack_angle_deg", {0, 0}}, {"face_angle_deg", {0, 0}}, {"impact_toe_mm", {0, 0}}},
               {"not recorded: zero, +- 4 deg", "not recorded: zero, +- 10 mm"}},
        Layout{"TwoColumnsOfOneQuantity",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Spin Rate,Dynamic Loft\n"
               "7i,115,82,16,6400,6600,22\n7i,116,82,16,6500,6700,22\n",
               "",
               {{"spin_rate_rpm", {6400, 6500}}},
               {"in kept.csv only: Spin Rate (a second column of spin rate)"}},
        Layout{"LeftHandedInThePlayersOwnWords",
               "Hand,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Side Angle,Total Spin,Spin Axis,Club "
               "Path,Face to "
               "Target,Loft\nLeft,7i,109.9,81,17,0.7 R,7003,3.0 R,0.5 In-Out,0.9 Closed,24\n"
               "Left,7i,108.6,81,16,2.7 L,7076,3.4 L,4.0 Out-In,2.4 Open,23\n",
               "",
               {{"azimuth_deg", {-0.7, 2.7}},
                {"spin_axis_deg", {-3, 3.4}},
                {"club_path_deg", {0.5, -4}},
                {"face_angle_deg", {-0.9, 2.4}}},
               {"2 of 2 shots"}},
        Layout{"GermanHeadersAndEstimates",
               "Datum,Schlägername,Schlägertyp,Schlägerkopfgeschwindigkeit,Ballgeschwindigkeit,Abflugwinkel,"
               "Abflugrichtung,"
               "Spinrate,Spinraten-Typ,Spinachse\n,,,[km/h],[km/h],[deg],[deg],[rpm],,[deg]\n"
               "14.05.24,G430,Eisen 7,130.1,180.3,17.0,1.2,6400,Gemessen,2.5\n"
               "14.05.24,G430,Eisen 7,131.2,181.4,17.4,-0.4,6100,Geschätzt,-1.5\n",
               "",
               {{"ball_speed_kmh", {180.3, 181.4}}, {"spin_rate_rpm", {6400, kNone}}, {"spin_axis_deg", {2.5, kNone}}},
               {"clubs: Eisen 7 2", "left out (--modelled takes it): 1 of 2"}},
        Layout{"TheSideStandsInFront",
               "Club,Ball Speed(mph),Club Speed(mph),Launch Angle(°),Side Angle(°),Total Spin(rpm),Spin Axis(°),Loft\n"
               "IRON7,106.0,81.4,16.6,L1.5,6384,R 5.2,23\nIRON7,107.0,81.9,16.1,R0.4,6484,0.0,23\n",
               "",
               {{"azimuth_deg", {-1.5, 0.4}}, {"spin_axis_deg", {5.2, 0}}},
               {}},
        Layout{
            "OneWordWithTwoUnits",
            "Club:,7 Iron\nSHOT,HAND,BALL (mph),LAUNCH (deg),BACK (rpm),SIDE (rpm),SIDE (deg),CARRY (yds),CLUB (mph)\n"
            "1,L,113,18.0,6547,829,-0.8,162.8,82\n2,R,115,16.9,6740,358,-1.2,167.3,82\n",
            "",
            {{"azimuth_deg", {0.8, -1.2}}, {"sidespin_rpm", {-829, 358}}, {"launch_angle_deg", {18, 16.9}}},
            {"clubs: 7 Iron 2"}},
        Layout{"NoUnitButACarry",
               "\"Rapsodo MLM2PRO: Jo\"\n\"Club Type\",\"Carry Distance\",\"Ball Speed\",\"Launch Angle\",\"Launch "
               "Direction\",\"Club Speed\",\"Spin Rate\",\"Spin "
               "Axis\"\n\"pw\",\"111.0\",\"153.4\",\"25.4\",\"3.0\",\"121.2\","
               "\"9178\",\"8.0\"\n\"pw\",\"108.9\",\"149.1\",\"23.5\",\"0.8\",\"121.3\",\"8426\",\"-2.1\"\n",
               "",
               {{"ball_speed_kmh", {153.4, 149.1}}, {"club_speed_kmh", {121.2, 121.3}}},
               {"no unit in the file: this one by its carry"}},
        Layout{
            "MessagesBetweenTheShots",
            "{\"Code\":201,\"Player\":{\"Handed\":\"LH\",\"Club\":\"DR\"}}\n"
            "{\"DeviceID\":\"x\",\"ShotNumber\":0,\"ShotDataOptions\":{\"IsHeartBeat\":true}}\n"
            "{\"ShotNumber\":1,\"BallData\":{\"Speed\":149.8,\"TotalSpin\":2471,\"SpinAxis\":5,\"HLA\":-0.5,\"VLA\":13}"
            ","
            "\"ClubData\":{\"Speed\":101.8,\"Loft\":14,\"Path\":-2.9,\"FaceToTarget\":0.5}}\n"
            "{\"Code\":201,\"Player\":{\"Handed\":\"RH\",\"Club\":\"I7\"}}\n"
            "{\"ShotNumber\":2,\"BallData\":{\"Speed\":115,\"TotalSpin\":6400,\"SpinAxis\":5,\"HLA\":-0.5,\"VLA\":16},"
            "\"ClubData\":{\"Speed\":82,\"Loft\":23,\"Path\":-2.9,\"FaceToTarget\":0.5}}\n",
            "",
            {{"ball_speed_mph", {149.8, 115}}, {"club_path_deg", {2.9, -2.9}}, {"dynamic_loft_deg", {14, 23}}},
            {"3 messages without a shot", "clubs: DR 1, I7 1", "1 of 2 shots"}},
        Layout{"MarkedEstimates",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n"
               "7i,115,82,16,6401*,22\n7i,116,82,16,6500,22\n7i,117,82,16,6806 (est.),22\n",
               "",
               {{"spin_rate_rpm", {kNone, 6500, kNone}}},
               {"marked as estimated, left out (--modelled takes them): 2"}},
        Layout{"TheClubStandsBesideItsBrand",
               "Club Name,Club Type,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n"
               "Apex,7 Iron,115,82,16,6400\nApex,8 Iron,112,81,18,7000\n",
               "",
               {{"dynamic_loft_deg", {23.5, 26.5}}},
               {"clubs: 7 Iron 1, 8 Iron 1"}},
        Layout{"NarrowBlanksAndFrenchClubs",
               "Club;Club Speed (km/h);Ball Speed (km/h);Launch Angle (deg);Spin Rate (rpm)\n"
               "Fer 7;129,7;177,4;17,4;5\xE2\x80\xAF"
               "879\nFer 7;129,3;172,3;17,5;6\xC2\xA0"
               "450\n",
               "",
               {{"spin_rate_rpm", {5879, 6450}}, {"dynamic_loft_deg", {23.5, 23.5}}},
               {}},
        Layout{"ByHandWithItsUnit",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Loft,OFF (rpm),OFF (deg)\n"
               "7i,115,82,16,6400,22,300,1.5\n7i,116,82,16,6500,22,-200,-0.5\n",
               "--column 'OFF (deg)=azimuth_deg' --column 'OFF (rpm)=sidespin_rpm'",
               {{"azimuth_deg", {1.5, -0.5}}, {"sidespin_rpm", {300, -200}}},
               {}},
        Layout{"ABlockWhoseClubIsNotKnown",
               "7 Iron,,,,\nNo.,Club Speed (mph),Ball Speed (mph),Launch Angle,Spin Rate\n1,82,115,16,6400\n"
               "Chipper,,,,\nNo.,Club Speed (mph),Ball Speed (mph),Launch Angle,Spin Rate\n1,70,90,20,4000\n",
               "",
               {{"ball_speed_mph", {115, 90}}, {"dynamic_loft_deg", {23.5, kNone}}},
               {"clubs: 7 Iron 1, Chipper 1", "not a known club: Chipper"}},
        Layout{"ListsOfShotsWithTheirClub",
               R"({"player":"Jo","handed":"LH","average":{"ballSpeed":60,"clubSpeed":44},"groups":[
{"club":"7 Iron","strokes":[{"ballSpeed":50,"clubSpeed":36,"launchAngle":16,"launchDirection":1,"spinRate":6400}]},
{"club":"8 Iron","strokes":[{"ballSpeed":47,"clubSpeed":35,"launchAngle":18,"launchDirection":-2,"spinRate":7000},
{"ballSpeed":48,"clubSpeed":36,"launchAngle":18,"launchDirection":0,"spinRate":7000}]}]})",
               "--column ballSpeed=ball_speed_mps --column clubSpeed=club_speed_mps",
               {{"ball_speed_mps", {50, 47, 48}}, {"azimuth_deg", {-1, 2, 0}}},
               {"clubs: 7 Iron 1, 8 Iron 2", "3 of 3 shots"}},
        Layout{"NamesThatHoldAWordOfASummary",
               "Location,Player,Session,Club Model,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n"
               "Range,Dev Patel,Consistency drill,MAX,7i,115,82,16,6400\nRange,Max,Session 2,MAX,7i,116,82,16,6400\n",
               "",
               {{"ball_speed_mph", {115, 116}}},
               {}},
        Layout{"SpinMeasuredYesOrNo",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Spin Axis,Spin Measured,Spin Axis Type\n"
               "7i,115,82,16,6400,2,Yes,Estimated\n7i,116,82,16,6500,3,No,Measured\n"
               "7i,117,83,16,6600,4,Yes,Measured\n",
               "",
               {{"spin_rate_rpm", {6400, kNone, 6600}}, {"spin_axis_deg", {kNone, kNone, 4}}},
               {}},
        Layout{"AnInchSignInACell",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Notes\n"
               "7i,115,82,16,6400,3\" behind\n7i,116,82,16,6500,4\" behind\n",
               "",
               {{"ball_speed_mph", {115, 116}}},
               {}},
        Layout{"TheLayoutsUnitIsNotTheBestFit",
               "\"Rapsodo MLM2PRO: Jo\"\nClub Type,Carry Distance (m),Ball Speed,Launch Angle,Club Speed,Spin Rate\n"
               "7i,150,185,16.5,132,6500\n7i,151,186,16.5,132,6500\n",
               "",
               {{"ball_speed_kmh", {185, 186}}},
               {"this one by its carry"}},
        Layout{"SignsThatAHeaderOnlyMentions",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction (Right/Left +/-),Spin Rate,Impact "
               "Offset "
               "(mm toe-/heel+)\n7i,115,82,16,1.5,6400,5 Toe\n7i,116,82,16,-1.5,6500,-4\n",
               "",
               {{"azimuth_deg", {1.5, -1.5}}, {"impact_toe_mm", {5, 4}}},
               {}},
        Layout{"AsManySummariesAsShots",
               "Date,Club,Club Speed (mph),Ball Speed (mph),Launch Angle (deg),Spin Rate (rpm),Dyn. Loft (deg)\n"
               "2024-05-01,7 Iron,82.1,112.0,16.4,6500,22.4\n2024-05-01,7 Iron,81.7,111.4,16.8,6600,22.9\n"
               "Average,7 Iron,81.9,111.7,16.6,6550,22.6\nStd. Dev.,7 Iron,0.3,0.4,0.3,70,0.3\n"
               "2024-05-01,8 Iron,81.1,109.0,18.4,7500,26.4\n2024-05-01,8 Iron,80.7,108.4,18.8,7600,26.9\n"
               "Average,8 Iron,80.9,108.7,18.6,7550,26.6\nStd. Dev.,8 Iron,0.3,0.4,0.3,70,0.3\n",
               "",
               {{"club_speed_mph", {82.1, 81.7, 81.1, 80.7}}},
               {"4 summary rows"}},
        Layout{
            "AsManySummariesAsShotsInGerman",
            "Datum;Schlägertyp;Ballgeschwindigkeit (km/h);Schlägerkopfgeschwindigkeit (km/h);Abflugwinkel;Gesamtspin\n"
            "01.05.2024;Eisen 7;180,2;132,1;16,2;6.512\n01.05.2024;Eisen 7;179,8;131,9;16,4;6.602\n"
            "Durchschnitt;;180,0;132,0;16,3;6.557\nStd.-Abw.;;0,2;0,1;0,1;45\n",
            "",
            {{"spin_rate_rpm", {6512, 6602}}, {"ball_speed_kmh", {180.2, 179.8}}},
            {"2 summary rows"}},
        Layout{"APointInAWordIsNoDecimalPoint",
               "Schlägertyp;Ballgeschwindigkeit (km/h);Schlägerkopfgeschwindigkeit (km/h);Abflugwinkel;Gesamtspin;Ort\n"
               "Eisen 7;180,2;132,1;16,2;6.512;St.-And.\nEisen 7;179,8;131,9;16,4;6.602;St.-And.\n",
               "",
               {{"spin_rate_rpm", {6512, 6602}}},
               {}},
        Layout{
            "GroupsAboveEachName",
            "Ball,Ball,Ball,Ball,Club,Club,Club\nSpeed,Launch Angle,Spin,Direction,Speed,Path,AoA\n"
            "mph,deg,rpm,deg,mph,deg,deg\n112.1,16.5,6500,1.2 L,82.1,0.5 R,-3.1\n111.5,16.9,6600,0.2 R,81.6,0.7 "
            "R,-3.3\n",
            "--club 7i",
            {{"ball_speed_mph", {112.1, 111.5}}, {"club_speed_mph", {82.1, 81.6}}, {"attack_angle_deg", {-3.1, -3.3}}},
            {"Ball Speed"}},
        Layout{"GroupsAsManyAsKnownNames",
               "Ball,Ball,Club,Club\nSpeed (mph),Launch Angle,Speed (mph),Loft\n115,16,82,22\n116,16,82,22\n",
               "--club 7i",
               {{"ball_speed_mph", {115, 116}}, {"club_speed_mph", {82, 82}}, {"dynamic_loft_deg", {22, 22}}},
               {}},
        Layout{
            "GroupsOnceAboveTheirNames",
            "Ball,,,,Club,,\nSpeed (mph),Launch Angle (deg),Spin (rpm),Direction (deg),Speed (mph),Path (deg),Name\n"
            "112.1,16.5,6500,1.2 L,82.1,0.5 R,7i\n"
            "Speed (mph),Launch Angle (deg),Spin (rpm),Direction (deg),Speed (mph),Path (deg),Name\n"
            "111.5,16.9,6600,0.2 R,81.6,0.7 R,8i\n",
            "",
            {{"ball_speed_mph", {112.1, 111.5}}, {"club_speed_mph", {82.1, 81.6}}, {"dynamic_loft_deg", {23.5, 26.5}}},
            {"Club Name", "1 repeated header"}},
        Layout{"TheMedianOfTwoIsTheirMean",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n7i,112.1,82.3,16.2,6500\n"
               "7i,111.3,81.5,16.5,6600\n",
               "",
               {},
               {"ball_speed_mph            2       111.7"}},
        Layout{"AWordAboveABlank",
               "SHOT,CLUB,BALL,LAUNCH,SPIN,CLUB\n,,SPEED (MPH),ANGLE (DEG),RATE (RPM),SPEED (MPH)\n"
               "1,7i,115,16,6400,82\n2,7i,116,16.5,6500,82\n",
               "",
               {{"ball_speed_mph", {115, 116}}, {"club_speed_mph", {82, 82}}, {"launch_angle_deg", {16, 16.5}}},
               {"clubs: 7i 2"}},
        Layout{"AUnitBelowMakesAName",
               "CLUB,BALL SPEED,LAUNCH,BACK,SIDE,CLUB SPEED\n,MPH,DEG,RPM,DEG,MPH\n7i,115,16,6400,-1,82\n"
               "7i,116,16.5,6500,2,82\n",
               "",
               {{"launch_angle_deg", {16, 16.5}}, {"backspin_rpm", {6400, 6500}}, {"azimuth_deg", {-1, 2}}},
               {}},
        Layout{"ABrandBesideTheClub",
               "Club,Club Type,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n"
               "TaylorMade P790,7 Iron,115,82,16,6400\nTaylorMade P790,8 Iron,110,81,18,7000\n",
               "",
               {{"club_speed_mph", {82, 81}}, {"dynamic_loft_deg", {23.5, 26.5}}},
               {"clubs: 7 Iron 1, 8 Iron 1"}},
        Layout{"CellsOfManyForms",
               "Club;Ball Speed (mph);Club Speed (mph);Launch Angle;Launch Direction;Club Path;Spin Rate;Dynamic Loft\n"
               "7i;115;82;16;0.4-;2.8 in to out;6’279;22\n7i;116;#DIV/0!;16;(0.6);1.1 out to in;6’300;Err\n"
               "7i;117;82;16;0.4+;?;6’400;22\n",
               "",
               {{"azimuth_deg", {-0.4, -0.6, 0.4}},
                {"club_path_deg", {2.8, -1.1, kNone}},
                {"spin_rate_rpm", {6279, 6300, 6400}},
                {"dynamic_loft_deg", {22, kNone, 22}}},
               {}},
        Layout{"TheHeadsMassIsRecorded",
               "Club,Head Mass (g),Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n"
               "Mine,271,115,82,16,6400,22\nYours,265,116,82,16,6500,22\n",
               "",
               {{"head_mass_kg", {0.271, 0.265}}},
               {"g made kg"}},
        Layout{
            "GarminInDutch",
            "Datum,Speler,Clubnaam,Type club,Clubsnelh.,Balsnelheid,Slaghoek,Spinsnelheid,Type draaisnelheid,Spinas\n"
            ",,,,[km/u],[km/u],[deg],[rpm],,[deg]\n05/11/24,Jo,G430,IJzer 7,130.1,180.3,17,6400,Gemeten,2.5\n"
            "05/11/24,Jo,G430,IJzer 7,131.2,181.4,17.4,6100,Geschat,-1.5\n",
            "",
            {{"ball_speed_kmh", {180.3, 181.4}}, {"spin_rate_rpm", {6400, kNone}}},
            {"clubs: IJzer 7 2", "left out (--modelled takes it): 1 of 2"}},
        Layout{"DatesBesideAWord",
               "Date,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n2024-05-12,115,82,16,6400\n"
               "2024-05-12,116,82,16,6500\n2024-05-12,117,83,16,6500\nKeskipoikkeama,1,0.6,0,57\n",
               "--club 7i",
               {{"ball_speed_mph", {115, 116, 117}}},
               {"1 summary row"}},
        Layout{"SignTurnedByHand",
               "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft,Strike\n"
               "7i,115,82,16,6400,22,3\n7i,116,82,16,6400,22,-4\n",
               "--column 'Strike=-impact_toe_mm'",
               {{"impact_toe_mm", {-3, 4}}},
               {"sign turned"}}),
    [](const auto& info) { return info.param.name; });

TEST(Import, WhatWouldBeReadWrongIsRefused) {
  const fs::path dir = test::fresh_directory("import_wrong");
  const auto refuse = [&](const std::string& text, const std::string& why) {
    const auto o = import_text(dir, text);
    EXPECT_EQ(o.status, 2) << o.text;
    EXPECT_NE(o.text.find(why), std::string::npos) << o.text;
  };
  const std::string points = "Club Type;Ball Speed (mph);Club Speed (mph);Launch Angle;Spin Rate;Dynamic Loft\n";
  refuse(points + "7i;115,1;82,1;16,1;6400;22,1\n7i;115,3;85.5;16,2;6400;22,3\n7i;115,3;82,5;16,2;6400;22,3\n",
         "column 'Club Speed (mph)', shot 2: '85.5' among 2");
  const std::string commas = "Club Type,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n";
  refuse(commas + "7i,115.1,82.1,16.1,6400,22.1\n7i,115.3,82.4,\"1,3\",6400,22.3\n7i,115.3,82.4,16.3,6400,22.3\n",
         "shot 2: '1,3' among 2");
  refuse(commas + "7i,115.1,82.1,16.1,6400,22.1,9\n", "shot 1 has 7 cells under 6 names");
  refuse(commas + "7i,115.1,82.1,16.1 mph,6400,22.1\n", "is in another kind of unit");
  refuse("Player Hand," + commas + "Middle,7i,115.1,82.1,16.1,6400,22.1\n", "'Middle' is neither left nor right");
  refuse(
      "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft,Carry (yd)\n"
      "7i,115,82,16,6400,22,90\n7i,116,82,16,6500,22,92\n",
      "of what the ball's speed (115.5 mph), launch angle and spin make");
  refuse(
      "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft,Carry\n"
      "7i,115,82,16,6400,22,90 yd\n7i,116,82,16,6500,22,92 yd\n",
      "of what the ball's speed (115.5 mph), launch angle and spin make");
  refuse("Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n7i,115,-,16,6400,22\n",
         "column 'Club Speed (mph)' is empty");
  refuse(
      "Club,Ball Speed,Club Speed,Launch Angle,Spin Rate,Dynamic Loft\n,mph,mph,deg,rpm,deg\n7i,115,82,16,6400,22\n"
      ",km/h,km/h,deg,rpm,deg\n7i,185,132,16,6400,22\n",
      "the units change after shot 1");
  refuse(
      "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft,Side Angle\n"
      "7i,115,82,16,6400,22,-2.5 L\n",
      "'-2.5 L' is not a number");
  refuse("Velo,Kopf,Abflug\n185.1,132.0,16.4\n", "--column 'Velo=?'    185.1, ...");
}

/// Three files: one club in each, other units, spellings and hands.
TEST(Import, SeveralFilesMakeOneBag) {
  const fs::path dir = test::fresh_directory("import_bag");
  const auto quoted = [&](const char* name) { return " '" + (dir / name).string() + "'"; };
  test::write(dir / "a.csv",
              "Club,Shot,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft,Carry (yd)\n"
              "7 Iron,1,115,82,16,6400,22,160\n7 Iron,2,117,83,17,6500,23,164\n");
  test::write(dir / "b.csv",
              "Club,Handed,Shot,Ball Speed (km/h),Club Speed (km/h),Launch Angle,Spin Rate,Dynamic Loft,Carry (m)\n"
              "7i,LH,1,186.683,133.575,18,6600,24,146.304\n");
  test::write(dir / "pw.csv",
              "Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft\n90,76,25,8500,36\n");
  const auto o = command("import" + quoted("a.csv") + quoted("b.csv") + quoted("pw.csv") + " --out" + quoted("bag"));
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = loop::read_shots(post::read_csv(dir / "bag" / "shots.csv"));
  ASSERT_EQ(shots.rows(), 4u) << o.text;
  EXPECT_EQ(shots.find("club")->text, (std::vector<std::string>{"7 Iron", "7 Iron", "7 Iron", "pw"}));
  EXPECT_EQ(shots.find("shot"), nullptr) << "the numbers of several files are no order";
  EXPECT_NEAR(shots.find("ball_speed_mph")->native(2), 116, 2e-3);
  const std::string kept = test::content(dir / "bag" / "kept.csv");
  EXPECT_NE(kept.find(",pw.csv\n"), std::string::npos) << kept;
  for (const std::string said :
       {"b.csv: '7i' is '7 Iron' of a.csv", "left-handed shots in b.csv; none in a.csv, pw.csv",
        "club, from the name of the file: pw", "116.0 +- 1.0", "17.0 +- 1.0", "6500 +- 100", "161.3 +- 2.3",
        "90.0 (1 shot)", "attack_angle_deg: not recorded: zero, +- 4 deg", "hosel run "})
    EXPECT_NE(o.text.find(said), std::string::npos) << said << "\n" << o.text;
  const auto run = command("run" + quoted("bag") + " --quiet --out" + quoted("out"));
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_EQ(nlohmann::json::parse(test::content(dir / "out" / "report.json"))["rows"]["read"], 4);

  const auto twice = command("import" + quoted("a.csv") + quoted("a.csv") + " --out" + quoted("twice"));
  EXPECT_EQ(twice.status, 2);
  EXPECT_NE(twice.text.find("given twice"), std::string::npos) << twice.text;
}

/// The page of an imported session: a line for each club, and its shots where the flight of each measured launch ends.
TEST(Import, ThePageSaysWhereTheShotsLand) {
  const fs::path dir = test::fresh_directory("import_landings");
  ASSERT_EQ(
      import_text(
          dir,
          "Hand,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate,Spin Axis,Dynamic Loft\n"
          "L,7i,115,82,16,1,6400,0,22\nL,7i,117,83,17,-1,6500,2,23\nL,7i,116,82,16,0,6450,-1,22\n"
          "L,PW,100,76,24,0,8500,1,33\nL,PW,101,76,24,,8500,1,33\n")
          .status,
      0);
  const auto o = command("run '" + (dir / "case").string() + "' --out '" + (dir / "out").string() + "'");
  ASSERT_EQ(o.status, 0) << o.text;
  const post::Sheet landings = post::read_csv(dir / "out" / "landings.csv");
  ASSERT_EQ(landings.rows(), 5u);
  EXPECT_EQ(landings.columns[3][4], "") << "no direction, no side";
  ASSERT_EQ(landings.names[2], "carry_yd");
  // By itself: the flight of the first launch, whose direction was mirrored.
  Launch first;
  const double v = 115 * 0.44704, a = radians(16), d = radians(-1), spin = 6400 * 2 * kPi / 60;
  first.velocity = v * Vec3(std::cos(a) * std::cos(d), -std::cos(a) * std::sin(d), std::sin(a));
  first.spin = Vec3(0, -spin, 0);
  const models::Flight flight = models::fly(first, Ball{}, {});
  ASSERT_GT(flight.carry, 100);
  EXPECT_NEAR(std::stod(landings.columns[2][0]), flight.carry / 0.9144, 0.3);
  EXPECT_NEAR(std::stod(landings.columns[3][0]), flight.side / 0.9144, 0.1);
  EXPECT_LT(std::stod(landings.columns[3][0]), -1);
  const std::string page = test::content(dir / "out" / "report.html");
  EXPECT_NE(page.find("The clubs"), std::string::npos);
  EXPECT_NE(page.find("116.0 ± 1.0"), std::string::npos) << "mean and deviation of the 7-iron's ball speed";
  EXPECT_NE(page.find("the player's left"), std::string::npos);
  EXPECT_TRUE(fs::exists(dir / "out" / "figures" / "landings.png") || o.text.find("gnuplot") != std::string::npos);
}

/// What the loop flags is no shot of a club's mean.
TEST(Import, AFlaggedShotCountsInNoMean) {
  const fs::path dir = test::fresh_directory("import_flagged");
  std::string text =
      "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate,Spin Axis,Dynamic Loft\n";
  for (int i = 0; i < 24; ++i)
    text += fmt::format("7i,{},{},{},{},{},{},{}\n", i == 9 ? 230 : 114 + i % 5, 82 + 0.7 * (i % 5), 16 + 0.3 * (i % 4),
                        i % 3 - 1, 6400 + 40 * (i % 7), i % 4 - 1, 22 + 0.4 * (i % 4));
  ASSERT_EQ(import_text(dir, text).status, 0);
  const auto o = command("run '" + (dir / "case").string() + "' --out '" + (dir / "out").string() + "'");
  ASSERT_EQ(o.status, 0) << o.text;
  const post::Sheet landings = post::read_csv(dir / "out" / "landings.csv");
  EXPECT_EQ(landings.rows(), 23u);
  const std::string page = test::content(dir / "out" / "report.html");
  EXPECT_NE(page.find("1 shot that the loop flagged is left out"), std::string::npos);
  EXPECT_NE(page.find("115.8 ± 1.4"), std::string::npos) << "of the other 23";
}

/// Two sessions number their shots alike: of a flagged shot's number the one of the same line is left out.
TEST(Landings, AFlaggedShotOfOneSessionIsNoneOfAnother) {
  const fs::path dir = test::fresh_directory("landings_sessions");
  std::string text =
      "session,shot,club,club_speed_mps,dynamic_loft_deg,ball_speed_mps,launch_angle_deg,spin_rate_rpm\n";
  for (int i = 0; i < 36; ++i) {
    const double speed = 38 + 0.37 * ((i * 7) % 11), loft = 18 + 0.45 * ((i * 5) % 10);
    text += fmt::format("{},{},7i,{:.2f},{:.2f},{:.2f},{:.2f},{:.0f}\n",
                        i < 12   ? "mon"
                        : i < 24 ? "tue"
                                 : "wed",
                        i % 12 + 1, speed, loft, 1.36 * speed + 0.05 * ((i * 3) % 7), 0.79 * loft,
                        5250 + 190 * (loft - 20) + 8 * ((i * 3) % 5));
  }
  test::write(dir / "shots.csv", text);
  const loop::Shots shots = loop::read_shots(post::read_csv(dir / "shots.csv"));
  ASSERT_EQ(std::ranges::count(shots.id, shots.id[16]), 3);
  const loop::Flag flag{16, shots.line[16], shots.id[16], "ball_speed_mps", "far off", 1};
  EXPECT_EQ(flagged_rows({flag}, shots), std::set<std::size_t>{16});
}

/// Where the carry alone tells the unit of a speed, it is in the yards or metres that go with that unit.
TEST(Import, ACarryThatTellsTheUnitIsReadInItsOwn) {
  const fs::path dir = test::fresh_directory("import_carry_unit");
  const std::string head = "Club,BallSpeed,ClubSpeed,VLA,HLA,TotalSpin,Carry\n";
  test::write(dir / "a.csv", head + "7i,115,82,16,1,6400,155\n7i,116,82,16,0,6400,157\n");
  test::write(dir / "b.csv", head + "8i,110,80,18,1,7000,146\n8i,111,80,18,0,7000,148\n");
  const auto o = command("import '" + (dir / "a.csv").string() + "' '" + (dir / "b.csv").string() + "' --out '" +
                         (dir / "case").string() + "'");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("ball speed [mph]"), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("carry [yd]"), std::string::npos) << o.text;
}

TEST(Import, ByHand) {
  const fs::path dir = test::fresh_directory("import_by_hand");
  const auto o = import_text(
      dir,
      "Schlaeger;Ballgeschw.;Kopfgeschw.;Abflug;Drall;Loft dyn.;Wetter\n7i;185,1;132,0;16,4;6400;22,1;warm\n"
      "7i;186,2;133,1;16,1;6500;22,3;kalt\n",
      "--column 'Ballgeschw.=ball_speed_kmh' --column 'Kopfgeschw.=club_speed_kmh' --column "
      "'Abflug=launch_angle_deg' --column 'Drall=spin_rate_rpm' --column 'Loft dyn.=dynamic_loft_deg' "
      "--keep Wetter --club 7i");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  EXPECT_NEAR(shots.find("ball_speed_kmh")->native(0), 185.1, 1e-9);
  EXPECT_EQ(shots.find("head_mass_kg"), nullptr) << "one club: its mass is the head's own";
  EXPECT_NE(test::content(dir / "case" / "case.toml").find("[head]\nmass_kg = 0.269 "), std::string::npos);
  EXPECT_EQ(shots.find("kept_wetter")->text[1], "kalt");
}

TEST(Import, KeptNumbersWithADecimalCommaAreNumbers) {
  const fs::path dir = test::fresh_directory("import_kept_comma");
  const auto o = import_text(
      dir,
      "Club;Ball Speed (mph);Club Speed (mph);Launch Angle;Spin Rate;Tempo;Wind;Day;Temp\n"
      "7i;115,1;82,0;16,4;6400;0,85;kalt, nass;01.11.2025;21,5\n7i;116,2;82,1;16,1;6500;0,9;;01.11.2025;21.5\n",
      "--keep Tempo --keep Wind --keep Day --keep Temp");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  ASSERT_TRUE(shots.find("kept_tempo") && shots.find("kept_tempo")->numeric) << o.text;
  EXPECT_NEAR(shots.find("kept_tempo")->native(0), 0.85, 1e-12);
  EXPECT_EQ(shots.find("kept_wind")->text[0], "kalt, nass");
  // A date is no number, and beside 21.5 what 21,5 is nobody knows.
  EXPECT_NE(test::content(dir / "case" / "shots.csv").find("01.11.2025,\"21,5\","), std::string::npos);
}

/// What is kept aside is read by other programs, too.
TEST(Import, KeptFileHasDecimalPoints) {
  const fs::path dir = test::fresh_directory("import_kept_point");
  const auto o =
      import_text(dir,
                  "Club;Ball Speed (mph);Club Speed (mph);Launch Angle;Spin Rate;Carry (yd);Tempo;Day\n"
                  "7i;115,1;82,0;16,4;6400;163,4;0,85;01.11.2025\n7i;116,2;82,1;16,1;6500;165,0;0,9;01.11.2025\n");
  ASSERT_EQ(o.status, 0) << o.text;
  const post::Sheet kept = post::read_csv(dir / "case" / "kept.csv");
  const auto column = [&](const std::string& name) {
    const auto at = std::ranges::find(kept.names, name);
    return at == kept.names.end() ? std::vector<std::string>{} : kept.columns[std::size_t(at - kept.names.begin())];
  };
  EXPECT_EQ(column("Carry (yd)"), (std::vector<std::string>{"163.4", "165.0"}));
  EXPECT_EQ(column("Tempo"), (std::vector<std::string>{"0.85", "0.9"}));
}

/// Shots that no blow makes are imported, counted and named.
TEST(Import, AShotThatNoBlowMakesIsDoubted) {
  const fs::path dir = test::fresh_directory("import_implausible");
  std::string text = "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Carry (yd)\n";
  for (int i = 0; i < 12; ++i)
    text +=
        fmt::format("7i,{},82,16,{},{}\n", i == 4 ? 140 : 115 + 0.1 * i, i == 5 ? 30000 : 6400, i == 6 ? -163 : 163);
  const auto o = import_text(dir, text);
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_EQ(imported_shots(dir).rows(), 12u);
  EXPECT_NE(o.text.find("in doubt: 1 of 12 shots: ball speed over club speed is 1.707 at the worst"), std::string::npos)
      << o.text;
  EXPECT_NE(o.text.find("shots.csv:6; they stay in"), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("spin rate is 3e+04 rpm"), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("carry is -149 m at the worst"), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("kept.csv:8"), std::string::npos) << o.text;
  const auto checked = command("check '" + (dir / "case").string() + "'");
  EXPECT_NE(checked.text.find("# in doubt: [data] 1 of 12 shots: ball speed over club speed"), std::string::npos)
      << checked.text;
}

TEST(Import, ObjectsOfValueAndUnitAreCells) {
  const fs::path dir = test::fresh_directory("import_value_unit");
  const auto shot = [](double ball) {
    return fmt::format(
        R"({{"Club":"7i","BallSpeed":{{"value":{},"unit":"mph"}},"ClubSpeed":{{"value":82,"unit":"mph"}},)"
        R"("LaunchAngle":{{"value":16,"unit":"deg"}},"SpinRate":{{"value":6400,"unit":"rpm"}}}})",
        ball);
  };
  const auto o = import_text(dir, "[" + shot(111) + "," + shot(112.5) + "]");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  EXPECT_NEAR(shots.find("ball_speed_mph")->native(1), 112.5, 1e-9);
}

/// Headers that read alike are columns of their own, each with its cells.
TEST(Import, KeptColumnsOfOneNameStayApart) {
  const fs::path dir = test::fresh_directory("import_kept_twice");
  const auto o = import_text(
      dir,
      "Club,BallSpeed,ClubSpeed,VLA,HLA,TotalSpin,Mat,mat\n7i,115,82,16,1,6400,new,wet\n7i,116,82,16,0,6400,old,dry\n",
      "--units imperial --keep mat");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  ASSERT_TRUE(shots.find("kept_mat") && shots.find("kept_mat_2"));
  EXPECT_EQ(shots.find("kept_mat")->text[1], "old");
  EXPECT_EQ(shots.find("kept_mat_2")->text[1], "dry");
}

/// A later header places its own columns; a quantity that changes its unit, its name or its signs there is refused.
TEST(Import, EachPartIsReadByItsOwnHeader) {
  const fs::path dir = test::fresh_directory("import_parts");
  const std::string names = "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Club Path (in-out +)\n",
                    first = names + "7i,115,82,16,6400,2\n";
  const auto o = import_text(dir, first +
                                      "Club,Launch Angle,Club Speed (mph),Apex,Ball Speed (mph),Spin Rate\n"
                                      "8i,18,81,90,110,7000\n" +
                                      names + "7i,116,82,16,6500,3\n");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  for (const auto& [name, of_second] :
       {std::pair{"ball_speed_mph", 110.0}, {"club_speed_mph", 81}, {"spin_rate_rpm", 7000}}) {
    ASSERT_EQ(shots.find(name)->value.size(), 3u);
    EXPECT_NEAR(shots.find(name)->native(1), of_second, 1e-9) << name;
  }
  EXPECT_TRUE(std::isnan(shots.find("club_path_deg")->value[1]));
  EXPECT_NEAR(shots.find("club_path_deg")->native(2), 3, 1e-9);
  EXPECT_NE(o.text.find("2 repeated headers"), std::string::npos) << o.text;
  for (const auto& [head, why] :
       {std::pair{"Club,Ball Speed (km/h),Club Speed (mph),Launch Angle,Spin Rate,Club Path (in-out +)",
                  "a later header has 'Ball Speed (km/h)' where the first has 'Ball Speed (mph)'"},
        {"Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Club Path (in-out -)",
         "a later header has 'Club Path (in-out -)'"}}) {
    fs::remove_all(dir / "case");
    test::expect_refused(import_text(dir, first + head + "\n8i,185,81,18,7000,2\n"), why);
  }
}

/// Letters that are not Latin are kept where headers and names are compared; accents are not.
TEST(Import, OtherScriptsHaveNamesOfTheirOwn) {
  const fs::path dir = test::fresh_directory("import_scripts");
  test::write(dir / "d.toml",
              "club = [{names = [\"アイアン七\"], head_mass_kg = 0.27, loft_deg = 24.0}, "
              "{names = [\"ウェッジ\"], head_mass_kg = 0.29, loft_deg = 38.0}]\n");
  const auto o = import_text(dir,
                             "Клюшка,Скорость мяча,Скорость головки,Угол,Вращение,head_mass_kg,天気\n"
                             "アイアン七,115,82,16,6400,0.27,晴れ\nウェッジ,90,76,26,8500,0.29,雨\n",
                             "--column Клюшка=club --column 'Скорость мяча=ball_speed_mph' --column 'Скорость "
                             "головки=club_speed_mph' --column Угол=launch_angle_deg --column Вращение=spin_rate_rpm "
                             "--column 天気=ball --column head_mass_kg=head_mass_kg --dictionary '" +
                                 (dir / "d.toml").string() + "'");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  EXPECT_NEAR(shots.find("ball_speed_mph")->native(1), 90, 1e-9);
  EXPECT_NEAR(shots.find("club_speed_mph")->native(1), 76, 1e-9);
  EXPECT_NEAR(shots.find("launch_angle_deg")->native(1), 26, 1e-9);
  EXPECT_NEAR(shots.find("dynamic_loft_deg")->native(1), 38, 1e-9);
  EXPECT_NEAR(shots.find("head_mass_kg")->native(1), 0.29, 1e-9);
  EXPECT_EQ(shots.find("club")->text, (std::vector<std::string>{"アイアン七", "ウェッジ"}));
}

/// Speeds in km/h under mph: what carries them, and the other speed, say which unit fits.
TEST(Import, TheUnitThatFitsIsNamed) {
  const fs::path dir = test::fresh_directory("import_fits");
  const auto refuse = [&](const char* cells, const std::string& why) {
    test::expect_refused(
        import_text(dir, std::string("Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Carry (yd)\n7i,") +
                             cells + "\n7i," + cells + "\n"),
        why);
  };
  // Within the factor of 1.45 that a carry may be off by itself.
  refuse("182.5,134.3,17.4,6800,158",
         "the ball's speed reads like kmh, and --column 'Ball Speed (mph)=ball_speed_kmh' says so "
         "(--column 'Club Speed (mph)=club_speed_kmh' for the club's)");
  refuse("113.4,134.3,17.4,6800,158", "'Club Speed (mph)' reads like kmh (--column 'Club Speed (mph)=club_speed_kmh')");
  refuse("113.4,83.4,17.4,6800,474", "the carry reads like ft");
  ASSERT_EQ(import_text(dir,
                        "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Carry (yd)\n"
                        "7i,113.4,83.4,17.4,6800,128\n7i,113.4,83.4,17.4,6800,130\n")
                .status,
            0)
      << "a range ball in the cold";
}

TEST(Import, WhatNoReadingCanBeIsMissing) {
  const fs::path dir = test::fresh_directory("import_placeholders");
  std::string text = "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Dynamic Loft,Attack Angle\n";
  for (int i = 0; i < 8; ++i)
    text += fmt::format("7i,{},{},16,{},{},{}\n", 115 + i, i == 3 ? 9999 : 82, i == 3 ? 9999 : 6400,
                        i == 3 ? 16777215 : 22, i > 5 ? 4711 : -4);
  const auto o = import_text(dir, text);
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  for (const char* name : {"club_speed_mph", "spin_rate_rpm", "dynamic_loft_deg"})
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(std::isnan(shots.find(name)->value[i]), i == 3) << name << i;
  EXPECT_TRUE(std::isnan(shots.find("attack_angle_deg")->value[7]));
  for (const char* said : {"9999 is no reading: 1", "16777215 is no reading: 1", "4711 is no reading: 2"})
    EXPECT_NE(o.text.find(said), std::string::npos) << said << o.text;
}

/// Rows that are no shots: without a speed, lines of text, and statistics whatever they are called.
TEST(Import, RowsThatAreNoShots) {
  const fs::path dir = test::fresh_directory("import_no_shots");
  const std::string head = "Player,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n";
  std::string shots;
  for (int i = 0; i < 6; ++i)  // means 114.5, 82.75, 16.5, 6450
    shots += fmt::format("Jo,7i,{},{},{},{}\n", 112 + i, 82 + 0.3 * i, 15.5 + 0.4 * ((2 * i) % 6),
                         6200 + 100 * ((3 * i) % 6));
  const auto good = [&](const std::string& rows, const std::string& said) {
    fs::remove_all(dir / "case");
    const auto o = import_text(dir, head + shots + rows);
    ASSERT_EQ(o.status, 0) << rows << o.text;
    EXPECT_EQ(imported_shots(dir).rows(), 6u) << rows << o.text;
    EXPECT_NE(o.text.find(said), std::string::npos) << said << o.text;
  };
  good("Jo,7i,,,,\nJo,7i,0,0,0,0\n", "2 rows without a speed");
  good("\nExported 2024-05-11 by v3.2.1\n", "1 line of text below the header");
  for (const char* name :
       {"Max", "Worst", "Target", "Tour", "Streuung", "Écart type", "Desv. est.", "Snitt", "平均", "標準偏差"})
    good(fmt::format("Jo,{},100,80,15,6000\n", name), "1 summary row");
}

/// A row of means or deviations under no name that is known, or none.
TEST(Import, StatisticsWithoutAWordAreNoShots) {
  const fs::path dir = test::fresh_directory("import_statistics");
  const std::string head = "Player,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Attack Angle\n";
  const std::vector<std::vector<double>> rows = {{112.1, 81.8, 16.9, 6310, -3.2}, {115.4, 83.0, 15.2, 6120, -4.4},
                                                 {109.8, 80.1, 18.3, 6800, -2.1}, {113.3, 82.2, 17.0, 6511, -5.0},
                                                 {114.0, 82.9, 16.1, 6275, -3.9}, {110.7, 81.1, 17.7, 6642, -4.7}};
  std::string shots, mean = "Xyz", deviation = "Uvw";
  for (const auto& r : rows) shots += fmt::format("Jo,{},{},{},{},{}\n", r[0], r[1], r[2], r[3], r[4]);
  for (std::size_t c = 0; c < 5; ++c) {
    double sum = 0, squares = 0;
    for (const auto& r : rows) sum += r[c] / 6;
    for (const auto& r : rows) squares += (r[c] - sum) * (r[c] - sum) / 5;
    mean += fmt::format(",{:.{}f}", sum, c == 3 ? 0 : 1);
    deviation += fmt::format(",{:.{}f}", std::sqrt(squares), c == 3 ? 0 : 1);
  }
  const auto o = import_text(dir, head + shots + mean + "\n" + deviation + "\n", "--club 7i");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_EQ(imported_shots(dir).rows(), 6u) << o.text;
  EXPECT_NE(o.text.find("2 summary rows"), std::string::npos) << o.text;
}

TEST(Import, HandsUnderAnyHeader) {
  const fs::path dir = test::fresh_directory("import_hands");
  const auto azimuth = [&](const std::string& header, const std::string& cell, const std::string& before = "") {
    fs::remove_all(dir / "case");
    const auto o =
        import_text(dir, before + header + (header.empty() ? "" : ",") +
                             "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate\n" + cell +
                             (header.empty() ? "" : ",") + "7i,115,82,16,1.5,6400\n");
    EXPECT_EQ(o.status, 0) << header << o.text;
    return o.status == 0 ? imported_shots(dir).find("azimuth_deg")->native(0) : 0;
  };
  for (const auto& [header, cell] : {std::pair{"Händigkeit", "Links"},
                                     {"Spielhand", "Linkshänder"},
                                     {"Main", "Gaucher"},
                                     {"Mano", "Zurdo"},
                                     {"利き手", "左"},
                                     {"Stance", "Left"},
                                     {"Righty", "No"},
                                     {"Right Handed", "No"},
                                     {"Swinger", "Lefty"}})
    EXPECT_NEAR(azimuth(header, cell), -1.5, 1e-9) << header;
  EXPECT_NEAR(azimuth("", "", "Player: Bo (Left-Handed)\n"), -1.5, 1e-9);
  EXPECT_NEAR(azimuth("Stance", "Open"), 1.5, 1e-9);
  EXPECT_NEAR(azimuth("Miss", "Left"), 1.5, 1e-9) << "the side of something else";
  const auto o = import_text(
      test::fresh_directory("import_hands_both"),
      "Hand,Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\nR,7i,115,82,16,6400\n", "--left-handed");
  EXPECT_NE(o.text.find("column 'Hand' says right-handed in 1 of 1 shots"), std::string::npos) << o.text;
}

TEST(Import, PlacesOnTheFaceInMetres) {
  const fs::path dir = test::fresh_directory("import_metres");
  const auto o = import_text(
      dir,
      R"([{"club":"7i","ballSpeed":51.1,"clubSpeed":36.6,"launchAngle":16,"spinRate":6400,"carry":146,"impactOffset":0.0113},
{"club":"7i","ballSpeed":51.9,"clubSpeed":36.9,"launchAngle":16,"spinRate":6400,"carry":148,"impactOffset":-0.004}])");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NEAR(imported_shots(dir).find("impact_toe_mm")->native(0), 11.3, 1e-9);
  test::expect_refused(import_text(dir / "said",
                                   "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Impact Offset (mm)\n"
                                   "7i,115,82,16,6400,0.011\n7i,115,82,16,6400,-0.004\n7i,115,82,16,6400,0.002\n"),
                       "it reads like m");
}

/// What a column is taken for is told where its header says less than that.
TEST(Import, WhatAHeaderDoesNotSayIsTold) {
  const fs::path dir = test::fresh_directory("import_told");
  std::string text =
      "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate (rpm)*,Loft (deg),Face Impact Horizontal (mm),"
      "Use In Stat\n";
  for (int i = 0; i < 7; ++i)
    text += fmt::format("7i,{},82,16,6400,34.0,{},{}\n", 113 + i, i - 2, i == 5 ? "FALSE" : "TRUE");
  const auto o = import_text(dir, text + "* Spin rate is estimated from launch data\n");
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  EXPECT_EQ(shots.rows(), 6u);
  EXPECT_EQ(shots.find("spin_rate_rpm"), nullptr);
  EXPECT_NEAR(shots.find("dynamic_loft_deg")->native(0), 23.5, 1e-9);
  for (const char* said : {"left out by 'Use In Stat': 1 shot", "1 line of text below the header",
                           "Spin Rate (rpm)* (modelled by the instrument", "the club's own loft, not that at impact",
                           "taken as towards the toe; Foresight has heel +"})
    EXPECT_NE(o.text.find(said), std::string::npos) << said << o.text;
}

/// One name for a club, however it is written; of a file that has only its brand, --club says which.
TEST(Import, ClubsByManyNames) {
  const fs::path dir = test::fresh_directory("import_club_names");
  const auto loft = [&](const std::string& club, const std::string& options = "") {
    fs::remove_all(dir / "case");
    const auto o = import_text(
        dir, "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n" + club + ",115,88,16,6400\n", options);
    EXPECT_EQ(o.status, 0) << club << o.text;
    return o.status == 0 ? imported_shots(dir).find("dynamic_loft_deg")->native(0) : 0;
  };
  for (const char* iron : {"7I - Srixon ZX5", "E7", "7er Eisen", "J7", "7番アイアン", "Ping i525 7 iron"})
    EXPECT_NEAR(loft(iron), 23.5, 1e-9) << iron;
  EXPECT_NEAR(loft("Driver 10.5°"), 13, 1e-9);
  EXPECT_NEAR(loft("4 Hybrid 22°"), 20, 1e-9);
  EXPECT_NEAR(loft("LW 58"), 46, 1e-9);
  EXPECT_NEAR(loft("Irn", "--club 7i"), 23.5, 1e-9);
  EXPECT_NEAR(loft("7I - Srixon ZX5", "--club 7i"), 23.5, 1e-9);
  fs::remove_all(dir / "case");
  test::expect_refused(
      import_text(dir, "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\nP790,115,82,16,6400\n"),
      "'P790' (Club) is not a known club");
  // The name of one file, too.
  test::write(dir / "7iron.csv", "Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate\n115,82,16,6400\n");
  const auto o = command("import '" + (dir / "7iron.csv").string() + "' --out '" + (dir / "case").string() + "'");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("club, from the name of the file: 7iron"), std::string::npos) << o.text;
}

/// A header each in a file that has everything else: what it is taken as.
TEST(Import, HeadersOfManyMakers) {
  const fs::path dir = test::fresh_directory("import_headers");
  for (const auto& [header, column] : {std::pair{"Vert Path (deg)", "attack_angle_deg"},
                                       {"Horiz Path (deg)", "club_path_deg"},
                                       {"V Launch (deg)", "launch_angle_deg"},
                                       {"Launch Angle Vertical", "launch_angle_deg"},
                                       {"Start Direction (deg)", "azimuth_deg"},
                                       {"Ball Direction", "azimuth_deg"},
                                       {"Back Spin Rate (rpm)", "backspin_rpm"},
                                       {"Axis (deg)", "spin_axis_deg"},
                                       {"Spin Axis Tilt (deg)", "spin_axis_deg"},
                                       {"Club Path Angle", "club_path_deg"},
                                       {"Face (deg)", "face_angle_deg"},
                                       {"Face Ang.", "face_angle_deg"},
                                       {"Club Face to Target", "face_angle_deg"},
                                       {"Delivered Loft", "dynamic_loft_deg"},
                                       {"D Loft", "dynamic_loft_deg"},
                                       {"Horiz Impact (mm)", "impact_toe_mm"},
                                       {"Toe/Heel (mm)", "impact_toe_mm"},
                                       {"Aanvalshoek", "attack_angle_deg"},
                                       {"Ángulo de ataque (grados)", "attack_angle_deg"},
                                       {"Angle d’attaque", "attack_angle_deg"},
                                       {"Utgångsriktning", "azimuth_deg"},
                                       {"打出角(度)", "launch_angle_deg"},
                                       {"フェース角(度)", "face_angle_deg"}}) {
    fs::remove_all(dir / "case");
    const double value = std::string(column).ends_with("rpm") ? 5600 : 5.6;
    const auto o = import_text(
        dir, fmt::format("Club,BallSpeedMph,Club Velocity in mph,{0}\n7i,115,82,{1}\n7i,116,82,{1}\n", header, value));
    ASSERT_EQ(o.status, 0) << header << o.text;
    const loop::Shots shots = imported_shots(dir);
    const loop::Column* c = shots.find(column);
    ASSERT_TRUE(c) << header << o.text;
    EXPECT_NEAR(c->native(1), value, 1e-9) << header;
  }
}

/// The sign of a spin is held against where the file says that its shots land.
TEST(Import, ASpinAgainstItsLandingIsTold) {
  const fs::path dir = test::fresh_directory("import_curve");
  for (const int sign : {1, -1}) {
    fs::remove_all(dir / "case");
    std::string text =
        "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Back Spin,Side Spin,Carry (yd),Carry "
        "Side (yd)\n";
    for (int i = 0; i < 10; ++i)  // 300 rpm curve by some 6 yd
      text += fmt::format("7i,115,82,16,{},6400,{},160,{:.1f}\n", i % 3 - 1, sign * 100 * (i - 4),
                          160 * std::sin(radians(i % 3 - 1)) + 2 * (i - 4));
    const auto o = import_text(dir, text);
    ASSERT_EQ(o.status, 0) << o.text;
    EXPECT_EQ(o.text.find("--column 'Side Spin=-sidespin_rpm' turns it") != std::string::npos, sign < 0) << o.text;
  }
}

}  // namespace
/// Back and side follow from rate and axis where each row that has the ones has the others too.
TEST(Import, ComponentsThatNothingElseSaysAreKept) {
  const fs::path dir = test::fresh_directory("import_components");
  const std::string head =
      "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Spin Axis,Backspin,Sidespin,Dynamic Loft\n"
      "7i,115,82,16,6400,0,6400,0,22\n7i,117,83,17,6500,2,6496,227,23\n";
  const auto kept = [&](const std::string& row) {
    fs::remove_all(dir / "case");
    EXPECT_EQ(import_text(dir, head + row).status, 0);
    const loop::Shots shots = imported_shots(dir);
    return shots.find("backspin_rpm") && shots.find("sidespin_rpm");
  };
  EXPECT_FALSE(kept("7i,116,82,16,6450,-1,6449,-113,22\n"));
  EXPECT_TRUE(kept("7i,116,82,16,,,6449,-113,22\n"));
}

/// Where a file has the backspin alone, the clubs' column says so.
TEST(Import, TheClubsSpinIsNamedAsTheFileHasIt) {
  const fs::path dir = test::fresh_directory("import_backspin");
  ASSERT_EQ(import_text(dir,
                        "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Backspin,Dynamic Loft\n"
                        "7i,115,82,16,1,6400,22\n7i,117,83,17,-1,6500,23\n7i,116,82,16,0,6450,22\n")
                .status,
            0);
  const auto o = command("run '" + (dir / "case").string() + "' --out '" + (dir / "out").string() + "'");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("backspin [rpm]  "), std::string::npos) << o.text;
}

constexpr const char* kShots =
    "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Launch Direction,Spin Rate,Dynamic Loft\n"
    "7i,115,82,16,1.5,6400,22\n7i,117,83,17,-1,6500,23\n7i,116,82,16,0,6450,22\n";

/// A text of UTF-16 is one with and without a mark; zeros elsewhere are no text.
TEST(Import, Utf16WithoutAMark) {
  const fs::path dir = test::fresh_directory("import_utf16");
  for (const bool little : {true, false})
    for (const bool mark : {true, false}) {
      fs::remove_all(dir / "case");
      std::string bytes = !mark ? "" : little ? "\xFF\xFE" : "\xFE\xFF";
      for (const char c : std::string(kShots)) (bytes += little ? c : '\0') += little ? '\0' : c;
      const auto o = import_text(dir, bytes);
      ASSERT_EQ(o.status, 0) << little << mark << o.text;
      EXPECT_EQ(imported_shots(dir).find("spin_rate_rpm")->native(1), 6500) << o.text;
    }
  fs::remove_all(dir / "case");
  test::expect_refused(import_text(dir, std::string("7i\0,1\0\0\0,82\0\0", 12)), "not a text file");
  test::expect_refused(import_text(dir, std::string("\1\0\0\0\2\0\0\0\3\0\0\0", 12)), "not a text file");
}

/// A workbook is named as one, and how its shots become a file that is read.
TEST(Import, AWorkbookIsRefusedWithTheWayToACsv) {
  const fs::path dir = test::fresh_directory("import_workbook");
  for (const char* begins : {"PK\x03\x04", "\xD0\xCF\x11\xE0"}) {
    const auto o = import_text(dir, begins + std::string("\0\0\x08\0", 4));
    test::expect_refused(o, "save that as CSV");
    EXPECT_NE(o.text.find("workbook"), std::string::npos) << o.text;
  }
  test::expect_refused(import_text(dir, std::string("%PDF-1.4\n")), "a PDF: export the session as CSV");
}

TEST(Import, AHeadOfManyLinesIsPassedOver) {
  const fs::path dir = test::fresh_directory("import_long_head");
  std::string head;
  for (int i = 0; i < 400; ++i) head += i % 2 ? fmt::format("Note {},of,a line\n", i) : fmt::format("note {}\n", i);
  const auto o = import_text(dir, "Player,Jo,Date,12.05.2024\n" + head + kShots);
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_EQ(imported_shots(dir).rows(), 3u) << o.text;
  EXPECT_NE(o.text.find("401 lines before the header"), std::string::npos) << o.text;
}

/// What a line above the header, or a document above its shots, says of the hand: a value that names none is refused.
TEST(Import, AHandAboveTheHeaderIsUnderstoodOrRefused) {
  const fs::path dir = test::fresh_directory("import_hand_above");
  const auto azimuth = [&](const std::string& text, const std::string& options = "") {
    fs::remove_all(dir / "case");
    const auto o = import_text(dir, text, options);
    EXPECT_EQ(o.status, 0) << text << o.text;
    return o.status == 0 ? imported_shots(dir).find("azimuth_deg")->native(0) : 0;
  };
  for (const char* left : {"Left handed;1", "Left-handed: yes", "Right handed,no", "Righty: 0", "Lefty;true"})
    EXPECT_NEAR(azimuth(left + std::string("\n") + kShots), -1.5, 1e-9) << left;
  for (const char* right : {"Left handed;0", "Right handed: 1", "Lefty,no", "Handedness;-", "Player,Hand,Score"})
    EXPECT_NEAR(azimuth(right + std::string("\n") + kShots), 1.5, 1e-9) << right;
  for (const char* unclear : {"Handedness;1", "Handedness,1", "Player: Jo, Hand: X"}) {
    fs::remove_all(dir / "case");
    test::expect_refused(import_text(dir, unclear + std::string("\n") + kShots), "neither left nor right");
    EXPECT_NEAR(azimuth(unclear + std::string("\n") + kShots, "--left-handed"), -1.5, 1e-9) << unclear;
  }
  const std::string shots =
      R"("shots":[{"club":"7i","ballSpeed":115,"clubSpeed":82,"launchAngle":16,"launchDirection":1.5,"spinRate":6400},)"
      R"({"club":"7i","ballSpeed":116,"clubSpeed":82,"launchAngle":16,"launchDirection":1.5,"spinRate":6400}]})";
  EXPECT_NEAR(azimuth(R"({"player":"Jo","leftHanded":true,)" + shots, "--units imperial"), -1.5, 1e-9);
  EXPECT_NEAR(azimuth(R"({"player":"Jo","leftHanded":1,)" + shots, "--units imperial"), -1.5, 1e-9);
  fs::remove_all(dir / "case");
  test::expect_refused(import_text(dir, R"({"player":"Jo","handedness":1,)" + shots, "--units imperial"),
                       "column 'handedness', shot 1: '1' is neither left nor right");
}

/// `Direction` alone may be the ball's or the club's.
TEST(Import, ADirectionIsTheBallsBesideTheClubsPath) {
  const fs::path dir = test::fresh_directory("import_direction");
  const auto o_of = [&](const std::string& more, const std::string& cells, const std::string& options = "") {
    fs::remove_all(dir / "case");
    return import_text(dir,
                       "Club,Ball Speed (mph),Club Speed (mph),Launch Angle,Spin Rate,Direction" + more +
                           "\n7i,115,82,16,6400,2.5 L" + cells + "\n7i,116,82,17,6500,1.0 R" + cells + "\n",
                       options);
  };
  const auto taken = o_of(" (deg),Club Path", ",3");
  ASSERT_EQ(taken.status, 0) << taken.text;
  EXPECT_NEAR(imported_shots(dir).find("azimuth_deg")->native(0), -2.5, 1e-9) << taken.text;
  EXPECT_NE(taken.text.find("the ball's, since the club's path has a column of its own"), std::string::npos);
  const auto asked = o_of("", "");
  ASSERT_EQ(asked.status, 0) << asked.text;
  EXPECT_EQ(imported_shots(dir).find("azimuth_deg"), nullptr);
  EXPECT_NE(asked.text.find("Direction (of the ball or of the club? --column 'Direction=azimuth_deg'"),
            std::string::npos)
      << asked.text;
  const auto second = o_of(",Club Path,Launch Direction", ",3,1.25");
  ASSERT_EQ(second.status, 0) << second.text;
  EXPECT_EQ(second.text.find("of the ball or of the club?"), std::string::npos) << second.text;
  EXPECT_NEAR(imported_shots(dir).find("azimuth_deg")->native(0), 1.25, 1e-9);
  ASSERT_EQ(o_of("", "", "--column Direction=club_path_deg").status, 0);
  EXPECT_NEAR(imported_shots(dir).find("club_path_deg")->native(1), 1, 1e-9);
}

/// A cell that no instrument can have measured is left out, and told with its shot, its value and what is allowed.
TEST(Import, AnImpossibleCellIsLeftOut) {
  const fs::path dir = test::fresh_directory("import_impossible");
  const auto o = import_text(
      dir, kShots + std::string("7i,115,82,16,1.5,-2.1e10,22\n7i,115,82,-123,1.5,-6400,22\n7i,415,82,16,75,300,22\n"));
  ASSERT_EQ(o.status, 0) << o.text;
  const loop::Shots shots = imported_shots(dir);
  ASSERT_EQ(shots.rows(), 6u);
  const auto is_left_out = [&](const char* column, std::size_t row) {
    return std::isnan(shots.find(column)->native(row));
  };
  EXPECT_TRUE(is_left_out("spin_rate_rpm", 3) && is_left_out("spin_rate_rpm", 4));
  EXPECT_TRUE(is_left_out("launch_angle_deg", 4) && is_left_out("ball_speed_mph", 5));
  EXPECT_EQ(shots.find("spin_rate_rpm")->native(5), 300) << "a topped ball";
  EXPECT_NEAR(shots.find("azimuth_deg")->native(5), 75, 1e-9) << "a shank";
  for (const char* said :
       {"left out: '-2.1e10' in shot 4, '-6400' in shot 5 (allowed: 0 to 30000 rpm)",
        "left out: '-123' in shot 5 (allowed: -90 to 90 deg)", "left out: '415' in shot 6 (allowed: 0 to 300 mph)"})
    EXPECT_NE(o.text.find(said), std::string::npos) << said << o.text;
}

}  // namespace hosel
