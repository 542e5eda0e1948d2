// [face.plate]: faults of a case and of its CSV are refused with file and line; kinds that take a plate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "csv_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

const std::string kCase = R"(kind = "plate-face"
accuracy = "look"
[head]
name = "driver-200"
[delivery]
club_speed_mps = 50
[ball]
model = "tour"
[face.plate]
)";

void refused(const std::string& toml, const std::string& csv, const std::string& says) {
  const fs::path dir = fresh_directory("plate_case");
  write(dir / "case.toml", kCase + toml);
  write(dir / "data.csv", csv);
  const Outcome o = command("check " + dir.string());
  expect_refused(o, says);
}

const std::string kGrid = "thickness = {map = 'grid', file = 'data.csv'}\n";
const std::string kCorners = "toe_mm,high_mm,thickness_mm\n-45,-25,2.8\n45,-25,2.8\n-45,25,2.6\n";

TEST(PlateCase, ThicknessGridsAreRefusedWithTheirLine) {
  refused(kGrid, kCorners, "data.csv:1: no row has toe 45 mm, high 25 mm");
  refused(kGrid, kCorners + "45,25,0\n", "data.csv:5: a thickness of 0 mm is out of range");
  refused(kGrid, kCorners + "45,25,thin\n", "data.csv:5: thickness_mm 'thin' is no number");
  refused(kGrid, kCorners + "45,25,2.8\n-45,25,2.8\n", "data.csv:6: this place stands in line 4 already");
  refused(kGrid, "toe_mm,high_mm\n0,0\n", "data.csv:1: no column 'thickness'");
  refused(kGrid, "toe_mm,high_mm,thickness_mm\n-20,-25,2.8\n45,-25,2.8\n-20,25,2.6\n45,25,3\n",
          "data.csv: the thickness grid does not cover the face");
  refused(kGrid, kCorners + "450,25,2.8\n", "data.csv:5: 450 mm is no place on a face");
}

TEST(PlateCase, OutlinesAreRefusedWithTheirLine) {
  const std::string outline = "outline = {form = 'polygon', file = 'data.csv'}\nthickness = {value_mm = 2.8}\n";
  refused(outline, "toe_mm,high_mm\n0,0\n", "data.csv: an outline needs three corners");
  refused(outline, "toe_mm,high_mm\n40,-20\n40,20\n-40,20\n-10,25\n-40,-20\n", "data.csv:4: the outline turns back");
  refused(outline, "toe_mm,high_mm\n40,10\n40,20\n30,20\n", "the outline");
}

TEST(PlateCase, KeysAreRefusedByName) {
  refused("thickness = {value_mm = 2.8}\nmaterial = 'wood'\n", "", "face.plate.material");
  refused("thickness = {value_mm = 2.8, centre_mm = 3}\n", "", "face.plate.thickness.centre_mm");
  refused("thickness = {map = 'rings', share = [0.5, 0.2], value_mm = [2, 3]}\n", "",
          "face.plate.thickness.share: the stations of rings must ascend");
  refused("thickness = {value_mm = 2.8}\n[places]\nhigh_mm = []\n", "", "places.high_mm: name at least one place");
  refused("thickness = {value_mm = 40}\n", "",  // pi 45 mm 25 mm 40 mm 4430 kg/m3 = 626.3 g
          "face.plate.thickness: the face weighs 626 g and is part of a head of 200 g");
  refused("thickness = {value_mm = 2.8}\n[face]\nname = 'modern-driver'\n", "",
          "face.name: either a face of the library");
  refused("thickness = {value_mm = 2.8}\nmaterial = 'own'\n", "", "young");
}

TEST(PlateCase, ReducedModelsRefuseAPlate) {
  const fs::path dir = fresh_directory("plate_reduced");
  write(dir / "case.toml",
        kEccentricBlow + "[volumetric]\npublished = 'driver'\n[face.plate]\nthickness = {value_mm = 2.8}\n");
  const Outcome o = command("check " + dir.string() + " --set 'models=[\"volumetric\"]'");
  expect_refused(o, "lumped face");
}

const std::string kFace = R"(kind = "plate-face"
accuracy = "look"
vtk = false
[head]
name = "driver-200"
[face.plate]
yield_MPa = 828
[face.plate.thickness]
value_mm = 2.8
[delivery]
club_speed_mps = 50
[ball]
model = "tour"
[places]
toe_mm = [0]
high_mm = [0]
[grid]
width_mm = 40
height_mm = 20
columns = 3
rows = 3
)";

/// What is judged or mirrored does not hang on the meshes of plate and ball.
const std::string kCoarse =
    " --set figures=false --set face.plate.mesh.core=3 --set mesh.sector=1 --set mesh.rings=1 --set mesh.harmonics=1 "
    "--set time.steps_per_contact=20";

