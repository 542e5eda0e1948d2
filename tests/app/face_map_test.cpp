// Studies over the face: every point is the model's own answer at its place on the face, in any order and division.
#include <gtest/gtest.h>

#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "csv_file.hpp"
#include "golf/units.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "post/labels.hpp"
#include "tests/support/one_core.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

const std::string kMap = R"(kind = "study"
models = ["rigid-eccentric"]
outputs = ["ball_speed_mps", "sidespin_rpm"]
[grid]
[compare]
with = "variant"
variant = "own"
[delivery]
club_speed_mps = 45.0
dynamic_loft_deg = 10.0
attack_angle_deg = 2.0
[head]
mass_kg = 0.2
cg_mm = [-35.0, 0.0, 4.0]
inertia_kg_m2 = [[2.0e-4, 0, 0], [0, 3.0e-4, 0], [0, 0, 4.5e-4]]
bulge_mm = 400.0
roll_mm = 350.0
[[variant]]
name = "own"
[[variant]]
name = "heavier"
set = ["head.mass_kg=0.2025"]
[equivalent_mass]
extra_g = 5.0
[[statement]]
text = "the ball is faster everywhere"
holds = "ball_speed_gain_min_mps > 0 && difference.ball_speed_mps > 0"
)";
const std::string kOwn = "own", kHeavier = "heavier";

class FaceMapRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = fresh_directory("face_map");
    write(dir_ / "case" / "case.toml", "figures = false\n" + kMap);
    outcome_ = command("run " + (dir_ / "case").string() + " --out " + (dir_ / "out").string());
  }
  void SetUp() override { ASSERT_EQ(outcome_.status, 0) << outcome_.text; }
  static nlohmann::json summary() { return nlohmann::json::parse(content(dir_ / "out" / "summary.json")); }
  static inline fs::path dir_;
  static inline Outcome outcome_;
};

TEST_F(FaceMapRun, EveryPointIsTheModelsOwnAnswer) {
  const CsvFile rows(dir_ / "out" / "face_map.csv");
  ASSERT_EQ(rows.rows(), 2u * 135u);
  hosel::Blow blow;
  blow.club.head = {.mass = 0.2,
                    .cg = {-0.035, 0, 0.004},
                    .inertia = hosel::Vec3(2e-4, 3e-4, 4.5e-4).asDiagonal(),
                    .face = {0.4, 0.35}};
  blow.delivery.club_speed = 45;
  blow.delivery.dynamic_loft = hosel::radians(10);
  blow.delivery.attack_angle = hosel::radians(2);
  double most_toe = 0, most_high = 0;
  for (std::size_t r = 0; r < 135; ++r) {
    blow.delivery.impact_toe = 1e-3 * rows.number("impact_toe_mm", r);
    blow.delivery.impact_high = 1e-3 * rows.number("impact_high_mm", r);
    most_toe = std::max(most_toe, blow.delivery.impact_toe);
    most_high = std::max(most_high, blow.delivery.impact_high);
    const hosel::Launch l = hosel::models::RigidEccentric().launch(blow);
    // The table has nine digits, the offsets in it six.
    EXPECT_NEAR(rows.number("ball_speed_mps", r), l.ball_speed(), 1e-6 * l.ball_speed());
    EXPECT_NEAR(rows.number("azimuth_deg", r), hosel::degrees(l.azimuth()), 1e-5);
    EXPECT_NEAR(rows.number("sidespin_rpm", r), hosel::rpm(l.sidespin()), 1e-2);
    EXPECT_NEAR(rows.number("head_rotation_rad_per_s", r), l.head_spin.norm(), 1e-3);
  }
  EXPECT_DOUBLE_EQ(most_toe, 0.0375);
  EXPECT_DOUBLE_EQ(most_high, 0.01875);
}

