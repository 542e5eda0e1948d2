// Malformed cases: status 2, one line that names file, line and key; nothing is written.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ostream>

#include "app/output.hpp"
#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

struct Malformed {
  const char* name;
  const char* from;  // text of the good case ...
  const char* to;    // ... and what stands there instead
  int line;          // where the error must point
  const char* key;   // what it must name
  const char* hint;  // and what it must say
};
void PrintTo(const Malformed& m, std::ostream* out) { *out << m.name; }

class MalformedCase : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedCase, EndsWithStatusTwoAndOneLine) {
  const Malformed& m = GetParam();
  const fs::path dir = fresh_directory(m.name);
  std::string text = kEccentricBlow;
  const auto at = text.find(m.from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(m.from).size(), m.to);
  std::ofstream(dir / "case.toml") << text;
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(std::count(o.text.begin(), o.text.end(), '\n'), 1) << o.text;
  EXPECT_NE(o.text.find("case.toml:" + std::to_string(m.line) + ":"), std::string::npos) << o.text;
  EXPECT_NE(o.text.find(m.key), std::string::npos) << o.text;
  EXPECT_NE(o.text.find(m.hint), std::string::npos) << o.text;
  EXPECT_FALSE(fs::exists(dir / "out"));
}

INSTANTIATE_TEST_SUITE_P(
    Ten, MalformedCase,
    testing::Values(Malformed{"unknown_key", "dynamic_loft_deg", "dynamic_lofft_deg", 5, "dynamic_lofft_deg",
                              "did you mean 'dynamic_loft_deg'"},
                    Malformed{"unknown_table", "[head]", "[heads]", 6, "heads", "did you mean '[head]'"},
                    Malformed{"wrong_unit", "club_speed_mps", "club_speed_mm", 4, "club_speed_mm", "expected a speed"},
                    Malformed{"no_unit", "club_speed_mps", "club_speed", 4, "club_speed", "club_speed_mph"},
                    Malformed{"out_of_range", "club_speed_mps = 45.0", "club_speed_mps = 450.0", 4, "club_speed_mps",
                              "0 to 150 mps"},
                    Malformed{"not_a_number", "mass_kg = 0.2", "mass_kg = nan", 7, "mass_kg", "nan"},
                    Malformed{"negative_mass", "mass_kg = 0.2", "mass_kg = -0.2", 7, "mass_kg", "0.01 to 5 kg"},
                    Malformed{"impossible_inertia", "4.8e-4", "9.8e-4", 9, "inertia_kg_m2", "exceeds the sum"},
                    Malformed{"text_for_number", "club_speed_mps = 45.0", "club_speed_mps = \"fast\"", 4,
                              "club_speed_mps", "expected a number"},
                    Malformed{"unknown_model", "rigid-eccentric", "rigid-ecentric", 2, "models",
                              "did you mean 'rigid-eccentric'"},
                    Malformed{"not_toml", "[delivery]", "[delivery", 3, "case.toml", "not valid TOML"},
                    Malformed{"unknown_kind", "\"impact\"", "\"impakt\"", 1, "kind", "did you mean 'impact'"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Command, MissingFileNamesTheNearestCase) {
  const Outcome o = command("run iron7-trakman");
  expect_refused(o, "did you mean 'iron7-trackman'");
}

TEST(Command, ContactMethodsAreNamed) {
  const std::string run = "check " HOSEL_SOURCE_DIR "/cases/driver-toe --set contact.method=";
  EXPECT_EQ(command(run + "augmented-lagrangian").status, 0);
  EXPECT_EQ(command(run + "augmented-lagrangian --set contact.penetration=1e-6").status, 0);
  const Outcome wrong = command(run + "augmented-lagrangean"),
                idle = command(run + "penalty --set contact.penetration=1e-6");
  expect_refused(wrong, "did you mean 'augmented-lagrangian'");
  EXPECT_EQ(idle.status, 2);  // a penalty reaches none
  EXPECT_NE(idle.text.find("penetration"), std::string::npos) << idle.text;
}

TEST(Command, FinishedRunIsNotOverwrittenUnlessTold) {
  const fs::path dir = fresh_directory("finished");
  std::ofstream(dir / "case.toml") << kEccentricBlow;
  const std::string arguments = "run " + dir.string() + " --out " + (dir / "out").string();
  ASSERT_EQ(command(arguments).status, 0);
  for (const char* file : {"case.resolved.toml", "summary.json", "log.txt"})
    EXPECT_TRUE(fs::exists(dir / "out" / file));
  const Outcome again = command(arguments);
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.text.find("--force"), std::string::npos);
  EXPECT_EQ(command(arguments + " --force").status, 0);
}

TEST(Command, NoReportOfAnEarlierRunStandsBesideAnUnfinishedOne) {
  const fs::path out = fresh_directory("unfinished");
  const std::array told{"summary.json", "report.json", "report.html"};
  for (const char* file : told) std::ofstream(out / file) << "{}";
  const hosel::app::Output begun({.directory = out, .force = true, .quiet = true, .log = {}}, "");
  for (const char* file : told) EXPECT_FALSE(fs::exists(out / file)) << file;
}

TEST(Command, ResolvedCaseRunsAgain) {
  const fs::path dir = fresh_directory("resolved");
  std::ofstream(dir / "case.toml") << kEccentricBlow;
  ASSERT_EQ(command("run " + dir.string() + " --out " + (dir / "out").string()).status, 0);
  EXPECT_EQ(command("check " + (dir / "out" / "case.resolved.toml").string()).status, 0);
}

}  // namespace
