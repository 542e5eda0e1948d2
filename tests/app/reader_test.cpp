// A case read again with other overrides, as a study does at every point.
#include "app/reader.hpp"
#include "app/job.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <regex>
#include <set>

#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;
using hosel::app::CaseFile;
using hosel::app::InputError;

/// What is wrong with `number` of the second [[row]], with these overrides beside those of the case.
std::string refusal(const CaseFile& file, const std::vector<std::string>& overrides) {
  try {
    CaseFile again(file, overrides);
    again.root().tables("row").at(1).number({"number", "of a test"}, {0, 1});
    return "";
  } catch (const InputError& e) { return e.what(); }
}

TEST(Reader, ACaseReadAgainKnowsTheLinesOfItsFile) {
  const fs::path file = fresh_directory("reader_lines") / "case.toml";
  write(file, "# a comment\n[other]\nx = 1\n\n[[row]]\nnumber = 0.5\n\n[[row]]\nnumber = 2.0\n");
  const CaseFile read(file);
  const std::string at = file.string() + ":9: row[2].number: 2 is out of range";
  EXPECT_TRUE(refusal(read, {}).starts_with(at)) << refusal(read, {});
  EXPECT_TRUE(refusal(read, {"other.x=2.5"}).starts_with(at)) << refusal(read, {"other.x=2.5"});
  EXPECT_TRUE(refusal(read, {"row[2].number=3.5"}).starts_with("--set row[2].number=3.5: row[2].number: 3.5 is out of"))
      << refusal(read, {"row[2].number=3.5"});
  EXPECT_EQ(refusal(read, {"row[2].number=0.75"}), "");
  EXPECT_TRUE(refusal(read, {}).starts_with(at)) << "an override is kept for the next";
  write(file, "[[row]]\nnumber = 0.5\n[[row]]\nnumber = 0.5\n");
  EXPECT_TRUE(refusal(read, {}).starts_with(at)) << "the file as it was when it was read";
}

TEST(Reader, ARefusedTensorIsNamedWhereItWasGiven) {
  const std::string inertia = "head.inertia_kg_m2=[[1e-4,0,0],[0,1e-4,0],[0,0,5e-4]]";
  expect_refused(command("check driver-toe --set '" + inertia + "'"),
                 "--set " + inertia + ": head.inertia_kg_m2: the largest principal moment");
  // Both are given: the one on the command line is at fault. Of 0.7 kg a moment of 5e-7 kg m2 is a radius below 1 mm.
  const fs::path dir = fresh_directory("reader_tensor");
  std::string text = kEccentricBlow;
  text.replace(text.find("2.9e-4"), 6, "5.0e-7").replace(text.find("4.8e-4"), 6, "3.7e-4");
  write(dir / "case.toml", text);
  expect_refused(command("check " + dir.string() + " --set head.mass_kg=0.7"),
                 "--set head.mass_kg=0.7: head.mass_kg: a principal moment of 5e-07");
  expect_refused(command("check " + dir.string() + " --set head.mass_kg=0.7 --set '" + inertia + "'"),
                 "--set " + inertia + ": head.inertia_kg_m2");
}

TEST(Reader, AQuantityWithoutItsUnitIsToldSo) {
  expect_refused(command("check driver-toe --set delivery.club_speed=50"),
                 "delivery.club_speed: has no unit, expected a speed (club_speed_mps");
  expect_refused(command("check driver-toe --set delivery.impact_toe=5"), "has no unit, expected a length");
  // One that may be left out, and is.
  expect_refused(command("check driver-toe --set head.cg=5"), "head.cg: has no unit");
}

TEST(Reader, AStudyOfTheCaseAroundItLeavesItsOwnResolvedCase) {
  const fs::path dir = fresh_directory("reader_around");
  write(dir / "case.toml", kEccentricBlow);
  write(dir / "inner/case.toml",
        "kind = \"study\"\ncase = \"..\"\n[[axis]]\nkey = \"delivery.dynamic_loft_deg\"\nvalues = [10, 12]\n");
  const auto run = [&](const fs::path& what, const std::string& out) {
    const Outcome o = command("run " + what.string() + " --quiet --out " + (dir / out).string());
    ASSERT_EQ(o.status, 0) << o.text;
  };
  run(dir / "inner", "first");
  EXPECT_NE(content(dir / "first/case.resolved.toml").find("kind = \"study\""), std::string::npos);
  fs::create_directories(dir / "elsewhere");
  fs::rename(dir / "first", dir / "elsewhere/moved");
  run(dir / "elsewhere/moved/case.resolved.toml", "second");
  EXPECT_EQ(content(dir / "elsewhere/moved/points.csv"), content(dir / "second/points.csv"));
}