TEST_F(FaceMapRun, HeavierHeadIsItsOwnEquivalentMass) {
  const auto figures = summary().at("effect").at(kHeavier).at("figures");
  for (const char* name : {"centre", "mean", "min", "max"})
    EXPECT_NEAR(figures.at(std::string("equivalent_head_mass_") + name + "_g").get<double>(), 2.5, 1e-3) << name;
  EXPECT_GT(figures.at("ball_speed_gain_min_mps").get<double>(), 0);
  EXPECT_EQ(figures.at("ball_speed_gain_positive_share").get<double>(), 1);
  for (const char* label : {"  ball speed gain centre [m/s]  ", "  ball speed gain slope towards heel [m/s/mm]  ",
                            "  largest gain toe [mm]  ", "  equivalent head mass mean [g]  "})
    EXPECT_NE(outcome_.text.find(label), std::string::npos) << label << outcome_.text;
  EXPECT_EQ(outcome_.text.find("_mps"), std::string::npos) << outcome_.text;
  // A formula may hold figures of the map and quantities of its places.
  const auto judged = summary().at("statements");
  ASSERT_EQ(judged.size(), 1u);
  EXPECT_EQ(judged[0].at("model"), kHeavier);
  EXPECT_EQ(judged[0].at("verdict"), "holds");
  EXPECT_EQ(judged[0].at("points"), 135);
}

TEST_F(FaceMapRun, SymmetricHeadGivesASymmetricMap) {
  const CsvFile rows(dir_ / "out" / "face_map.csv");
  EXPECT_GT(std::abs(rows.number("sidespin_rpm", 0)), 100);  // the corners do curve the ball
  EXPECT_LT(summary().at("mirror_error").at(kOwn).get<double>(), 1e-12);
}

TEST_F(FaceMapRun, ASkewedHeadBreaksTheSymmetry) {
  const auto out = (dir_ / "skewed").string();
  ASSERT_EQ(command("run " + (dir_ / "case").string() + " --quiet --set 'head.cg_mm=[-35,1,4]' --out " + out).status,
            0);
  const auto s = nlohmann::json::parse(content(fs::path(out) / "summary.json"));
  EXPECT_GT(s.at("mirror_error").at(kOwn).get<double>(), 1e-3);
}

TEST_F(FaceMapRun, FaceSurfaceCarriesEveryChannelWithItsUnit) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((dir_ / "out" / "vtk" / "face" / "face_0000.vtp").c_str());
  reader->Update();
  vtkPolyData* face = reader->GetOutput();
  ASSERT_EQ(face->GetNumberOfPoints(), 135);
  ASSERT_EQ(face->GetNumberOfCells(), 14 * 8);
  const double* heel_low = face->GetPoint(0);  // Yc is positive to the heel
  EXPECT_NEAR(heel_low[1], 0.0375, 1e-12);
  EXPECT_NEAR(heel_low[2], -0.01875, 1e-12);
  EXPECT_NEAR(heel_low[0], -(0.0375 * 0.0375 / 0.8 + 0.01875 * 0.01875 / 0.7), 1e-12);
  const CsvFile rows(dir_ / "out" / "face_map.csv"), differences(dir_ / "out" / "face_differences.csv");
  const std::map<std::string, std::string> units = {
      {"ball_speed", "mps"}, {"launch_angle", "deg"}, {"sidespin", "rpm"}, {"head_rotation", "rad_per_s"}};
  for (const auto& [name, unit] : units) {
    vtkDataArray* a = face->GetPointData()->GetArray((kOwn + "." + name).c_str());
    vtkDataArray* d = face->GetPointData()->GetArray((kHeavier + "-minus-" + kOwn + "." + name).c_str());
    ASSERT_TRUE(a && d) << name;
    EXPECT_STREQ(a->GetInformation()->Get(vtkDataArray::UNITS_LABEL()), hosel::post::symbol(unit).c_str());
    for (const std::size_t p : {0u, 67u, 134u}) {
      const double value = rows.number(name + "_" + unit, p), difference = differences.number(name + "_" + unit, p);
      EXPECT_NEAR(a->GetTuple1(vtkIdType(p)), value, 1e-8 * std::abs(value) + 1e-9) << name;
      EXPECT_NEAR(d->GetTuple1(vtkIdType(p)), difference, 1e-8 * std::abs(difference) + 1e-9) << name;
    }
  }
}

TEST(FaceMap, PicturesAreDrawn) {
  const fs::path dir = fresh_directory("face_map_pictures");
  write(dir / "case.toml", kMap);
  const Outcome o =
      command("run " + dir.string() + " --set grid.columns=5 --set grid.rows=3 --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  for (const char* name : {"map-own", "map-heavier", "difference-heavier", "equivalent-mass-heavier"}) {
    const fs::path stem = dir / "out" / "figures" / name;
    EXPECT_TRUE(fs::exists(stem.string() + ".png")) << name;
    const std::string script = content(stem.string() + ".gp");
    EXPECT_NE(script.find("heel left, toe right"), std::string::npos);
    EXPECT_NE(script.find("impact toe [mm]"), std::string::npos);
    EXPECT_NE(script.find("with labels"), std::string::npos);
  }
}

