// The kinds modes, swing and identify-shaft as a person types them: bad input is status 2 and one line.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "build_info.hpp"
#include "golf/vector.hpp"
#include "solvers/random.hpp"
#include "tests/app/command.hpp"
#include "tests/app/csv_file.hpp"

namespace hosel::test {
namespace {

const std::string kCase = R"(kind = "swing"
[motion]
file = "grip.csv"
[shaft.table]
arc_length_mm = [0, 500, 1100]
bending_stiffness_N_m2 = [70, 45, 20]
torsional_stiffness_N_m2 = [25, 16, 7]
mass_per_length_g_per_m = [55, 55, 55]
mean_radius_mm = [7, 6, 4]
[head]
mass_kg = 0.2
cg_mm = [-35, 0, 0]
inertia_kg_m2 = [[2e-4, 0, 0], [0, 3e-4, 0], [0, 0, 4e-4]]
[solution]
elements = 4
step_ms = 5.0
)";

std::string euler_motion() {
  std::string csv = "time_s,grip_x_m,grip_y_m,grip_z_m,grip_a_deg,grip_b_deg,grip_c_deg\n";
  for (int i = 0; i < 21; ++i)
    csv += std::to_string(0.01 * i) + ",0,0," + std::to_string(1 + 1e-4 * i * i) + "," + std::to_string(i) + ",10,0\n";
  return csv;
}

struct Bad {
  const char* name;
  const char* from;  // text of the case or of the motion ...
  const char* to;    // ... and what stands there instead
  const char* hint;  // what the line must say
};
void PrintTo(const Bad& b, std::ostream* out) { *out << b.name; }

class BadSwing : public testing::TestWithParam<Bad> {};

TEST_P(BadSwing, EndsWithStatusTwoAndOneLine) {
  const Bad& bad = GetParam();
  const auto dir = fresh_directory(std::string("swing_") + bad.name);
  std::string text = kCase, motion = euler_motion();
  const auto replace = [&](std::string& where) {
    const auto at = where.find(bad.from);
    if (at == std::string::npos) return false;
    where.replace(at, std::string(bad.from).size(), bad.to);
    return true;
  };
  const bool in_case = replace(text), in_motion = !in_case && replace(motion);
  ASSERT_TRUE(in_case || in_motion);
  std::ofstream(dir / "case.toml") << text;
  std::ofstream(dir / "grip.csv") << motion;
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 2) << o.text;
  EXPECT_EQ(std::count(o.text.begin(), o.text.end(), '\n'), 1) << o.text;
  EXPECT_NE(o.text.find(bad.hint), std::string::npos) << o.text;
  EXPECT_FALSE(std::filesystem::exists(dir / "out"));
}