/// The case as it is resolved with these overrides; empty where it refuses them.
std::string resolved(const fs::path& file, const std::vector<std::string>& set = {}) {
  try {
    CaseFile read(file, set);
    hosel::app::read_job(read);
    return read.resolved();
  } catch (const InputError&) { return ""; }
}

/// A folder with every shipped case, in which each is resolved too.
fs::path shipped_cases(const std::string& name) {
  const fs::path to = fresh_directory(name), from = fs::path(HOSEL_SOURCE_DIR) / "cases";
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    const fs::path file = to / fs::relative(entry.path(), from);
    if (entry.is_directory()) fs::create_directories(file);
    else if (file.extension() != ".png") fs::create_symlink(entry.path(), file);
  }
  return to;
}

TEST(Reader, AResolvedCaseWithAnotherSettingIsTheCaseWithIt) {
  const fs::path cases = shipped_cases("reader_resolved");
  const std::vector<std::string> settings = {"face.plate.material=maraging-steel",
                                             "face.name=modern-driver",
                                             "ball.model=three-piece",
                                             "head.name=driver-200",
                                             "accuracy=look",
                                             "delivery.club_speed_mps=31.5"};
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(cases))
    if (entry.path().filename() == "case.toml") files.push_back(entry.path());
  std::ranges::sort(files);
  // Of each kind the first case that takes a setting: what reads a setting is the kind's.
  std::map<std::string, std::set<std::string>> taken;
  int read = 0;
  for (const fs::path& file : files) {
    const std::string name = fs::relative(file, cases).string();
    // A study reads each of its points: two stand for all.
    const bool study = content(file).find("\"study\"") != std::string::npos;
    if (study && !name.starts_with("face-line") && !name.starts_with("compare-heads")) continue;
    const fs::path again = file.parent_path() / "case.resolved.toml";
    const std::string as_it_is = resolved(file);
    ASSERT_NE(as_it_is, "") << name;
    write(again, as_it_is);
    EXPECT_EQ(resolved(again), as_it_is) << name;
    ++read;
    std::smatch kind;
    const std::string text = content(file);
    ASSERT_TRUE(std::regex_search(text, kind, std::regex("(?:^|\n)kind\\s*=\\s*\"([\\w-]+)\""))) << name;
    for (const std::string& setting : settings) {
      if (taken[setting].contains(kind[1])) continue;
      const std::string expected = resolved(file, {setting});
      if (expected.empty() || expected == as_it_is) continue;
      EXPECT_EQ(resolved(again, {setting}), expected) << name << " with " << setting;
      taken[setting].insert(kind[1]);
    }
  }
  EXPECT_GT(read, 30);
  for (const std::string& setting : settings) EXPECT_GT(taken[setting].size(), 0u) << "no case takes " << setting;
}

TEST(Reader, WhatSomebodyChangedInAResolvedCaseStands) {
  const fs::path dir = fresh_directory("reader_changed"), file = dir / "case.toml";
  std::string text = kEccentricBlow;
  const auto from = text.find("[head]"), to = text.find("\n[", from + 1);
  text.replace(from, to - from, "[head]\nname = \"driver-460\"\n");
  write(file, text);
  std::string changed = resolved(file);
  const std::string mass = "\nmass_kg = 0.204\n", cg = "\ncg_mm = [ ";
  const auto at = changed.find(mass, changed.find("\n[head]"));
  ASSERT_NE(at, std::string::npos) << changed;
  ASSERT_NE(changed.find(cg), std::string::npos) << changed;
  write(dir / "case.resolved.toml", changed);
  const fs::path again = dir / "case.resolved.toml";
  // A part of a list that was left to its default is set in it.
  EXPECT_EQ(resolved(file, {"head.cg_mm[2]=3.5"}), "");
  EXPECT_NE(resolved(again, {"head.cg_mm[2]=3.5"}).find(", 3.5, "), std::string::npos);
  write(again, changed.replace(at, mass.size(), "\nmass_kg = 0.21\n"));
  EXPECT_EQ(resolved(again, {"head.name=driver-200"}), resolved(file, {"head.mass_kg=0.21", "head.name=driver-200"}));
  EXPECT_NE(resolved(again, {"head.name=driver-200"}), resolved(file, {"head.name=driver-200"}));
  // What is set to its default is stated.
  EXPECT_NE(resolved(file, {"head.mass_kg=0.204"}), resolved(file));
  EXPECT_EQ(resolved(again, {"head.mass_kg=0.204"}), resolved(file, {"head.mass_kg=0.204"}));
}

