// A case read again with other overrides, as a study does at every point.
#include "app/reader.hpp"
#include "app/job.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

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

TEST(Reader, AnotherHeadOfAResolvedCaseIsWhole) {
  const fs::path dir = fresh_directory("reader_head");
  std::string text = kEccentricBlow;
  const auto from = text.find("[head]"), to = text.find("\n[", from + 1);
  text.replace(from, to - from, "[head]\nname = \"driver-460\"\n");
  write(dir / "case.toml", text);
  const auto mass = [&](const fs::path& file, const std::vector<std::string>& set) {
    CaseFile read(file, set);
    hosel::app::read_job(read);
    return read.resolved().substr(read.resolved().find("[head]"), 400);
  };
  write(dir / "resolved/case.resolved.toml", [&] {
    CaseFile read(dir / "case.toml");
    hosel::app::read_job(read);
    return read.resolved();
  }());
  const fs::path resolved = dir / "resolved/case.resolved.toml";
  EXPECT_NE(mass(resolved, {}).find("mass_kg = 0.204"), std::string::npos) << mass(resolved, {});
  EXPECT_EQ(mass(resolved, {"head.name=driver-200"}), mass(dir / "case.toml", {"head.name=driver-200"}));
  EXPECT_NE(mass(resolved, {"head.name=driver-200"}), mass(resolved, {}));
  // The same name changes nothing, and what is set beside the other name stands.
  EXPECT_EQ(mass(resolved, {"head.name=driver-460"}), mass(resolved, {}));
  EXPECT_NE(mass(resolved, {"head.mass_kg=0.21", "head.name=driver-200"}).find("mass_kg = 0.21"), std::string::npos);
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
