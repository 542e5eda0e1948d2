// Blows of swung clubs: a point of a study is the blow that an impact follows there, and the parts add up.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "build_info.hpp"
#include "golf/units.hpp"
#include "golf/vector.hpp"
#include "tests/app/command.hpp"
#include "tests/app/csv_file.hpp"

namespace hosel::test {
namespace {

// The last quarter second of the shipped swing on the coarsest mesh: what is compared is the way, not the number.
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
harmonics = 1
sector = 1
rings = 1
[time]
steps_per_contact = 12
)";

std::string club() {
  std::string text = kClub;
  text.replace(text.find("GRIP"), 4, HOSEL_SOURCE_DIR "/cases/swing-driver/grip.csv");
  return text;
}

double at_centre(const CsvFile& table, const std::string& model, const std::string& quantity) {
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (table.text("model", i) == model && table.number("impact_toe_mm", i) == 0 &&
        table.number("impact_high_mm", i) == 0)
      return table.number(quantity, i);
  ADD_FAILURE() << model << " has no row at the centre";
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
  const CsvFile maps(dir / "out" / "face_map.csv"), points(dir / "out" / "points.csv"),
      parts(dir / "out" / "parts.csv");
  ASSERT_EQ(maps.rows(), 4u * 2u * 9u);
  ASSERT_EQ(points.rows(), maps.rows());
  EXPECT_EQ(points.texts("model").front(), "fe-free-body");
  EXPECT_EQ(points.texts("model").back(), "fe-full-club");

  // The same blow alone.
  write(dir / "club" / "case.toml", "kind = \"impact\"\nmodels = [\"fe-full-club\"]\n[grip]\nhold = \"forced\"\n" +
                                        club() + "[output]\nvtk = false\n");
  const Outcome one = command("run " + (dir / "club").string() + " --out " + (dir / "one").string());
  ASSERT_EQ(one.status, 0) << one.text;
  EXPECT_GT(CsvFile(dir / "one" / "shaft.csv").rows(), 6u);  // what its shaft carries, a row a node and step
  const auto summary = nlohmann::json::parse(std::ifstream(dir / "one" / "summary.json"));
  for (const char* quantity : {"ball_speed_mps", "backspin_rpm", "sidespin_rpm", "azimuth_deg"}) {
    const double here = at_centre(maps, "loaded, first", quantity),
                 there = summary.at("models").at("fe-full-club").at(quantity);
    EXPECT_NEAR(here, there, 1e-8 * std::abs(there)) << quantity;  // nine digits are printed
  }
  // The shaft, its preload and the wrench each do something, and what they do is all that the club does.
  std::size_t places = 0;
  for (std::size_t w = 0; w < parts.rows(); ++w) {
    if (parts.text("part", w) != "all") continue;
    ++places;
    double sum = 0;
    for (std::size_t i = 0; i < parts.rows(); ++i)
      if (parts.text("part", i) != "all" &&
          parts.text("delivery.impact_toe_mm", i) == parts.text("delivery.impact_toe_mm", w) &&
          parts.text("delivery.impact_high_mm", i) == parts.text("delivery.impact_high_mm", w)) {
        sum += parts.number("ball_speed_mps_mean", i);
        EXPECT_GT(std::abs(parts.number("backspin_rpm_mean", i)), 0.1) << parts.text("part", i);
        EXPECT_GT(parts.number("backspin_rpm_high", i), parts.number("backspin_rpm_low", i));
      }
    EXPECT_NEAR(sum, parts.number("ball_speed_mps_mean", w), 1e-7);
  }
  EXPECT_EQ(places, 9u);
}

constexpr std::array kQuantities = {"ball_speed_mps", "backspin_rpm",     "sidespin_rpm", "riflespin_rpm",
                                    "club_speed_mps", "attack_angle_deg", "club_path_deg"};
constexpr std::array kImpulses = {"hosel_impulse_x_N_s", "hosel_impulse_y_N_s", "hosel_impulse_z_N_s",
                                  "hosel_moment_impulse_y_N_m_s"};

/// A swung club by each model, start and hold that it may have.
struct Swung {
  const char *name, *model, *start, *hold;
  bool shaft = false;  ///< as finite elements
};
constexpr std::array kSwung = {Swung{"free body", "fe-free-body", "", ""},
                               Swung{"at rest", "fe-full-club", "straight", "clamped", true},
                               Swung{"no gravity", "fe-full-club", "weightless", "forced", true},
                               Swung{"loaded", "fe-full-club", "swing", "forced", true},
                               Swung{"free", "fe-full-club", "swing", "free", true},
                               Swung{"hands", "fe-full-club", "hands", "forced", true},
                               Swung{"volumetric", "volumetric", "", ""},
                               Swung{"coupled", "shaft-coupled", "straight", "clamped"},
                               Swung{"coupled, loaded", "shaft-coupled", "swing", "clamped"}};

/// A velocity or, with a negative speed, its opposite, from how fast, how far up and how far to the right it points.
Vec3 pointing(double speed, double up_deg, double right_deg) {
  const double up = radians(up_deg), right = radians(right_deg);
  return speed * Vec3(std::cos(up) * std::cos(right), -std::cos(up) * std::sin(right), std::sin(up));
}

/// A variant of a study sets what its own case would: the same answer, and no two of them alike. What head and ball
/// have of momentum beyond the delivered head's came through the hosel.
TEST(Study, OfASwungClubSaysWhatEachOfItsCasesSays) {
  const auto dir = fresh_directory("swung_club_cases");
  const std::string swung = club() + "[volumetric]\npublished = \"driver\"\n";
  std::string text = "kind = \"study\"\nmodels = [\"fe-free-body\"]\noutputs = [";
  for (const char* q : kQuantities) text += '"' + std::string(q) + "\", ";
  for (const char* q : kImpulses) text += '"' + std::string(q) + "\", ";
  text += "]\n";
  for (const Swung& s : kSwung) {
    text += "[[variant]]\nname = \"" + std::string(s.name) + "\"\nset = [\"models=['" + s.model + "']\"";
    if (*s.start) text += ", \"grip.start=" + std::string(s.start) + "\", \"grip.hold=" + s.hold + '"';
    text += "]\n";
  }
  write(dir / "case.toml", text + swung);
  const Outcome run = command("run " + dir.string() + " --out " + (dir / "out").string());
  ASSERT_EQ(run.status, 0) << run.text;
  const CsvFile points(dir / "out" / "points.csv");
  ASSERT_EQ(points.rows(), kSwung.size());
  for (std::size_t i = 0; i < kSwung.size(); ++i) {
    const Swung& s = kSwung[i];
    std::string alone = "kind = \"impact\"\nmodels = [\"" + std::string(s.model) + "\"]\n";
    if (*s.start) alone += "[grip]\nstart = \"" + std::string(s.start) + "\"\nhold = \"" + s.hold + "\"\n";
    const auto own = dir / ("own_" + std::to_string(i));
    write(own / "case.toml", alone + swung + "[output]\nvtk = false\n");
    const Outcome o = command("run " + own.string() + " --quiet --out " + (own / "out").string());
    ASSERT_EQ(o.status, 0) << s.name << o.text;
    const auto said = nlohmann::json::parse(content(own / "out" / "summary.json")).at("models").at(s.model);
    for (const char* q : {"ball_speed_mps", "backspin_rpm", "sidespin_rpm", "riflespin_rpm"})
      EXPECT_NEAR(points.number(q, i), said.at(q).get<double>(), 1e-9 * std::abs(said.at(q).get<double>()))
          << s.name << " " << q;
    for (const char* q : kImpulses) EXPECT_EQ(points.text(q, i) != "", s.shaft) << s.name << " " << q;
    if (std::string(s.model).starts_with("fe-")) {
      const auto& v = said.at("head_velocity_mps");
      const Vec3 gained = 0.204 * (Vec3(v[0], v[1], v[2]) - pointing(points.number("club_speed_mps", i),
                                                                     points.number("attack_angle_deg", i),
                                                                     points.number("club_path_deg", i))) +
                          0.04593 *
                              pointing(said.at("ball_speed_mps"), said.at("launch_angle_deg"), said.at("azimuth_deg"));
      Vec3 came = Vec3::Zero();  // in the face's axes
      for (int k = 0; k < 3 && s.shaft; ++k) came[k] = points.number(kImpulses[std::size_t(k)], i);
      // A dozen steps a contact; the weight's own impulse is 0.001 N s.
      EXPECT_NEAR(gained.norm(), came.norm(), s.shaft ? 0.01 * came.norm() : 1e-9) << s.name;
      EXPECT_GT(came.norm(), s.shaft ? 0.1 : -1) << s.name;
    }
    // Gravity, the least of these, turns the spin by a thousandth of itself.
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GT(std::abs(points.number("backspin_rpm", i) - points.number("backspin_rpm", k)), 0.05)
          << s.name << " and " << kSwung[k].name;
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