TEST_F(FaceMapRun, ShardsAndOneCoreGiveTheSameBytes) {
  const std::string one = (dir_ / "again").string(), many = (dir_ / "many").string(), where = (dir_ / "case").string();
  {
    const OneCore guard;
    ASSERT_EQ(command("run " + where + " --quiet --out " + one).status, 0);
  }
  ASSERT_EQ(command("sweep plan " + where + " --out " + many).status, 0);
  for (const char* shard : {"3/3", "1/3", "2/3"})
    ASSERT_EQ(command("sweep run " + many + " --quiet --shard " + shard).status, 0);
  ASSERT_EQ(command("sweep merge " + many + " --quiet").status, 0);
  for (const char* file : {"points.csv", "face_map.csv", "face_differences.csv", "differences.csv", "summary.json"}) {
    EXPECT_EQ(content(dir_ / "out" / file), content(dir_ / "again" / file)) << file;
    EXPECT_EQ(content(dir_ / "out" / file), content(dir_ / "many" / file)) << file;
  }
}

/// Nine points with finite elements: a symmetric head alone and on a shaft.
TEST(SlowFaceMap, FreeBodyIsSymmetricAndTheHoselIsOnRecord) {
  const fs::path dir = fresh_directory("fe_face_map");
  write(dir / "case" / "case.toml", R"(kind = "study"
models = ["fe-free-body", "fe-full-club"]
outputs = ["ball_speed_mps"]
histories = true
[grid]
width_mm = 40.0
height_mm = 20.0
columns = 3
rows = 3
[delivery]
club_speed_mps = 45.0
dynamic_loft_deg = 12.0
[head]
mass_kg = 0.2
cg_mm = [-35.0, 0.0, 2.0]
inertia_kg_m2 = [[2.4e-4, 0, 0], [0, 3.4e-4, 0], [0, 0, 4.8e-4]]
bulge_mm = 305.0
roll_mm = 305.0
[contact]
face_friction = 0.4
[ball]
mass_kg = 0.04593
radius_mm = 21.3
[mesh]
harmonics = 1
sector = 1
rings = 1
[time]
steps_per_contact = 30
newton_relative = 1e-9
[shaft]
name = "composite-driver"
[hosel]
position_mm = [-15.0, 55.0, 10.0]
)");
  const Outcome outcome = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const auto summary = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  const CsvFile map(dir / "out" / "face_map.csv");
  ASSERT_EQ(map.rows(), 18u);
  for (std::size_t i = 0; i < map.rows(); ++i) EXPECT_GT(map.number("peak_force_N", i), 8e3);
  EXPECT_LT(summary["mirror_error"]["fe-free-body"].get<double>(), 1e-6);
  EXPECT_GT(summary["mirror_error"]["fe-full-club"].get<double>(), 1e-4);  // the hosel is on one side
  EXPECT_FALSE(fs::exists(dir / "out" / "hosel-fe-free-body.csv"));
  const CsvFile hosel(dir / "out" / "hosel-fe-full-club.csv");
  std::map<std::pair<double, double>, int> instants;
  double largest = 0;
  for (std::size_t i = 0; i < hosel.rows(); ++i) {
    ++instants[{hosel.number("impact_toe_mm", i), hosel.number("impact_high_mm", i)}];
    largest = std::max(largest, std::abs(hosel.number("force_x_N", i)));
  }
  EXPECT_EQ(instants.size(), 9u);
  for (const auto& [place, count] : instants) EXPECT_GT(count, 20);
  EXPECT_GT(largest, 100);
  EXPECT_TRUE(fs::exists(dir / "out" / "figures" / "hosel-fe-full-club.png"));
}

/// A map that is not whole has no figures: what is said of them is not judged, and the run tells what it has.
TEST(FaceMap, StatementsAboutAMapThatIsNotWholeAreNotJudged) {
  const fs::path dir = fresh_directory("face_map_not_whole");
  std::string text = kMap;
  text.replace(text.find("head.mass_kg=0.2025"), 19, R"(delivery.club_path_deg=89", "delivery.face_angle_deg=-60)");
  const std::string at_points = " && difference.ball_speed_mps > 0";
  text.erase(text.find(at_points), at_points.size());
  write(dir / "case.toml", text);
  const Outcome o = command("run " + dir.string() + " --set grid.columns=3 --set grid.rows=3 --quiet --out " +
                            (dir / "out").string());
  ASSERT_EQ(o.status, 3) << o.text;
  const auto s = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  EXPECT_EQ(s.at("failed"), 9);
  ASSERT_EQ(s.at("statements").size(), 1u);
  EXPECT_EQ(s["statements"][0].at("verdict"), "not judged");
}