INSTANTIATE_TEST_SUITE_P(
    Input, BadSwing,
    testing::Values(Bad{"backwards", "\n0.070000", "\n0.030000", "backwards"},
                    Bad{"gap", "\n0.200000", "\n0.400000", "gap"}, Bad{"gimbal", ",5,10,0\n", ",5,89.9,0\n", "gimbal"},
                    Bad{"jump", ",5,10,0\n", ",95,10,0\n", "jumps"}, Bad{"empty", ",5,10,0\n", ",,10,0\n", "no number"},
                    Bad{"axes", "time_s,grip_x_m,grip_y_m,grip_z_m,grip_a_deg,grip_b_deg,grip_c_deg\n",
                        "time_s,grip_x_m,grip_y_m,grip_z_m,wrist_deg,x_deg,y_deg\n", "no column 'grip_ex_x'"},
                    Bad{"order", "[0, 500, 1100]", "[1100, 500, 0]", "butt to tip"},
                    Bad{"negative", "[70, 45, 20]", "[70, -45, 20]", "bending_stiffness"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(SwingCase, AxesThatAreNotOrthonormal) {
  const auto dir = fresh_directory("swing_axes");
  std::ofstream(dir / "case.toml") << kCase;
  std::string csv = "time_s,grip_x_m,grip_y_m,grip_z_m,grip_ex_x,grip_ex_y,grip_ex_z,grip_ey_x,grip_ey_y,grip_ey_z\n";
  for (int i = 0; i < 21; ++i) csv += std::to_string(0.01 * i) + ",0,0,1,1,0,0," + (i == 7 ? "0.1" : "0") + ",1,0\n";
  std::ofstream(dir / "grip.csv") << csv;
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  expect_refused(o, ":9:");  // header is line 1
  EXPECT_NE(o.text.find("orthonormal"), std::string::npos) << o.text;
}

TEST(SwingCase, RunsAndWritesItsHistory) {
  const auto dir = fresh_directory("swing_good");
  std::ofstream(dir / "case.toml") << kCase;
  std::ofstream(dir / "grip.csv") << euler_motion();
  const Outcome o = command("run " + dir.string() + " --set output.steps_per_frame=4 --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 0) << o.text;
  EXPECT_TRUE(std::filesystem::exists(dir / "out" / "swing.csv"));
  EXPECT_TRUE(std::filesystem::exists(dir / "out" / "summary.json"));
  // 0.2 s at 5 ms, every fourth step: 11 frames of each body, and in each a row for the 9 nodes of the shaft.
  for (const char* body : {"shaft", "head", "hands", "trail"}) {
    const std::string pvd = content(dir / "out/vtk" / (std::string(body) + ".pvd"));
    std::size_t sets = 0;
    for (std::size_t at = 0; (at = pvd.find("<DataSet ", at)) != std::string::npos; ++at) ++sets;
    EXPECT_EQ(sets, 11u) << body;
  }
  const std::string table = content(dir / "out/shaft.csv");
  EXPECT_EQ(std::ranges::count(table, '\n'), 1 + 11 * 9);
  // What the hands and gravity did is what the club has and has lost.
  const auto energy = nlohmann::json::parse(content(dir / "out/summary.json")).at("energy_J");
  ASSERT_GT(energy.at("kinetic").get<double>(), 0.1);
  EXPECT_LT(std::abs(energy.at("closure").get<double>()), 1e-4 * energy.at("kinetic").get<double>()) << energy;
  const std::string page = content(dir / "out/report.html");
  for (const auto& [name, member] :
       {std::pair{"work of grip and gravity", "external"}, {"of motion, after", "kinetic"}, {"before", "initial"}})
    EXPECT_NE(page.find(fmt::format("<td>{}<td>{:.4f}<", name, energy.at(member).get<double>())), std::string::npos)
        << name;
  EXPECT_NE(page.find("How well it was solved"), std::string::npos);
  EXPECT_NE(page.find("<td>time steps<td>40<"), std::string::npos) << "0.2 s at 5 ms";
  EXPECT_NE(page.find("moved by steps twice as long"), std::string::npos);
}

/// What is said of the time steps' error is the difference between two swings.
TEST(SwingCase, TheErrorOfTheTimeStepsIsTold) {
  const auto dir = fresh_directory("swing_steps");
  std::ofstream(dir / "case.toml") << kCase;
  std::ofstream(dir / "grip.csv") << euler_motion();
  const auto told = [&](const std::string& step) {
    const Outcome o = command("run " + dir.string() + " --force --quiet --set solution.step_ms=" + step + " --out " +
                              (dir / "out").string());
    EXPECT_EQ(o.status, 0) << o.text;
    return nlohmann::json::parse(content(dir / "out/summary.json"));
  };
  const auto fine = told("5"), coarse = told("10");
  const double lead =
      std::abs(fine.at("at_end").at("lead_mm").get<double>() - coarse.at("at_end").at("lead_mm").get<double>());
  ASSERT_GT(lead, 1e-6);
  EXPECT_NEAR(fine.at("numerical_error").at("lead_mm").get<double>(), lead, 1e-9 + 1e-6 * lead);
  EXPECT_GT(coarse.at("numerical_error").at("lead_mm").get<double>(), lead);
  EXPECT_FALSE(nlohmann::json::parse([&] {
                 command("run " + dir.string() + " --force --quiet --set numerical_error=false --out " +
                         (dir / "out").string());
                 return content(dir / "out/summary.json");
               }())
                   .contains("numerical_error"));
}

TEST(SwingCase, ThePageOfIdaSaysThatItKeepsNoEnergyBalance) {
  const auto dir = fresh_directory("swing_ida");
  std::ofstream(dir / "case.toml") << kCase << "integrator = \"ida\"\n";
  std::ofstream(dir / "grip.csv") << euler_motion();
  const Outcome o = command("run " + dir.string() + " --quiet --set motion.begin_s=0 --set motion.end_s=0.06 --out " +
                            (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string page = content(dir / "out/report.html");
  EXPECT_NE(page.find("IDA keeps no energy balance"), std::string::npos);
  EXPECT_EQ(page.find("Where the energy went"), std::string::npos);
}

/// Hands that do not move carry the weight of shaft and head, and nothing moves, from the first instant to the last.
void expect_still(const std::string& name, const std::string& hands, double within) {
  const auto dir = fresh_directory(name);
  std::ofstream(dir / "case.toml") << kCase << hands;
  std::string motion = "time_s,grip_x_m,grip_y_m,grip_z_m,grip_a_deg,grip_b_deg,grip_c_deg\n";
  for (int i = 0; i < 21; ++i) motion += std::to_string(0.01 * i) + ",0,0,1,30,10,0\n";
  std::ofstream(dir / "grip.csv") << motion;
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const CsvFile swing(dir / "out/swing.csv");
  const double weight = (0.2 + 1.1 * 0.055) * 9.80665;
  ASSERT_GT(swing.rows(), 40u);
  for (std::size_t i = 0; i < swing.rows(); ++i) {
    EXPECT_NEAR(std::hypot(swing.number("force_x_N", i), swing.number("force_y_N", i), swing.number("force_z_N", i)),
                weight, within * weight);
    EXPECT_LT(swing.number("head_speed_mps", i), within);
  }
}

TEST(SwingCase, AClubThatIsHeldStillWeighsWhatItWeighs) {
  expect_still("swing_still", "", 1e-4);  // what Newton leaves of the equilibrium at the start
}

TEST(SwingCase, SoftHandsHoldAClubAsItHangsInThem) {
  expect_still("swing_soft_hands",
               "[grip]\ndrive = \"hands\"\nstiffness_N_per_m = [2e4, 2e4, 2e4]\n"
               "rotational_stiffness_N_m_per_rad = [100, 100, 100]\n",
               1e-3);
}

TEST(SwingCase, AShaftWithoutAHeadHasNoFace) {
  const auto dir = fresh_directory("swing_headless");
  std::ofstream(dir / "case.toml") << kCase;
  std::ofstream(dir / "grip.csv") << euler_motion();
  const Outcome o = command("run " + dir.string() + " --set joint.kind=none --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto told = nlohmann::json::parse(content(dir / "out/summary.json"));
  EXPECT_FALSE(told.contains("delivery")) << told;
  EXPECT_GT(told.at("tip").at("club_speed_mps").get<double>(), 1);
  EXPECT_EQ(o.text.find("loft"), std::string::npos) << o.text;
}

TEST(SwingCase, TheWrenchFedBackAndStiffHandsSwingAlike) {
  // Prescribed; forced by the wrench that this took; springs so stiff that they hardly give.
  const auto dir = fresh_directory("swing_drives");
  std::ofstream(dir / "grip.csv") << euler_motion();
  const auto run = [&](const std::string& name, const std::string& grip) {
    std::ofstream(dir / "case.toml") << kCase << grip;
    const Outcome o = command("run " + dir.string() + " --out " + (dir / name).string());
    EXPECT_EQ(o.status, 0) << o.text;
    const CsvFile swing(dir / name / "swing.csv");
    return std::pair(swing.numbers("lead_mm").back(), swing.numbers("droop_mm").back());
  };
  const auto prescribed = run("prescribed", "");
  const auto forced =
      run("forced", "[grip]\ndrive = \"forced\"\nwrench = \"" + (dir / "prescribed" / "swing.csv").string() + "\"\n");
  const auto hands = run("hands",
                         "[grip]\ndrive = \"hands\"\nstiffness_N_per_m = [1e8, 1e8, "
                         "1e8]\nrotational_stiffness_N_m_per_rad = [1e6, 1e6, 1e6]\n");
  const double bent = std::hypot(prescribed.first, prescribed.second);
  EXPECT_GT(bent, 5);  // mm
  EXPECT_LT(std::hypot(forced.first - prescribed.first, forced.second - prescribed.second), 0.02 * bent);
  EXPECT_LT(std::hypot(hands.first - prescribed.first, hands.second - prescribed.second), 0.02 * bent);
  std::ofstream(dir / "case.toml") << kCase << "[grip]\ndrive = \"forced\"\nwrench = \"short.csv\"\n";
  std::ofstream(dir / "short.csv") << "time_s,force_x_N,force_y_N,force_z_N,moment_x_N_m,moment_y_N_m,moment_z_N_m\n0,"
                                      "0,0,0,0,0,0\n0.1,0,0,0,0,0,0\n";
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "short").string());
  expect_refused(o, "does not cover");
}

TEST(SwingCase, MissingDataAreSkippedWithTheReason) {
  const auto dir = fresh_directory("swing_skipped");
  for (const std::string name : {"club-6dof", "swing-markers", "loop-swing-markers"}) {
    const Outcome o = command("run " + std::string(HOSEL_SOURCE_DIR) + "/cases/" + name + " --set " +
                              (name == "club-6dof" ? "motion" : "markers") +
                              ".file=not_there/data.csv --units golf --out " + (dir / name).string());
    EXPECT_EQ(o.status, 0) << o.text;
    EXPECT_NE(o.text.find("SKIPPED"), std::string::npos) << o.text;
    EXPECT_EQ(o.text.find("--units"), std::string::npos) << "of what is not shown nothing is said: " << o.text;
  }
}

TEST(SwingCase, MarkersAreAMotionAndReadingsOfALoop) {
  // A stiff club carried along without turning: what its head markers show is noise about nothing.
  const auto dir = fresh_directory("swing_markers");
  std::ofstream csv(dir / "markers.csv");
  const std::array<std::pair<const char*, Vec3>, 8> marker = {{{"shaft_1", {0.03, 0, 0.75}},
                                                               {"shaft_2", {-0.03, 0, 0.75}},
                                                               {"shaft_3", {0, 0.04, 0.78}},
                                                               {"head_1", {0.04, 0, 0}},
                                                               {"head_2", {-0.04, 0, 0}},
                                                               {"head_3", {0, 0.05, 0}},
                                                               {"left_wrist", {0, 0, 1.0}},
                                                               {"right_wrist", {0, 0, 0.9}}}};
  csv << "time_s";
  for (const auto& [name, at] : marker) csv << fmt::format(",{0}_x_m,{0}_y_m,{0}_z_m", name);
  std::mt19937_64 random(1);
  for (int i = 0; i <= 108; ++i) {
    const double t = i / 360.0, along = t < 0.15 ? 0 : 0.05 * std::pow(t - 0.15, 3);
    csv << fmt::format("\n{:.6f}", t);
    for (const auto& [name, at] : marker)
      for (int k = 0; k < 3; ++k)
        csv << fmt::format(",{:.6f}", at[k] + (k == 0) * along + 2e-5 * (solvers::uniform(random) - 0.5));
  }
  csv.close();
  std::ofstream(dir / "case.toml") << "kind = \"loop\"\n[model]\nbase = \"shaft\"\n[markers]\nfile = \"markers.csv\"\n"
                                      "smoothing_ms = 20\nstill_s = 0.1\nspan_s = [0.1, 0.3]\n"
                                      "[split]\nholdout_s = [0.22, 0.3]\n[shaft]\nname = \"composite-driver\"\n"
                                      "bending_scale = 1000\ndamping_ratio = 0.05\ndamping_frequency_Hz = 4\n"
                                      "[head]\nmass_kg = 0.2\ncg_mm = [-40, 0, 0]\n"
                                      "inertia_kg_m2 = [[3e-4, 0, 0], [0, 4e-4, 0], [0, 0, 5e-4]]\n"
                                      "[hosel]\nposition_mm = [-20, 55, 20]\nlie_deg = 58\n"
                                      "[solution]\nelements = 2\nstep_ms = 5\n";
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto report = nlohmann::json::parse(std::ifstream(dir / "out" / "report.json"));
  EXPECT_EQ(report["verdict"], "no-residual");
  ASSERT_EQ(report["channels"].size(), 2);
  EXPECT_EQ(report["channels"][0]["name"], "lead_mm");
  EXPECT_EQ(report["rows"]["holdout"], 29);  // 0.08 s of 360 Hz, both ends
  for (const auto& c : report["channels"]) {
    EXPECT_GT(c["noise_sd"], 0.005);
    EXPECT_LT(c["noise_sd"], 0.2);  // markers 30 mm apart, read to 0.006 mm, turn a hosel 0.75 m away by 0.1
  }
}

TEST(ModesCase, FrequencyMachineCountsAsPublished) {
  // A 60 g composite driver shaft with about 200 g at the tip counts about 266 cpm (published).
  const auto dir = fresh_directory("modes");
  const Outcome o =
      command("run " + std::string(HOSEL_SOURCE_DIR) + "/cases/frequency-machine --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 0) << o.text;
  std::ifstream file(dir / "out" / "modes.csv");
  std::string header, row;
  std::getline(file, header);
  std::getline(file, row);
  const double cpm = std::stod(row.substr(row.find(',', row.find(',') + 1) + 1));
  EXPECT_NEAR(cpm, 266, 5);
}

}  // namespace
}  // namespace hosel::test
