// Files that nest deeper than a stack or ask for more than a memory: one line that says so, soon.
#include <gtest/gtest.h>

#include <algorithm>

#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

// A hundred thousand tables in one another overflowed the stack; thirty thousand did not.
constexpr int kDeep = 100'000;

std::string repeated(const std::string& piece, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += piece;
  return out;
}

const std::string kDeepJson = repeated("[", kDeep) + repeated("]", kDeep);

void expect_one_line(const Outcome& o, const std::string& says) {
  EXPECT_EQ(o.status, 2) << o.text.substr(0, 500);
  EXPECT_EQ(std::ranges::count(o.text, '\n'), 1) << o.text.substr(0, 500);
  EXPECT_LT(o.text.size(), 1000u);
  EXPECT_NE(o.text.find(says), std::string::npos) << o.text.substr(0, 500);
}

TEST(Bounds, TablesInOneAnother) {
  const fs::path dir = fresh_directory("deep_case");
  for (const auto& [before, after] : {std::pair{"", " = 1\n"}, {"[", "]\n"}}) {
    write(dir / "case.toml", kEccentricBlow + before + "a" + repeated(".a", kDeep) + after);
    expect_one_line(command("check " + dir.string()), "case.toml: more than 10000 dots");
  }
  write(dir / "case.toml", kEccentricBlow);
  expect_one_line(command("check " + dir.string() + " --set a" + repeated(".a", 60'000) + "=1"),
                  "more than 10000 dots");
  EXPECT_EQ(command("check " + dir.string()).status, 0);
}

TEST(Bounds, ACaseOfMegabytes) {
  const fs::path dir = fresh_directory("large_case");
  write(dir / "case.toml", kEccentricBlow + "#" + std::string(1 << 20, 'x') + "\n");
  expect_one_line(command("check " + dir.string()), "case.toml: more than 1 MiB");
}

TEST(Bounds, ListsInOneAnother) {
  const fs::path dir = fresh_directory("deep_lists");
  const auto import = [&] {
    return command("import " + (dir / "session.json").string() + " --out " + (dir / "case").string());
  };
  write(dir / "session.json", "[{\"a\":" + kDeepJson + "}]");
  expect_one_line(import(), "session.json: broken JSON (more than 100 lists and objects in one another)");

  for (const char* run : {"a", "b"}) {
    write(dir / run / "case.resolved.toml", "kind = \"impact\"\n");
    write(dir / run / "summary.json", "{\"a\":" + kDeepJson + "}");
  }
  expect_one_line(command("diff " + (dir / "a").string() + " " + (dir / "b").string()), "summary.json: more than 100");

  write(dir / "blow/case.toml", kEccentricBlow);
  write(dir / "sweep/case.toml",
        "kind = \"sweep\"\ncase = \"../blow\"\n[[parameters]]\nkey = \"delivery.club_speed_mps\"\nvalues = [40.0]\n");
  const std::string out = (dir / "out").string();
  ASSERT_EQ(command("sweep plan " + (dir / "sweep").string() + " --out " + out).status, 0);
  ASSERT_EQ(command("sweep run " + out + " --quiet").status, 0);
  const fs::path points = dir / "out/shards/1-of-1/points.jsonl";
  ASSERT_TRUE(fs::exists(points));
  write(points, content(points) + "{\"point\":1,\"a\":" + kDeepJson + ",\"check\":\"\"}\n");
  expect_one_line(command("sweep merge " + out + " --quiet --force"), "points.jsonl:3: not a finished point");
}

TEST(Bounds, ACellForEveryNameInEveryRow) {
  const fs::path dir = fresh_directory("wide");
  const auto import = [&](const std::string& name, const std::string& text) {
    write(dir / name, text);
    return command("import " + (dir / name).string() + " --out " + (dir / "case").string());
  };
  std::string keys, shots;
  for (int i = 0; i < kDeep; ++i) {
    keys += (i ? ",\"k" : "\"k") + std::to_string(i) + "\":1";
    shots += (i ? ",{\"k" : "{\"k") + std::to_string(i) + "\":1}";
  }
  expect_one_line(import("keys.json", "[{" + keys + "}]"), "100000 names and 1 rows, more than 1000");
  expect_one_line(import("shots.json", "[" + shots + "]"), "100000 names and 100000 rows, more than 1000");
  expect_one_line(import("shots.csv", "Ball Speed [mps],Launch Angle [deg]" + repeated(",x", kDeep) + "\n" +
                                          repeated("1,2\n", kDeep)),
                  "100002 names and 100000 rows, more than 1000");

  write(dir / "case.toml",
        "kind = \"loop\"\n[model]\nbase = \"rigid-planar\"\n[head]\nmass_kg = 0.2\n[data]\nshots = \"table.csv\"\n");
  write(dir / "table.csv", "club_speed_mps" + repeated(",x", kDeep) + "\n");
  expect_one_line(command("run " + dir.string() + " --out " + (dir / "out").string()),
                  "table.csv:1: 100001 columns, more than 10000");
}

}  // namespace
