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
        "kind = \"study\"\ncase = \"../blow\"\n[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [40.0]\n");
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

TEST(Bounds, NumbersOfPointsAndVariants) {
  const fs::path dir = fresh_directory("many");
  const auto check = [&](const std::string& name, const std::string& text) {
    write(dir / name / "case.toml", text);
    return command("check " + (dir / name).string());
  };
  std::string grid = study_of_blow();
  grid.replace(grid.find("[\"rigid-eccentric\"]"), 19, "[\"rigid-eccentric\", \"stick-slip\"]");
  // 65536^4 is 2^64, which is none.
  for (const char* key : {"impact_toe_mm", "impact_high_mm", "dynamic_loft_deg", "club_path_deg"})
    grid += std::string("[[axis]]\nkey = \"delivery.") + key + "\"\nrange = [1.0, 2.0]\ncount = 65536\n";
  expect_one_line(check("grid", grid), "the design has more than 100000 points");

  std::string many = study_of_blow();
  for (int i = 0; i < 3000; ++i) many += "[[variant]]\nname = \"" + std::to_string(i) + "\"\n";
  expect_one_line(check("variants", many), "variant: more than 1000");

  // The names that come near a name are looked for among names, not among texts of any length.
  std::string named = study_of_blow();
  named += "[compare]\nwith = \"variant\"\nvariant = \"" + std::string(300'000, 'a') + "\"\n";
  named += "[[variant]]\nname = \"" + std::string(300'000, 'b') + "\"\n";
  EXPECT_EQ(check("names", named).status, 2);

  // A sweep of a sweep: each counts, and all together.
  const std::string sample = "[sample]\npoints = 400\nseed = 1\n[[axis]]\nrange = [40.0, 50.0]\nkey = ";
  write(dir / "blow/case.toml", kEccentricBlow);
  write(dir / "inner/case.toml", "kind = \"study\"\ncase = \"../blow\"\n" + sample + "\"delivery.club_speed_mps\"\n");
  const Outcome o = check("outer",
                          "kind = \"study\"\ncase = \"../inner\"\n[sample]\npoints = 400\nseed = 1\n"
                          "[[axis]]\nkey = \"sample.seed\"\nrange = [1.0, 2.0]\n");
  EXPECT_EQ(o.status, 2) << o.text;
}

TEST(Bounds, WhatNoShaftSwingOrBallHas) {
  const auto refused = [](const std::string& arguments, const std::string& says) {
    const fs::path out = fresh_directory("no_such") / "out";
    const Outcome o = command("run " + arguments + " --quiet --out " + out.string());
    expect_one_line(o, says);
    EXPECT_FALSE(fs::exists(out / "summary.json"));
  };
  refused("loop-bench --set 'shaft.table.bending_stiffness_N_m2=[1e300,1e300]'", "EI [N m2] is 1e+300 at 0 m");
  refused("shaft-modes --set shaft.bending_scale=1e300", "EI [N m2] is ");
  refused("frequency-machine --set support=free", "clamped_length_mm: a free butt is in no clamp");
  refused("ball-modes --set harmonics=[1.5]", "harmonics: whole numbers are wanted");
  refused("loop-flights --set flight.tolerance=1e-9", "tolerance: unknown key");
  refused("shaft-modes --set shaft.mass_scale=1e300", "the mass per length [kg/m] is ");
  refused("swing-driver --set motion.smoothing_ms=1e-9", "too few samples between its knots");
  refused("swing-driver --set solution.step_ms=1e-300", "solution.step_ms: 1e-300 is out of range");
  const fs::path dir = fresh_directory("drives");
  const std::string flight =
      "kind = \"study\"\noutputs = [\"carry_m\"]\n[[variant]]\nname = \"a\"\n[launch]\nball_speed_mps = 77\n"
      "launch_angle_deg = 10\nspin_rate_rpm = 2600\n[flight]\nlaw = \"table\"\ncoefficients = \"c.csv\"\n"
      "spin_decay_per_s = 0.04\n";
  const auto table = [](const std::string& drag) {
    return "reynolds,spin_ratio,drag,lift\n1e4,0," + drag + ",0\n1e4,1,0.2,0\n3e5,0,0.2,0\n3e5,1,0.2,0\n";
  };
  write(dir / "case.toml", flight);
  write(dir / "c.csv", table("-0.05"));
  refused(dir.string(), "drag coefficients lie between 0 and 5");
  write(dir / "c.csv", table("0.2x"));
  refused(dir.string(), "c.csv:2: drag '0.2x' is no number");
  write(dir / "c.csv", table("0.2"));
  EXPECT_EQ(command("check " + dir.string()).status, 0);
}

}  // namespace
