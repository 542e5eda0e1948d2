// Blows of swung clubs: a point of a study is the blow that an impact follows there, and the parts add up.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
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

TEST(Study, OfSwungClubsIsTheirBlowsAndItsPartsAddUp) {
  const auto dir = fresh_directory("swung_club");
  const std::string swung = std::string(HOSEL_SOURCE_DIR) + "/cases/swing-driver/grip.csv";
  write(dir / "map" / "swings.csv", "name,motion.file,motion.turn_about_shaft_deg\nfirst," + swung + ",0\nopened," +
                                        swung + ",-8\nrecorded,nowhere/swing.csv,0\n");
  write(dir / "map" / "case.toml", R"(kind = "study"
models = ["fe-free-body"]
outputs = ["ball_speed_mps", "backspin_rpm", "head_spin_rad_per_s", "hands_force_N"]
parts_over = "row"
[[variant]]
name = "free head"
[[variant]]
name = "at rest"
set = ["models=['fe-full-club']", "grip.start=straight", "grip.hold=clamped"]
[[variant]]
name = "preloaded"
set = ["models=['fe-full-club']", "grip.hold=clamped"]
[[variant]]
name = "loaded"
set = ["models=['fe-full-club']", "grip.hold=forced"]
[compare]
with = "variant"
variant = "free head"
[[part]]
name = "shaft present"
of = "at rest"
minus = "free head"
[[part]]
name = "preload"
of = "preloaded"
minus = "at rest"
[[part]]
name = "grip wrench"
of = "loaded"
minus = "preloaded"
[[part]]
name = "all"
of = "loaded"
minus = "free head"
[grid]
columns = 3
rows = 3
[rows]
file = "swings.csv"
)" + club());
  setenv("HOSEL_DATA", (dir / "none").c_str(), 1);
  const Outcome map = command("run " + (dir / "map").string() + " --out " + (dir / "out").string());
  unsetenv("HOSEL_DATA");
  ASSERT_EQ(map.status, 0) << map.text;
  EXPECT_NE(map.text.find("left out, since its recording is not there: recorded"), std::string::npos) << map.text;
  const auto maps = rows(dir / "out" / "face_map.csv"), points = rows(dir / "out" / "points.csv"),
             parts = rows(dir / "out" / "parts.csv");
  ASSERT_EQ(maps.size(), 4u * 2u * 9u);
  ASSERT_EQ(points.size(), maps.size());
  EXPECT_EQ(points.front().at("model"), "fe-free-body");
  EXPECT_EQ(points.back().at("model"), "fe-full-club");

  // The same blow alone.
  write(dir / "club" / "case.toml", "kind = \"impact\"\nmodels = [\"fe-full-club\"]\n[grip]\nhold = \"forced\"\n" +
                                        club() + "[output]\nvtk = false\n");
  const Outcome one = command("run " + (dir / "club").string() + " --out " + (dir / "one").string());
  ASSERT_EQ(one.status, 0) << one.text;
  EXPECT_GT(rows(dir / "one" / "shaft.csv").size(), 6u);  // what its shaft carries, a row a node and step
  const auto summary = nlohmann::json::parse(std::ifstream(dir / "one" / "summary.json"));
  for (const char* quantity : {"ball_speed_mps", "backspin_rpm", "sidespin_rpm", "azimuth_deg"}) {
    const double here = at_centre(maps, "model", "loaded, first", quantity),
                 there = summary.at("models").at("fe-full-club").at(quantity);
    EXPECT_NEAR(here, there, 1e-8 * std::abs(there)) << quantity;  // nine digits are printed
  }
  // The shaft, its preload and the wrench each do something, and what they do is all that the club does.
  std::size_t places = 0;
  for (const Row& whole : parts) {
    if (whole.at("part") != "all") continue;
    ++places;
    double sum = 0;
    for (const Row& r : parts)
      if (r.at("part") != "all" && r.at("delivery.impact_toe_mm") == whole.at("delivery.impact_toe_mm") &&
          r.at("delivery.impact_high_mm") == whole.at("delivery.impact_high_mm")) {
        sum += std::stod(r.at("ball_speed_mps_mean"));
        EXPECT_GT(std::abs(std::stod(r.at("backspin_rpm_mean"))), 0.1) << r.at("part");
        EXPECT_GT(std::stod(r.at("backspin_rpm_high")), std::stod(r.at("backspin_rpm_low")));
      }
    EXPECT_NEAR(sum, std::stod(whole.at("ball_speed_mps_mean")), 1e-7);
  }
  EXPECT_EQ(places, 9u);
}

// What the kind loaded-club printed of this club before it became a study (hosel 1.0.0, last with that kind): the same
// keys, `[volumetric] published = "driver"`, one point in the middle of the face. Columns as in `kQuantities`.
constexpr std::array kQuantities = {"ball_speed_mps",      "backspin_rpm",        "sidespin_rpm",
                                    "riflespin_rpm",       "head_speed_mps",      "head_spin_rad_per_s",
                                    "hosel_impulse_x_N_s", "hosel_impulse_z_N_s", "hosel_moment_impulse_y_N_m_s"};