TEST(FaceMap, EquivalentMassNeedsMapsAndAReference) {
  const fs::path dir = fresh_directory("face_map_mass");
  std::string text = kMap;
  text.erase(text.find("[compare]"), text.find("[delivery]") - text.find("[compare]"));
  text.erase(text.find("[[statement]]"));
  write(dir / "case.toml", text);
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  expect_refused(o, "equivalent_mass: compares maps");
}

/// Speeds and spins of rigid bodies are proportional to the club's speed where restitution and friction do not depend
/// on it, and so is what one model says beyond another: at 6/5 of the speed 6/5 of it are left, and all of an angle.
TEST(FaceMap, WhatIsLeftOfAnEffectAtAnotherSettingIsAShare) {
  const fs::path dir = fresh_directory("face_map_kept");
  std::string text = kMap;
  text.replace(text.find("with = \"variant\"\nvariant = \"own\""), 32, "with = \"model\"\nmodel = \"rigid-eccentric\"");
  text.replace(text.find("[\"rigid-eccentric\"]"), 19, "[\"rigid-eccentric\", \"stick-slip\"]");
  text.replace(text.find("head.mass_kg=0.2025"), 19, "delivery.club_speed_mps=54");
  text.erase(text.find("[[statement]]"));
  write(dir / "case.toml",
        text + "[contact]\nrestitution = 0.8\nrestitution_slope_s_per_m = 0.0\nface_friction = 0.2\n");
  const Outcome o =
      command("run " + dir.string() + " --set grid.columns=5 --set grid.rows=3 --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto s = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  const auto& kept = s.at("kept").at("heavier, stick-slip");
  for (const char* name : {"ball_speed", "backspin", "sidespin"})
    EXPECT_NEAR(kept.at(std::string(name) + "_share").get<double>(), 1.2, 1e-9) << name;
  EXPECT_NEAR(kept.at("launch_angle_share").get<double>(), 1, 1e-9);
}

TEST(FaceMap, ANameWithACommaStaysOneCell) {
  const fs::path dir = fresh_directory("face_map_comma");
  std::string text = kMap;
  text.replace(text.find("\"heavier\""), 9, "\"heavier, 2.5 g\"");
  write(dir / "case" / "case.toml", text);
  const Outcome outcome =
      command("run " + (dir / "case").string() + " --set figures=false --out " + (dir / "out").string());
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(content(dir / "out" / "face_differences.csv").find("\n\"heavier, 2.5 g\",-37.5,-18.75,"),
            std::string::npos);
}

TEST(FaceMap, FlightsAreThoseOfWhatWasFound) {
  const fs::path dir = fresh_directory("face_map_solved");
  std::string blow = kEccentricBlow;
  blow.erase(0, blow.find("[delivery]"));
  write(dir / "case.toml",
        "kind = \"study\"\nmodels = [\"rigid-eccentric\"]\noutputs = [\"carry_m\"]\n[grid]\ncolumns = 3\nrows = 3\n"
        "width_mm = 30\nheight_mm = 10\n[[solve]]\nname = \"drag\"\nkey = \"flight.drag_scale\"\nrange = [0.2, 4.0]\n"
        "output = \"carry_m\"\nvalue = 150.0\n[flight]\nlaw = \"ferguson-2022\"\nunits = \"metres\"\n" +
            blow);
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto drag = CsvFile(dir / "out/points.csv").numbers("drag");
  ASSERT_EQ(drag.size(), 9U);
  ASSERT_GT(std::abs(drag[0] - drag[1]), 0.01) << "each place has its own drag";
  for (const double carry : CsvFile(dir / "out/face_map.csv").numbers("carry_m")) EXPECT_NEAR(carry, 150, 0.01);
}

TEST(FaceMap, AVariantsMisspeltKeyIsAnError) {
  const fs::path dir = fresh_directory("face_map_variant");
  std::string text = kMap;
  text.replace(text.find("head.mass_kg=0.2025"), 19, "head.mas_kg=0.2025");
  write(dir / "case.toml", text);
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  expect_refused(o, "did you mean 'mass_kg'");
}

}  // namespace