TEST(PlateCase, TheFaceIsJudgedByTheRulesAndByItsYieldStrength) {
  const fs::path dir = fresh_directory("plate_judged");
  write(dir / "case.toml", kFace);
  const auto run = [&](const std::string& options) {
    const Outcome o =
        command("run '" + dir.string() + "' --force --out '" + (dir / "out").string() + "' " + options + kCoarse);
    EXPECT_EQ(o.status, 0) << o.text;
    return std::pair(o.text, nlohmann::json::parse(content(dir / "out" / "summary.json")));
  };
  const auto [thin, told] = run("--set face.plate.thickness.value_mm=2.4");
  ASSERT_GT(told["largest_characteristic_time_us"].get<double>(), 257) << thin;
  ASSERT_GT(told["peak_stress_MPa"].get<double>(), 828) << thin;
  EXPECT_GT(told["characteristic_time_error_us"].get<double>(), 0);
  EXPECT_NE(thin.find("this face fails the rules' test"), std::string::npos) << thin;
  EXPECT_NE(thin.find("exceeds the yield strength of 828 MPa"), std::string::npos) << thin;
  const std::string page = content(dir / "out/report.html");
  EXPECT_NE(page.find("How well it was solved"), std::string::npos);
  EXPECT_NE(page.find("<td>more modes<td>"), std::string::npos);
  char closure[16];
  std::snprintf(closure, sizeof closure, "%.1e", told["energy_closure"].get<double>());
  EXPECT_NE(page.find(std::string("Energy unaccounted for: at most ") + closure), std::string::npos);
  const auto [thick, other] = run("--set face.plate.thickness.value_mm=4 --set face.plate.yield_MPa=5000");
  ASSERT_LT(other["largest_characteristic_time_us"].get<double>(), 250) << thick;
  EXPECT_NE(thick.find("this face passes the rules' test"), std::string::npos) << thick;
  EXPECT_EQ(thick.find("yield strength"), std::string::npos) << thick;
}