struct Former {
  const char *name, *model, *start, *hold;
  std::array<double, 9> values;
};
const std::array kFormer = {
    Former{"free body",
           "fe-free-body",
           "",
           "",
           {64.2502226, 3302.09181, -4124.06033, -192.755195, 33.3029488, 37.8549812, NAN, NAN, NAN}},
    Former{"at rest",
           "fe-full-club",
           "straight",
           "clamped",
           {64.548214, 3303.26425, -4190.06249, -201.032782, 33.6080141, 27.7055721, 0.117078, 0.0768341, 0.00409588}},
    Former{"no gravity",
           "fe-full-club",
           "weightless",
           "forced",
           {64.5993274, 3217.51893, -4106.39023, -202.691018, 33.5427421, 22.0104239, 0.12778, 0.122914, 0.00645911}},
    Former{"loaded",
           "fe-full-club",
           "swing",
           "forced",
           {64.5965923, 3219.06641, -4107.53549, -202.587002, 33.541652, 22.0014589, 0.127132, 0.122515, 0.00645635}},
    Former{"free",
           "fe-full-club",
           "swing",
           "free",
           {64.5556773, 3364.91858, -4196.2283, -213.906391, 33.542308, 21.5396353, 0.101756, 0.0700568, 0.0059442}},
    Former{"hands",
           "fe-full-club",
           "hands",
           "forced",
           {64.59653, 3218.94542, -4107.52933, -202.462293, 33.541773, 22.0403839, 0.127055, 0.12231, 0.006437}},
    Former{"volumetric",
           "volumetric",
           "",
           "",
           {68.1514976, 1322.89621, -1640.15975, -66.6672104, 32.7359635, 27.3964694, NAN, NAN, NAN}},
    Former{"coupled",
           "shaft-coupled",
           "straight",
           "clamped",
           {68.4141324, 1289.90143, -1663.31307, -80.4216236, 32.959018, 24.2019701, NAN, NAN, NAN}},
    Former{"coupled, loaded",
           "shaft-coupled",
           "swing",
           "clamped",
           {68.4813074, 1233.75277, -1614.34063, -82.3445369, 32.8232759, 24.1319116, NAN, NAN, NAN}},
};

TEST(Study, OfASwungClubSaysWhatTheKindOfLoadedClubsSaid) {
  const auto dir = fresh_directory("swung_club_former");
  std::string text = "kind = \"study\"\nmodels = [\"fe-free-body\"]\noutputs = [";
  for (const char* q : kQuantities) text += '"' + std::string(q) + "\", ";
  text += "]\n";
  for (const Former& f : kFormer) {
    text += "[[variant]]\nname = \"" + std::string(f.name) + "\"\nset = [\"models=['" + f.model + "']\"";
    if (*f.start) text += ", \"grip.start=" + std::string(f.start) + "\", \"grip.hold=" + f.hold + '"';
    text += "]\n";
  }
  write(dir / "case.toml", text + club() + "[volumetric]\npublished = \"driver\"\n");
  const Outcome run = command("run " + dir.string() + " --out " + (dir / "out").string());
  ASSERT_EQ(run.status, 0) << run.text;
  const auto points = rows(dir / "out" / "points.csv");
  ASSERT_EQ(points.size(), kFormer.size());
  for (std::size_t i = 0; i < kFormer.size(); ++i)
    for (std::size_t q = 0; q < kQuantities.size(); ++q) {
      const std::string& said = points[i].at(kQuantities[q]);
      const double former = kFormer[i].values[q];
      if (std::isnan(former)) EXPECT_EQ(said, "") << kFormer[i].name << " " << kQuantities[q];
      else  // six digits of an impulse were printed; Newton's and the swing's iterations end at 1e-8 and below
        EXPECT_NEAR(std::stod(said), former, 5e-6 * std::abs(former)) << kFormer[i].name << " " << kQuantities[q];
    }
}

TEST(Study, OfASwungClubRefusesWhatASwingDoesNotSay) {
  const auto dir = fresh_directory("swung_club_refused");
  const auto refused = [&](const std::string& more) {
    write(dir / "case.toml", "kind = \"impact\"\nmodels = [\"fe-full-club\"]\n" + club());
    return command("check " + dir.string() + more);
  };
  EXPECT_EQ(refused("").status, 0);
  EXPECT_NE(refused(" --set delivery.club_speed_mps=45").text.find("club_speed_mps"), std::string::npos);
  EXPECT_NE(refused(" --set grip.force_N=[0,0,300]").text.find("force_N"), std::string::npos);
  for (const char* set :
       {" --set joint.kind=hinge --set grip.start=hands", " --set joint.kind=hinge --set grip.start=weightless",
        " --set joint.kind=none", " --set delivery.club_speed_mps=45", " --set grip.force_N=[0,0,300]"})
    EXPECT_EQ(refused(set).status, 2) << set;
  for (const char* former : {"loaded-club", "loaded-face-map", "characteristic-time", "ball-rule", "slopes"})
    EXPECT_NE(refused(std::string(" --set kind=") + former).text.find("is now 'study'"), std::string::npos) << former;
}

}  // namespace
}  // namespace hosel::test
