// Files that are no tables: a sentence, not a hang; and names that lead nowhere are not passed over.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <regex>

#include "app/version.hpp"
#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

std::string loop_of(const std::string& shots) {
  return "kind = \"loop\"\n[model]\nbase = \"rigid-planar\"\n[head]\nmass_kg = 0.2\n[data]\nshots = \"" + shots +
         "\"\n";
}

void expect_refused(const std::string& name, const std::string& shots, const std::string& says) {
  const fs::path dir = fresh_directory(name);
  write(dir / "case.toml", loop_of(shots));
  write(dir / "shots.csv", "club_speed_mps,ball_speed_mps\n");
  write(dir / "data/mine/shots.csv", "club_speed_mps,ball_speed_mps\n");
  mkfifo((dir / "pipe.csv").c_str(), 0600);
  const Outcome o = [&] {
    setenv("HOSEL_DATA", (dir / "data").c_str(), 1);
    Outcome out = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
    unsetenv("HOSEL_DATA");
    return out;
  }();
  EXPECT_EQ(o.status, 2) << o.text;
  EXPECT_EQ(std::ranges::count(o.text, '\n'), 1) << o.text;
  EXPECT_NE(o.text.find("case.toml:7: data.shots: "), std::string::npos) << o.text;
  EXPECT_NE(o.text.find(says), std::string::npos) << o.text;
  EXPECT_FALSE(fs::exists(dir / "out"));
}

TEST(InputFile, DevicesAndPipesAreNoTables) {
  expect_refused("device", "/dev/zero", "'/dev/zero' is not a file");
  expect_refused("pipe", "pipe.csv", "pipe.csv' is not a file");
  expect_refused("folder", "data", "data' is not a file");
}

TEST(InputFile, AMisspeltFileIsAnError) {
  expect_refused("own_file", "shost.csv", "did you mean 'shots.csv'");
  expect_refused("measured_file", "mine/shost.csv", "did you mean 'shots.csv'");
  expect_refused("measured_folder", "mien/shots.csv", "did you mean 'mine'");
}

TEST(InputFile, MeasuredDataThatAreNotHereAreSkipped) {
  const fs::path dir = fresh_directory("not_here");
  write(dir / "case.toml", loop_of("trackman_driver/shots.csv"));
  setenv("HOSEL_DATA", (dir / "nowhere").c_str(), 1);
  const Outcome checked = command("check " + dir.string());
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  unsetenv("HOSEL_DATA");
  EXPECT_EQ(checked.status, 0) << checked.text;
  EXPECT_NE(checked.text.find("# a run has SKIPPED what needs it: "), std::string::npos) << checked.text;
  EXPECT_NE(checked.text.find("nowhere/trackman_driver/shots.csv is not there; HOSEL_DATA"), std::string::npos)
      << checked.text;
  EXPECT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("SKIPPED"), std::string::npos) << o.text;
}

TEST(InputFile, WhatIsKnownAndAveragedHasAName) {
  const fs::path dir = fresh_directory("known");
  write(dir / "shots.csv", "club,club_speed_mps,ball_speed_mps\n7i,40,55\n");
  const auto said = [&](const std::string& more) {
    write(dir / "case.toml", loop_of("shots.csv") + more);
    const Outcome o = command("check " + dir.string());
    EXPECT_EQ(o.status, 2) << more << o.text;
    return o.text;
  };
  const std::string rest = "sd = 2\nsource = \"scales\"\n";
  EXPECT_NE(said("[[data.known]]\neffect = \"head-mass\"\nparameter = \"mass\"\n" + rest)
                .find("case.toml:10: data.known[1].parameter: head-mass has here: added_mass [g]"),
            std::string::npos);
  EXPECT_NE(
      said("[[data.known]]\neffect = \"head-mas\"\nparameter = \"added_mass\"\n" + rest).find("no effect 'head-mas'"),
      std::string::npos);
  EXPECT_NE(said("[[data.varying]]\neffect = \"head-mass\"\nparameter = \"added_mass\"\n" + rest)
                .find("compare them as means (average_by)"),
            std::string::npos);
  EXPECT_NE(said("average_by = \"player\"\n").find("no column 'player' to average by"), std::string::npos);
  EXPECT_NE(said("average_by = \"club\"\n").find("too few to tell how rows scatter"), std::string::npos);
  EXPECT_NE(said("average_by = \"club\"\n[data.noise]\nball_speed_mps = 0.2\n").find("leave out this table"),
            std::string::npos);
}

TEST(InputFile, ANewCaseFindsWhatItsModelNamed) {
  const fs::path dir = fresh_directory("new_case");
  write(dir / "here/base/case.toml", kEccentricBlow);
  write(dir / "here/sweep/case.toml",
        "kind = \"study\"\ncase = \"../base\"\n[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [40.0]\n");
  write(dir / "here/sweep/README.md", "of the other case");
  write(dir / "here/sweep/data.csv", "a\n1\n");
  ASSERT_EQ(command("new " + (dir / "far/away/mine").string() + " --from " + (dir / "here/sweep").string()).status, 0);
  EXPECT_FALSE(fs::exists(dir / "far/away/mine/README.md")) << "it is about the other case";
  EXPECT_TRUE(fs::exists(dir / "far/away/mine/data.csv"));
  const Outcome o = command("check " + (dir / "far/away/mine").string());
  EXPECT_EQ(o.status, 0) << o.text;
}

TEST(InputFile, ANewCaseFindsWhatStandsInSingleQuotes) {
  const fs::path dir = fresh_directory("new_quotes");
  write(dir / "data/blows.csv", "delivery.club_speed_mps\n40\n");
  write(dir / "source/case.toml", study_of_blow() + "[rows]\nfile = '../data/blows.csv'\n");
  const std::string mine = (dir / "far/away/mine").string();
  ASSERT_EQ(command("new " + mine + " --from " + (dir / "source").string()).status, 0);
  const Outcome o = command("check " + mine);
  EXPECT_EQ(o.status, 0) << o.text;
}

TEST(InputFile, AShippedCaseIsCalledByItsName) {
  const fs::path dir = fresh_directory("elsewhere");
  FILE* pipe = popen(("cd " + dir.string() + " && " HOSEL_COMMAND " check cases/iron7-trackman 2>&1").c_str(), "r");
  std::string text;
  for (char buffer[512]; fgets(buffer, sizeof buffer, pipe);) text += buffer;
  EXPECT_EQ(WEXITSTATUS(pclose(pipe)), 2);
  EXPECT_NE(text.find("the shipped case is called 'iron7-trackman'"), std::string::npos) << text;
}

TEST(Command, VersionAndHelpAreWhereTheyAreLookedFor) {
  const Outcome version = command("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(std::regex_match(version.text, std::regex("hosel " HOSEL_VERSION " build [0-9a-f]{40}\n")))
      << version.text;
  EXPECT_NE(version.text, "hosel " + hosel::app::program_version() + "\n") << "that of this test: another program";
  EXPECT_EQ(command("help").status, 0);
  const Outcome help = command("help run");
  EXPECT_EQ(help.status, 0);
  EXPECT_NE(help.text.find("--set"), std::string::npos) << help.text;
  EXPECT_EQ(command("help rnu").status, 2);
}

}  // namespace
