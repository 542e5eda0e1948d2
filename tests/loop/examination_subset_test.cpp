// A fixed small part of the blind examination (tests/examination): development seed 7, 30 and 100 shots.
// The bounds are those that a loop at the examination's goals passes with a probability of 98 % or
// more per line: so few sets can show a broken loop, not grade a good one.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>
#include "build_info.hpp"

namespace {

namespace fs = std::filesystem;

nlohmann::json examine(const std::vector<std::pair<std::string, int>>& strata, const std::string& name) {
  const fs::path dir = fs::temp_directory_path() / ("hosel-examination-" + name + "-" + std::to_string(getpid()));
  fs::remove_all(dir);
  const std::string program = "'" EXAMINATION_COMMAND "' ";
  for (const auto& [stratum, sets] : strata) {
    const std::string make = program + "make --seed 7 --shots 30,100 --stratum " + stratum + " --sets " +
                             std::to_string(sets) + " --out '" + dir.string() + "'";
    EXPECT_EQ(std::system(make.c_str()), 0) << make;
  }
  EXPECT_EQ(std::system((program + "run --dir '" + dir.string() + "' --hosel '" HOSEL_COMMAND "'").c_str()), 0);
  EXPECT_EQ(std::system((program + "score --dir '" + dir.string() + "'").c_str()), 0);
  std::ifstream in(dir / "score.json");
  nlohmann::json score = nlohmann::json::parse(in);
  std::size_t wanted = 0;
  for (const auto& [stratum, sets] : strata) wanted += static_cast<std::size_t>(sets);
  EXPECT_EQ(score["sets"].size(), wanted);
  for (const auto& set : score["sets"]) EXPECT_EQ(set["status"], 0) << set;
  fs::remove_all(dir);
  return score;
}

struct Count {
  int hits = -1, of = -1;
};

Count line(const nlohmann::json& score, const std::string& stratum, const std::string& what) {
  for (const auto& l : score["table"])
    if (l["stratum"] == stratum && l["what"] == what) return {l["hits"], l["of"]};
  ADD_FAILURE() << "the score has no line '" << what << "' of " << stratum;
  return {};
}

TEST(ExaminationSubset, NothingHiddenNothingAdopted) {
  const auto score =
      examine({{"null", 8}, {"null-input-noise", 4}, {"null-heavy-tails", 4}, {"null-bad-rows", 4}}, "nulls");
  int adoptions = 0;
  for (const char* stratum : {"null", "null-input-noise", "null-heavy-tails", "null-bad-rows"})
    adoptions += line(score, stratum, "adoptions").hits;
  EXPECT_LE(adoptions, 2);  // of 20 at 3 %: three or more has a probability of 2 %
}

TEST(ExaminationSubset, OneEffectIsNamed) {
  const auto score = examine({{"one-effect", 12}}, "one");
  const Count named = line(score, "one-effect", "named alone, a >= 4.8");
  EXPECT_EQ(named.of, 12);
  EXPECT_GE(named.hits, 8);  // at 93 %: seven or fewer has a probability below 0.1 %
  EXPECT_LE(line(score, "one-effect", "a wrong name").hits, 1);
}

TEST(ExaminationSubset, WhatHasNoNameIsUnexplained) {
  const auto score = examine({{"outside", 10}}, "outside");
  EXPECT_GE(line(score, "outside", "and the channel").hits, 6);  // at 90 %: five or fewer 0.2 %
}

TEST(ExaminationSubset, BadRowsAndDerivedColumnsAreFound) {
  const auto score = examine({{"bad-rows", 8}, {"derived", 5}}, "rows");
  const Count found = line(score, "bad-rows", "bad rows found"), accused = line(score, "bad-rows", "good rows flagged");
  EXPECT_GT(found.of, 20);
  EXPECT_GE(found.hits, 0.9 * found.of);
  EXPECT_LE(accused.hits, 0.02 * accused.of);
  EXPECT_GE(line(score, "derived", "found").hits, 4);
}

}  // namespace
