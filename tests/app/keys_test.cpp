// The key reference covers what the reader accepts, and docs/reference.md is what the reader says now.
#include "app/keys.hpp"

#include <gtest/gtest.h>

#include <map>
#include <regex>

#include "build_info.hpp"
#include "command.hpp"
#include "golf/units.hpp"
#include "loop/effect.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

/// Keys and meanings as the sources declare them: `read({"key", "meaning"`.
std::map<std::string, std::string> declared_in_sources() {
  const std::regex declaration(R"re((\w*)\(\s*\{\s*"(\w+)",\s*"([^"]+)"\s*\})re");
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(HOSEL_SOURCE_DIR) / "app")) {
    const std::string name = entry.path().filename().string();
    const fs::path folder = entry.path().parent_path().filename();
    const bool reads = folder == "kinds" || folder == "study" || name.starts_with("read_") || name == "job.cpp";
    if (!reads || entry.path().extension() != ".cpp") continue;
    const std::string text = test::content(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), declaration), end; it != end; ++it)
      if ((*it)[1] != "in_files" && (*it)[1] != "leave")  // columns of a table; two keys of another reader
        out[(*it)[3].str() + " (" + (*it)[2].str() + ")"] = (*it)[2];
  }
  return out;
}

TEST(Keys, EveryDeclarationIsReached) {
  std::set<std::string> reached;
  for (const AcceptedKey& k : accepted_keys()) {
    reached.insert(k.meaning + " (" + k.name + ")");
    reached.insert(k.meaning + " (" + split_unit(k.name).stem + ")");
  }
  const auto declared = declared_in_sources();
  ASSERT_GT(declared.size(), 250u);  // the pattern has found them
  for (const auto& [meaning, name] : declared)
    EXPECT_TRUE(reached.contains(meaning)) << name << ": " << meaning << ": no variant of app/keys.cpp reads it";
}

TEST(Keys, EveryKeyHasAMeaning) {
  for (const AcceptedKey& k : accepted_keys())
    EXPECT_FALSE(k.meaning.empty()) << k.table << "." << k.name << ": say what it means where it is read";
}

/// Also where a reader puts key and unit together while it reads.
TEST(Keys, ARangeIsInTheUnitOfItsKey) {
  int in_units = 0;
  for (const AcceptedKey& k : accepted_keys()) {
    const SplitName split = split_unit(k.name);
    if (!split.unit || split.stem.ends_with("_per")) continue;  // of a rate that is read as a number
    for (const std::string& range : k.ranges) {
      if (range.empty()) continue;
      ++in_units;
      EXPECT_NE(range.find(" " + std::string(split.unit->suffix)), std::string::npos)
          << k.table << "." << k.name << ": " << range;
    }
  }
  EXPECT_GT(in_units, 200);
}

TEST(Keys, ReferenceIsWhatTheReaderSays) {
  const std::string page = keys_markdown(accepted_keys());
  EXPECT_NE(page.find("| `club_speed_mps` |"), std::string::npos);
  EXPECT_NE(page.find("by head.name |"), std::string::npos);
  EXPECT_EQ(page.find(kUndecided), std::string::npos) << "say by Table::decided_by what decides this default";
  EXPECT_EQ(test::content(fs::path(HOSEL_SOURCE_DIR) / "docs" / "reference.md"), page) << "run scripts/write-reference";
}

TEST(Glossary, HasEveryEffectModelAndVerdictOfTheLoop) {
  const std::string page = test::content(fs::path(HOSEL_SOURCE_DIR) / "docs" / "glossary.md");
  ASSERT_GT(loop::effects().size(), 30u);
  std::vector<std::string> words = {"rigid-planar", "rigid-eccentric", "no-residual",  "explained",
                                    "ambiguous",    "unexplained",     "insufficient", "noise-contradicted"};
  for (const loop::EffectEntry& e : loop::effects()) words.emplace_back(e.name);
  for (const std::string& w : words) EXPECT_NE(page.find("`" + w + "`"), std::string::npos) << w;
}

TEST(Keys, OneKindOrOneTable) {
  const std::vector<AcceptedKey> keys = accepted_keys();
  const std::string ball = keys_text(keys, "ball"), flights = keys_text(keys, "flight");
  EXPECT_NE(ball.find("radius_mm"), std::string::npos) << ball;
  EXPECT_EQ(ball.find("club_speed"), std::string::npos) << ball;
  EXPECT_NE(flights.find("[flight.wind]"), std::string::npos) << flights;
  EXPECT_EQ(test::command("keys bal").status, 2);
  EXPECT_NE(test::command("keys bal").text.find("did you mean 'ball'"), std::string::npos);
}

}  // namespace
}  // namespace hosel::app
