// Maps of swung clubs: every point is the blow that the kind loaded-club computes there, and the parts add up.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "build_info.hpp"
#include "tests/app/command.hpp"

namespace hosel::test {
namespace {

// The last quarter second of the shipped swing on coarse meshes: what is compared is the way, not the number.
const std::string kClub = R"(
[motion]
file = "GRIP"
begin_s = -0.25
end_s = 0.0
[shaft]
name = "composite-driver"
bending_scale = 1.5
[head]
mass_kg = 0.204
cg_mm = [-42.3, 1.0, 2.9]
inertia_kg_m2 = [[2.8e-4, 0, 0], [0, 4.1e-4, 0], [0, 0, 5.7e-4]]
bulge_mm = 305.0
roll_mm = 305.0
[hosel]
position_mm = [-15.0, 55.0, 10.0]
lie_deg = 58.0
lean_deg = 9.8
[solution]
elements = 5
step_ms = 2.0
grip_point_mm = 230.0
[contact]
face_friction = 0.4
[mesh]
harmonics = 2
antisymmetric = 1
sector = 2
rings = 2
[time]
steps_per_contact = 12
)";

std::string club() {
  std::string text = kClub;
  text.replace(text.find("GRIP"), 4, std::string(HOSEL_SOURCE_DIR) + "/cases/swing-driver/grip.csv");
  return text;
}

using Row = std::map<std::string, std::string>;
std::vector<Row> rows(const std::filesystem::path& file) {
  std::vector<Row> out;
  std::vector<std::string> header;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::string cell;
    bool quoted = false;
    for (const char c : line + ",")
      if (c == '"') quoted = !quoted;
      else if (c == ',' && !quoted) cells.push_back(std::exchange(cell, {}));
      else cell += c;
    if (header.empty()) header = cells;
    else
      for (out.emplace_back(); const std::string& name : header)
        out.back()[name] = cells[std::size_t(&name - header.data())];
  }
  return out;
}

double at_centre(const std::vector<Row>& table, const std::string& key, const std::string& name,
                 const std::string& quantity) {
  for (const Row& r : table)
    if (r.at(key) == name && std::stod(r.at("impact_toe_mm")) == 0 && std::stod(r.at("impact_high_mm")) == 0)
      return std::stod(r.at(quantity));
  ADD_FAILURE() << name << " has no row at the centre";
  return NAN;
}

TEST(LoadedFaceMap, IsTheBlowOfTheLoadedClubAndItsPartsAddUp) {
  const auto dir = fresh_directory("loaded_face_map");
  const std::string swings =
      "[grid]\ncolumns = 3\nrows = 3\n[[swings]]\nname = \"first\"\nset = []\n[[swings]]\nname = \"opened\"\n"
      "set = [\"motion.turn_about_shaft_deg=-8\"]\n[[swings]]\nname = \"recorded\"\n"
      "set = [\"motion.file='nowhere/swing.csv'\"]\n";
  write(dir / "map" / "case.toml", "kind = \"loaded-face-map\"\n" + club() + swings);
  write(dir / "club" / "case.toml",
        "kind = \"loaded-club\"\n" + club() +
            "[volumetric]\npublished = \"driver\"\n[points]\nimpact_toe_mm = [0.0]\nimpact_high_mm = [0.0]\n");
  setenv("HOSEL_DATA", (dir / "none").c_str(), 1);
  const Outcome map = command("run " + (dir / "map").string() + " --out " + (dir / "out").string());
  unsetenv("HOSEL_DATA");
  ASSERT_EQ(map.status, 0) << map.text;
  EXPECT_NE(map.text.find("left out, since its recording is not there: recorded"), std::string::npos) << map.text;
  const Outcome one = command("run " + (dir / "club").string() + " --out " + (dir / "one").string());
  ASSERT_EQ(one.status, 0) << one.text;

  const auto maps = rows(dir / "out" / "face_maps.csv"), points = rows(dir / "one" / "points.csv"),
             parts = rows(dir / "out" / "parts.csv");
  ASSERT_EQ(maps.size(), 2u * 4u * 9u);
  for (const auto& [body, name] : {std::pair{"free head", "free body"},
                                   {"club at rest", "club at rest"},
                                   {"club preloaded", "club loaded, clamped"},
                                   {"club loaded", "club loaded"}})
    for (const char* quantity : {"ball_speed_mps", "backspin_rpm", "sidespin_rpm", "head_rotation_rad_per_s"}) {
      const double here = at_centre(maps, "model", std::string("first, ") + body, quantity),
                   there = at_centre(points, "club", name, quantity);
      EXPECT_NEAR(here, there, 1e-8 * std::abs(there)) << name << " " << quantity;  // nine digits are printed
    }
  // The shaft, its preload and the wrench each do something, and what they do is all that the club does.
  for (const Row& whole : parts) {
    if (whole.at("part") != "all") continue;
    double sum = 0;
    for (const Row& r : parts)
      if (r.at("part") != "all" && r.at("impact_toe_mm") == whole.at("impact_toe_mm") &&
          r.at("impact_high_mm") == whole.at("impact_high_mm")) {
        sum += std::stod(r.at("ball_speed_mps_mean"));
        EXPECT_GT(std::abs(std::stod(r.at("backspin_rpm_mean"))), 0.1) << r.at("part");
        EXPECT_GE(std::stod(r.at("backspin_rpm_high")), std::stod(r.at("backspin_rpm_low")));
      }
    EXPECT_NEAR(sum, std::stod(whole.at("ball_speed_mps_mean")), 1e-7);
  }
}

}  // namespace
}  // namespace hosel::test
