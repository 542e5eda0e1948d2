/// What a run is computed for, compared byte by byte.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "command.hpp"

namespace hosel::test {

/// Every file below a directory of outputs but those that say when and how it was made, by name.
inline std::map<std::string, std::string> results_below(const std::filesystem::path& out) {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out)) {
    const std::string name = entry.path().filename().string(), ending = entry.path().extension().string();
    if (entry.is_regular_file() && name != "log.txt" && name != ".lock" && name != "report.html" &&
        name != "points.jsonl" && ending != ".pdf")
      all[std::filesystem::relative(entry.path(), out).string()] = content(entry.path());
  }
  return all;
}

/// The same files with the same bytes.
inline void expect_same_results(const std::filesystem::path& out, const std::map<std::string, std::string>& whole,
                                const std::string& told) {
  const auto here = results_below(out);
  ASSERT_EQ(here.size(), whole.size()) << told;
  for (const auto& [name, bytes] : whole) {
    ASSERT_TRUE(here.contains(name)) << told << ": " << name;
    EXPECT_TRUE(here.at(name) == bytes) << told << ": " << name << " differs";
  }
}

}  // namespace hosel::test
