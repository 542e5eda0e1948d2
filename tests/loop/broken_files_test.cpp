// Broken files through the command: a report, or one line that names the file and status 2; never a crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <ostream>

#include "tests/app/command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

constexpr const char* kHeader =
    "club_speed_mps,attack_angle_deg,dynamic_loft_deg,ball_speed_mps,launch_angle_deg,backspin_rpm\n";
constexpr const char* kCase = R"(kind = "loop"
title = "broken"
[model]
base = "rigid-planar"
[head]
mass_kg = 0.2
[data]
shots = "shots.csv"
)";

/// A row of the given number; `constant`: an input and an output that never change.
std::string row(int k, bool constant) {
  char text[96];
  std::snprintf(text, sizeof text, "%.1f,%.1f,%.1f,%.1f,%.1f,%d\n", constant ? 45.0 : 40 + 0.1 * (k % 97),
                -2 + 0.1 * (k % 41), 10 + 0.1 * (k % 53), constant ? 62.0 : 57 + 0.1 * (k % 89), 9 + 0.1 * (k % 47),
                2000 + k % 701);
  return text;
}

struct Broken {
  const char* name;
  std::function<void(std::ostream&)> write;
  const char* verdict;  ///< nullptr: one line on the file in place of a report
  const char* says;     ///< part of that line, or of the report
};
void PrintTo(const Broken& b, std::ostream* out) { *out << b.name; }

class BrokenFile : public testing::TestWithParam<Broken> {};

TEST_P(BrokenFile, EndsInAReportOrInOneLine) {
  const Broken& b = GetParam();
  const fs::path dir = fresh_directory(std::string("broken_") + b.name);
  std::ofstream(dir / "case.toml") << kCase;
  {
    std::ofstream out(dir / "shots.csv");
    b.write(out);
  }
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  if (b.verdict) {
    EXPECT_EQ(o.status, 0) << o.text;
    ASSERT_TRUE(fs::exists(dir / "out" / "report.json")) << o.text;
    EXPECT_TRUE(fs::exists(dir / "out" / "report.html"));
    std::ifstream in(dir / "out" / "report.json");
    const auto report = nlohmann::json::parse(in);
    EXPECT_EQ(report["verdict"], b.verdict);
    EXPECT_TRUE(report["adopted"].empty());
    EXPECT_NE(report.dump().find(b.says), std::string::npos);
  } else {
    EXPECT_EQ(o.status, 2);
    EXPECT_EQ(std::count(o.text.begin(), o.text.end(), '\n'), 1) << o.text;
    EXPECT_NE(o.text.find("shots.csv"), std::string::npos) << o.text;
    EXPECT_NE(o.text.find(b.says), std::string::npos) << o.text;
  }
  fs::remove_all(dir);
}

void rows(std::ostream& out, int count, bool constant = false) {
  out << kHeader;
  for (int k = 0; k < count; ++k) out << row(k, constant);
}

INSTANTIATE_TEST_SUITE_P(
    Loop, BrokenFile,
    testing::Values(Broken{"empty", [](std::ostream&) {}, nullptr, "empty"},
                    Broken{"header_alone", [](std::ostream& o) { rows(o, 0); }, "insufficient", "\"read\":0"},
                    Broken{"one_row", [](std::ostream& o) { rows(o, 1); }, "insufficient", "\"read\":1"},
                    Broken{"constant_columns", [](std::ostream& o) { rows(o, 40, true); }, "unexplained",
                           "\"read\":40"},
                    Broken{"all_missing",
                           [](std::ostream& o) {
                             o << kHeader;
                             for (int k = 0; k < 40; ++k) o << ",,,,,\n";
                           },
                           "insufficient", "\"read\":40"},
                    Broken{"outputs_missing",
                           [](std::ostream& o) {
                             o << kHeader;
                             for (int k = 0; k < 40; ++k) o << 40 + k % 7 << ",0,12,,,\n";
                           },
                           "insufficient", "\"read\":40"},
                    Broken{"latin_1",
                           [](std::ostream& o) {
                             o << "player," << kHeader;
                             for (int k = 0; k < 40; ++k) o << "Bj\xF6rn," << row(k, false);
                           },
                           nullptr, "shots.csv:2: not UTF-8"},
                    Broken{"misspelt_input",
                           [](std::ostream& o) {
                             o << "impact_tow_mm," << kHeader;
                             for (int k = 0; k < 40; ++k) o << k % 9 << "," << row(k, false);
                           },
                           nullptr, "did you mean 'impact_toe'"},
                    Broken{"input_without_unit",
                           [](std::ostream& o) {
                             o << "impact_toe_mn," << kHeader;
                             for (int k = 0; k < 40; ++k) o << k % 9 << "," << row(k, false);
                           },
                           nullptr, "needs a unit of length"},
                    Broken{"million_rows", [](std::ostream& o) { rows(o, 1'000'000); }, nullptr, "1000000 rows"}),
    [](const auto& info) { return std::string(info.param.name); });

/// Whatever is said of them: the residuals of one shot, many times, span nothing that could be searched.
TEST(RepeatedShots, EndInAReport) {
  for (const int different : {1, 3}) {
    const fs::path dir = fresh_directory("repeated_shots");
    write(dir / "case.toml", kCase);
    std::string shots = kHeader;
    for (int k = 0; k < 60; ++k) shots += row(different == 1 ? 3 : k % different, false);
    write(dir / "shots.csv", shots);
    const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
    EXPECT_EQ(o.status, 0) << o.text;
    EXPECT_TRUE(fs::exists(dir / "out" / "report.json")) << o.text;
  }
}

}  // namespace
