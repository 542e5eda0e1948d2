// [face.plate]: faults of a case and of its CSV are refused with file and line; kinds that take a plate.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

const std::string kCase = R"(kind = "characteristic-time"
[head]
name = "driver-200"
[sphere]
radius_mm = 11.0
[impact]
toe_mm = 0.0
[line]
faces = 2
[face.plate]
)";

void refused(const std::string& toml, const std::string& csv, const std::string& says) {
  const fs::path dir = fresh_directory("plate_case");
  write(dir / "case.toml", kCase + toml);
  write(dir / "data.csv", csv);
  const Outcome o = command("check " + dir.string());
  EXPECT_EQ(o.status, 2) << o.text;
  EXPECT_NE(o.text.find(says), std::string::npos) << o.text;
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
  refused("thickness = {map = 'rings', share = [0.5, 0.2], value_mm = [2, 3]}\n", "", "must ascend");
  refused("thickness = {value_mm = 2.8}\nmaterial = 'own'\n", "", "young");
}

TEST(PlateCase, ReducedModelsRefuseAPlate) {
  const fs::path dir = fresh_directory("plate_reduced");
  write(dir / "case.toml",
        kEccentricBlow + "[volumetric]\npublished = 'driver'\n[face.plate]\nthickness = {value_mm = 2.8}\n");
  const Outcome o = command("check " + dir.string() + " --set 'models=[\"volumetric\"]'");
  EXPECT_EQ(o.status, 2) << o.text;
  EXPECT_NE(o.text.find("lumped face"), std::string::npos) << o.text;
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

TEST(PlateCase, TheFaceIsJudgedByTheRulesAndByItsYieldStrength) {
  const fs::path dir = fresh_directory("plate_judged");
  write(dir / "case.toml", kFace);
  const auto run = [&](const std::string& options) {
    const Outcome o = command("run '" + dir.string() + "' --force --out '" + (dir / "out").string() + "' " + options);
    EXPECT_EQ(o.status, 0) << o.text;
    return std::pair(o.text, nlohmann::json::parse(content(dir / "out" / "summary.json")));
  };
  const auto [thin, told] = run("--set face.plate.thickness.value_mm=2.4");
  ASSERT_GT(told["largest_characteristic_time_us"].get<double>(), 257) << thin;
  ASSERT_GT(told["peak_stress_MPa"].get<double>(), 828) << thin;
  EXPECT_GT(told["characteristic_time_error_us"].get<double>(), 0);
  EXPECT_NE(thin.find("this face fails the rules' test"), std::string::npos) << thin;
  EXPECT_NE(thin.find("exceeds the yield strength of 828 MPa"), std::string::npos) << thin;
  const auto [thick, other] = run("--set face.plate.thickness.value_mm=4 --set face.plate.yield_MPa=5000");
  ASSERT_LT(other["largest_characteristic_time_us"].get<double>(), 250) << thick;
  EXPECT_NE(thick.find("this face passes the rules' test"), std::string::npos) << thick;
  EXPECT_EQ(thick.find("yield strength"), std::string::npos) << thick;
}

/// A thicker plate is tapped for a shorter time, and gives less back.
TEST(PlateCase, CharacteristicTimeAndStudiesTakeAPlate) {
  const fs::path dir = fresh_directory("plate_tap");
  write(dir / "tap" / "case.toml", kCase + "thickness = {value_mm = 2.8}\n");
  const Outcome tap = command("run " + (dir / "tap").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(tap.status, 0) << tap.text;
  EXPECT_NE(tap.text.find("characteristic time"), std::string::npos) << tap.text;
  EXPECT_NE(content(dir / "out" / "line.csv").find("0.85000,"), std::string::npos);
  write(dir / "face" / "case.toml",
        "kind = 'study'\naccuracy = 'look'\nmodels = ['fe-free-body']\noutputs = ['face_restitution', "
        "'rigid_restitution', 'characteristic_time_us', 'give_to_ball_m_per_N', 'give_to_pendulum_m_per_N']\n"
        "[[axis]]\nkey = 'delivery.impact_toe_mm'\nvalues = [0, 20]\n"
        "[delivery]\nclub_speed_mps = 48.77\n[ball]\nmodel = 'tour'\n[head]\nname = 'driver-200'\n"
        "[face.plate]\nthickness = {value_mm = 2.8}\n");
  const Outcome face = command("run " + (dir / "face").string() + " --out " + (dir / "map").string());
  ASSERT_EQ(face.status, 0) << face.text;
  std::istringstream table(content(dir / "map" / "points.csv"));
  std::string head, centre;
  std::getline(table, head);
  std::getline(table, centre);
  const auto column = [&](const std::string& name) {
    std::istringstream names(head), cells(centre);
    for (std::string n, c; std::getline(names, n, ',') && std::getline(cells, c, ',');)
      if (n == name) return std::stod(c);
    ADD_FAILURE() << name << " is no column of " << head;
    return 0.0;
  };
  EXPECT_GT(column("face_restitution"), column("rigid_restitution") + 0.02) << head << "\n" << centre;
  const auto tapped = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  EXPECT_NEAR(column("characteristic_time_us"), tapped["characteristic_time_us"].get<double>(), 1e-6);
  EXPECT_GT(column("give_to_pendulum_m_per_N"), column("give_to_ball_m_per_N")) << "the smaller patch sinks deeper";
}

}  // namespace