/// A soft contact lets the ball into the face: said as of any other face.
TEST(PlateCase, APenetrationIsDoubted) {
  const fs::path dir = fresh_directory("plate_soft_contact");
  write(dir / "case.toml",
        kCase + "thickness = {value_mm = 2.8}\n[places]\ntoe_mm = [0]\nhigh_mm = [0]\n[contact]\npenalty = 5\n");
  const Outcome o = command("run " + dir.string() +
                            " --quiet --set numerical_error=false --set figures=false --set vtk=false --out " +
                            (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("1 of 1 blow; the worst, at toe 0, high 0 mm: the penetration, of the compression, is"),
            std::string::npos)
      << o.text;
}

TEST(PlateCase, ABallBesideTheFaceIsDoubted) {
  const fs::path dir = fresh_directory("plate_beside");
  write(dir / "case.toml", kFace);
  const auto run = [&](const std::string& toe) {
    return command("run '" + dir.string() + "' --force --out '" + (dir / "out").string() +
                   "' --set places.toe_mm=" + toe + " --set places.high_mm=[0] --set numerical_error=false" + kCoarse);
  };
  const Outcome beside = run("[0,60]");
  EXPECT_NE(beside.text.find("warning: the ball is struck off the face, which reaches "), std::string::npos)
      << beside.text;
  EXPECT_NE(beside.text.find("at 1 of 2 places. The farthest: 60 mm towards the toe and 0 mm up"), std::string::npos)
      << beside.text;
  const Outcome on = run("[0]");
  EXPECT_EQ(on.text.find("off the face"), std::string::npos) << on.text;
  EXPECT_NE(on.text.find("ball speed over 1 place: "), std::string::npos) << on.text;
}

/// The first touch throws a light face away from the ball, and both are apart while the head follows. The blow is not
/// over: the ball leaves faster than the head.
TEST(PlateCase, ABallThatTheFaceFleesFromIsStruckAllTheSame) {
  const fs::path dir = fresh_directory("plate_flees");
  write(dir / "case.toml", kFace);
  const Outcome o = command("run '" + dir.string() + "' --out '" + (dir / "out").string() +
                            "' --set face.plate.thickness.value_mm=0.3 --set numerical_error=false --set figures=false "
                            "--set delivery.club_speed_mps=40 --set mesh.sector=1 --set mesh.rings=1 "
                            "--set mesh.harmonics=1 --set time.steps_per_contact=20");
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_GT(nlohmann::json::parse(content(dir / "out" / "summary.json"))["ball_speed_mps"][0].get<double>(), 40);
}

/// A sphere of 6 mm bounces on the vibrating face along its middle: no characteristic time there, and all else is told.
TEST(PlateCase, AFaceWithoutACharacteristicTimeIsTold) {
  const fs::path dir = fresh_directory("plate_bounces");
  write(dir / "case.toml", kFace);
  const Outcome o = command("run '" + dir.string() + "' --out '" + (dir / "out").string() +
                            "' --set face.plate.thickness.value_mm=2.4 --set sphere.radius_mm=6" + kCoarse);
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("centre: no characteristic time"), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("has no verdict"), std::string::npos) << o.text;
  const auto told = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  EXPECT_EQ(told["places_without_characteristic_time"], 3);
  EXPECT_FALSE(told.contains("characteristic_time_us"));
  EXPECT_GT(told["restitution"].get<double>(), 0.7);
  const CsvFile map(dir / "out" / "map.csv");
  ASSERT_EQ(map.rows(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(map.text("characteristic_time_us", i).empty(), map.number("high_mm", i) == 0);
    EXPECT_GT(map.number("restitution", i), 0.7);
  }
}

/// The face's centre is a place like any other: what is told of it is told where it was struck, whatever the order.
TEST(PlateCase, TheCentreIsTheFacesOwn) {
  const fs::path dir = fresh_directory("plate_centre");
  write(dir / "case.toml", kFace);
  const auto run = [&](const std::string& toes) {
    const Outcome o = command("run '" + dir.string() + "' --force --set places.toe_mm=" + toes + " --out '" +
                              (dir / "out").string() + "'" + kCoarse);
    EXPECT_EQ(o.status, 0) << o.text;
    return std::pair(o.text, nlohmann::json::parse(content(dir / "out" / "summary.json")));
  };
  const auto [text, told] = run("[0,18]");
  ASSERT_EQ(told["ball_speed_mps"].size(), 2u) << text;
  const double middle = told["ball_speed_mps"][0], toe = told["ball_speed_mps"][1];
  ASSERT_GT(middle, toe + 0.5) << text;
  ASSERT_TRUE(told.contains("centre")) << text;
  EXPECT_EQ(told["centre"]["ball_speed_mps"].get<double>(), middle);
  EXPECT_NEAR(told["centre"]["azimuth_deg"].get<double>(), 0, 1e-6);
  EXPECT_NE(text.find("more modes at toe 0, high 0 mm"), std::string::npos) << text;
  const auto [aside, other] = run("[18,12]");
  ASSERT_EQ(other["ball_speed_mps"][0].get<double>(), toe) << "the same blow";
  EXPECT_FALSE(other.contains("centre")) << aside;
  EXPECT_NE(aside.find("more modes at toe 18, high 0 mm"), std::string::npos) << aside;
}

TEST(PlateCase, AGridBesideTheFaceIsRefused) {
  const fs::path dir = fresh_directory("plate_beside");
  write(dir / "case.toml", kFace);
  const std::string check = "check '" + dir.string() +
                            "' --set grid.width_mm=200 --set grid.height_mm=200 --set grid.columns=4 --set grid.rows=";
  ASSERT_EQ(command(check + "5").status, 0) << "its middle row lies on the face";
  const Outcome o = command(check + "4");
  expect_refused(o, "case.toml:17: grid: none of the 4 x 4 places over 200 x 200 mm lies on the face (allowed:");
}

/// A head whose centre of gravity is 1e-9 mm aside is no mirror image: each of its places is computed. It answers as
/// the one on the centre line does, of which the blows and taps on the heel's side alone are.
TEST(PlateCase, WhatIsTheMirrorImageIsComputedOnce) {
  const fs::path dir = fresh_directory("plate_twins");
  write(dir / "case.toml", kFace);
  const std::string places = " --set places.toe_mm=[-18,0,18] --set places.high_mm=[6] --set numerical_error=false";
  const auto run = [&](const std::string& to, const std::string& options) {
    const Outcome o =
        command("run '" + dir.string() + "' --out '" + (dir / to).string() + "'" + kCoarse + places + options);
    EXPECT_EQ(o.status, 0) << o.text;
    const std::string store = content(dir / to / "shards" / "1-of-1" / "points.jsonl");
    return std::ranges::count(store, '\n') - 1;  // its first line is a header
  };
  ASSERT_EQ(run("alike", ""), 2);
  ASSERT_EQ(run("each", " --set head.cg_mm=[-35,1e-9,0]"), 3);
  EXPECT_EQ(run("open", " --set delivery.face_angle_deg=1"), 3);  // alike, but not how it is delivered
  for (const char* name : {"ball_speed_mps", "launch_angle_deg", "azimuth_deg", "backspin_rpm", "sidespin_rpm",
                           "peak_stress_MPa", "stress_toe_mm", "stress_high_mm"}) {
    const auto once = CsvFile(dir / "alike" / "blows.csv").numbers(name),
               each = CsvFile(dir / "each" / "blows.csv").numbers(name);
    ASSERT_EQ(once.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(once[i], each[i], 2e-3) << name << " " << i;
  }
  ASSERT_GT(std::abs(CsvFile(dir / "alike" / "blows.csv").number("azimuth_deg", 0)), 0.1);
  for (const char* name : {"characteristic_time_us", "restitution", "ball_speed_ratio", "thickness_mm"}) {
    const auto once = CsvFile(dir / "alike" / "map.csv").numbers(name),
               each = CsvFile(dir / "each" / "map.csv").numbers(name);
    ASSERT_EQ(once.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(once[i], each[i], 2e-3) << name << " " << i;
  }
  EXPECT_FALSE(fs::exists(dir / "alike" / "map.png"));
  const auto told = nlohmann::json::parse(content(dir / "open" / "summary.json"));
  const auto& speeds = told["ball_speed_mps"];
  EXPECT_NEAR(told["mean_ball_speed_mps"], (double(speeds[0]) + double(speeds[1]) + double(speeds[2])) / 3, 1e-9);
  EXPECT_EQ(told["least_ball_speed_mps"], std::min({double(speeds[0]), double(speeds[1]), double(speeds[2])}));
}

/// A study says of a blow the stress that the face's own case says of it.
TEST(PlateCase, StudiesTellThePeakStress) {
  const fs::path dir = fresh_directory("plate_stress");
  write(dir / "face" / "case.toml", kFace);
  const Outcome one = command("run '" + (dir / "face").string() + "' --out '" + (dir / "one").string() +
                              "' --set figures=false --set numerical_error=false");
  ASSERT_EQ(one.status, 0) << one.text;
  write(dir / "case.toml",
        "kind = 'study'\naccuracy = 'look'\nmodels = ['fe-free-body']\noutputs = ['peak_stress_MPa', "
        "'ball_speed_mps']\n[[axis]]\nkey = 'face.plate.thickness.value_mm'\nvalues = [2.8, 3.4]\n"
        "[delivery]\nclub_speed_mps = 50\n[ball]\nmodel = 'tour'\n[head]\nname = 'driver-200'\n"
        "[face.plate]\nthickness = {value_mm = 2.8}\n");
  const std::string run = "run '" + dir.string() + "' --out '" + (dir / "out").string() + "' ";
  const Outcome study = command(run);
  ASSERT_EQ(study.status, 0) << study.text;
  const auto stress = CsvFile(dir / "out" / "points.csv").numbers("peak_stress_MPa");
  const auto told = nlohmann::json::parse(content(dir / "one" / "summary.json"));
  ASSERT_EQ(stress.size(), 2u);
  EXPECT_NEAR(stress[0], told["peak_stress_MPa"].get<double>(), 1e-9 * stress[0]);
  EXPECT_LT(stress[1], 0.9 * stress[0]);
  const Outcome sought = command(run + "--set matched_launch=true --force");
  expect_refused(sought, "peak_stress");
}

/// A thicker plate is tapped for a shorter time, and gives less back.
TEST(PlateCase, StudiesTellWhatThePendulumTellsOfAPlate) {
  const fs::path dir = fresh_directory("plate_tap");
  write(dir / "tap" / "case.toml", kFace);
  const Outcome tap = command("run " + (dir / "tap").string() +
                              " --set figures=false --set numerical_error=false --out " + (dir / "out").string());
  ASSERT_EQ(tap.status, 0) << tap.text;
  write(dir / "face" / "case.toml",
        "kind = 'study'\naccuracy = 'look'\nmodels = ['fe-free-body']\noutputs = ['face_restitution', "
        "'rigid_restitution', 'characteristic_time_us', 'give_to_ball_m_per_N', 'give_to_pendulum_m_per_N']\n"
        "[[axis]]\nkey = 'delivery.impact_toe_mm'\nvalues = [0, 20]\n"
        "[delivery]\nclub_speed_mps = 48.77\n[ball]\nmodel = 'tour'\n[head]\nname = 'driver-200'\n"
        "[face.plate]\nthickness = {value_mm = 2.8}\n");
  const Outcome face = command("run " + (dir / "face").string() + " --out " + (dir / "map").string());
  ASSERT_EQ(face.status, 0) << face.text;
  const CsvFile points(dir / "map" / "points.csv");
  const auto column = [&](const char* name) { return points.number(name, 0); };
  EXPECT_GT(column("face_restitution"), column("rigid_restitution") + 0.02);
  const auto tapped = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  EXPECT_NEAR(column("characteristic_time_us"), tapped["characteristic_time_us"].get<double>(), 1e-6);
  EXPECT_GT(column("give_to_pendulum_m_per_N"), column("give_to_ball_m_per_N")) << "the smaller patch sinks deeper";
}

}  // namespace