TEST(Reader, ACopyOfWhatACaseNamesIsTheSameInput) {
  const fs::path dir = fresh_directory("reader_copies");
  write(dir / "case/case.toml", "first = \"../tables/a.csv\"\nsecond = \"b.csv\"\n");
  write(dir / "tables/a.csv", "x\n1\n");
  write(dir / "case/b.csv", "x\n2\n");
  std::map<fs::path, fs::path> copies;
  std::string text;
  const auto fingerprint = [&](const fs::path& file) {
    CaseFile read(file);
    for (const char* key : {"first", "second"}) read.root().file({key, "of a test"});
    read.finish();
    copies = read.inputs()->copies();
    text = read.resolved();
    return read.inputs()->fingerprint();
  };
  const std::string original = fingerprint(dir / "case/case.toml");
  ASSERT_EQ(copies.size(), 2u);
  for (const char* out : {"out", "changed"}) {
    for (const auto& [copy, from] : copies) write(dir / out / copy, content(from));
    write(dir / out / "case.resolved.toml", text);
  }
  // The contents of the two changed places.
  std::vector<fs::path> changed;
  for (const auto& [copy, from] : copies) changed.push_back(dir / "changed" / copy);
  fs::rename(changed[0], dir / "between");
  fs::rename(changed[1], changed[0]);
  fs::rename(dir / "between", changed[1]);
  EXPECT_EQ(fingerprint(dir / "out/case.resolved.toml"), original);
  EXPECT_NE(fingerprint(dir / "changed/case.resolved.toml"), original);
}

/// Two files that end alike are two inputs.
TEST(Reader, FilesOfOneNameInTwoFoldersAreNotExchanged) {
  const fs::path dir = fresh_directory("reader_exchanged");
  write(dir / "case.toml", "first = \"one/a.csv\"\nsecond = \"two/a.csv\"\n");
  const auto fingerprint = [&](const std::string& first, const std::string& second) {
    write(dir / "data/one/a.csv", first);
    write(dir / "data/two/a.csv", second);
    setenv("HOSEL_DATA", (dir / "data").c_str(), 1);
    CaseFile read(dir);
    for (const char* key : {"first", "second"}) read.root().data_file({key, "of a test"});
    unsetenv("HOSEL_DATA");
    read.finish();
    return read.inputs()->fingerprint();
  };
  const std::string original = fingerprint("x\n1\n", "x\n2\n");
  EXPECT_NE(fingerprint("x\n2\n", "x\n1\n"), original);
}

/// The number that an override sets; its text where it is none.
std::string set_to(const CaseFile& file, const std::string& text) {
  CaseFile again(file, {"other.x=" + text});
  auto table = again.root().table("other");
  try {
    return fmt::format("{}", table.number({"x", "of a test"}));
  } catch (const InputError&) { return "not a number"; }
}

TEST(Reader, ANumberIsSetToTheLastBitOrRefusedAsTomlRefusesIt) {
  const fs::path file = fresh_directory("reader_numbers") / "case.toml";
  write(file, "[other]\nx = 1\n");
  const CaseFile read(file);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-12, 12);
  for (int i = 0; i < 500; ++i) {
    const std::string number = fmt::format("{}", std::ldexp(mantissa(random), exponent(random)));
    EXPECT_EQ(set_to(read, number), number);
  }
  for (const char* word : {"7", "-7", "0", "-0.5", "0.1", "1e-3", "1_000.5", "+2.5", "12345678901234567890.25"})
    EXPECT_EQ(set_to(read, word), fmt::format("{}", std::stod(std::string(word) == "1_000.5" ? "1000.5" : word)));
  for (const char* word : {"00.5", "-.5", ".5", "5.", "1.2.3", "1-2.5", "--1.5", "1.5-", "", "0x1.8", "1,5"})
    EXPECT_EQ(set_to(read, word), "not a number") << word;
}

}  // namespace
