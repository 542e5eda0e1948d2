// A case is data: whatever stands in its names, headers and paths, nothing of it is executed.
#include <gtest/gtest.h>

#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

/// A word of a shell's command line.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

TEST(Stranger, NamesOfVariantsAreNoGnuplot) {
  const fs::path dir = fresh_directory("stranger_variant"), mark = dir / "executed";
  std::string text = kEccentricBlow;
  text.replace(text.find("\"impact\""), 8, "\"face-map\"");
  text += "[grid]\ncolumns = 3\nrows = 3\n[[variants]]\nmodel = \"rigid-eccentric\"\nset = [\"head.mass_kg=0.25\"]\n";
  // A quote alone is doubled, so that what follows the line break must do without.
  text += "name = \"\"\"heavy\nsystem(\\\"touch " + mark.string() + "\\\")\n#\"\"\"\n";
  write(dir / "case.toml", text);
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 0) << o.text;
  EXPECT_TRUE(fs::exists(dir / "out/figures/map-rigid-eccentric.png"));
  std::size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(dir / "out/figures")) pictures += entry.path().extension() == ".png";
  EXPECT_GE(pictures, 3u) << "the stranger's map is drawn all the same";
  EXPECT_FALSE(fs::exists(mark));
}

TEST(Stranger, PathsAreNoGnuplot) {
  const fs::path dir = fresh_directory("stranger_path"), mark = dir / "executed";
  const fs::path out = dir / "a'\nsystem('touch executed')\n#";
  write(dir / "case.toml", R"(kind = "material-point"
[material]
young_MPa = 100.0
poisson = 0.4
[path]
kind = "shear"
shear = 0.1
duration_ms = 1.0
)");
  const Outcome o = command("run " + dir.string() + " --out " + quoted(out.string()));
  EXPECT_EQ(o.status, 0) << o.text;
  EXPECT_TRUE(fs::exists(out / "curve.png")) << o.text;
  EXPECT_FALSE(fs::exists("executed"));
  EXPECT_FALSE(fs::exists(out / "executed"));
  EXPECT_FALSE(fs::exists(mark));
  EXPECT_NE(content(out / "report.html")
                .find("hosel run &#39;" + dir.string() + "/a&#39;\\&#39;&#39;\nsystem(&#39;\\&#39;&#39;touch"),
            std::string::npos)
      << "the command that the page gives for copying is one word of a path";
}

TEST(Stranger, HeadersAreNoAttributesOfThePage) {
  const fs::path dir = fresh_directory("stranger_page");
  write(dir / "case.toml", R"(kind = "loop"
[model]
base = "rigid-planar"
[head]
mass_kg = 0.2
[data]
shots = "shots.csv"
)");
  std::string csv = "x' onload='alert(1),club_speed_mps,dynamic_loft_deg,ball_speed_mps,launch_angle_deg\n";
  for (int k = 0; k < 60; ++k) {
    char row[96];
    std::snprintf(row, sizeof row, "%d,%.1f,%.1f,%.1f,%.1f\n", k % 13, 40 + 0.1 * (k % 17), 10 + 0.1 * (k % 23),
                  57 + 0.1 * (k % 17) + 0.9 * (k % 13), 9 + 0.1 * (k % 23));
    csv += row;
  }
  write(dir / "shots.csv", csv);
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string page = content(dir / "out/report.html");
  EXPECT_NE(page.find("onload=&#39;alert"), std::string::npos) << "the header is on the page";
  EXPECT_EQ(page.find("onload='"), std::string::npos);
}

TEST(Stranger, PathsOfAJobArrayAreNoShell) {
  const fs::path dir = fresh_directory("stranger_slurm"),
                 out = dir / "o'$(touch executed)`touch executed`;touch executed;'";
  fs::create_directories(out);
  const auto script = [&](const char* name, const std::string& text) {
    write(dir / name, "#!/bin/sh\n" + text);
    fs::permissions(dir / name, fs::perms::owner_all);
  };
  // In Slurm's place: runs the wrapped text as Slurm does, with /bin/sh.
  script("sbatch", "for a; do case $a in --wrap=*) cd " + quoted(dir.string()) +
                       "; SLURM_ARRAY_TASK_ID=1 sh -c \"${a#--wrap=}\" >&2;; esac; done; echo 7\n");
  script("hosel", "for a; do printf '%s\\n' \"$a\"; done >> " + quoted((dir / "arguments").string()) + "\n");
  const std::string array = std::string(HOSEL_SOURCE_DIR) + "/scripts/slurm-array ";
  ASSERT_EQ(std::system(("PATH=" + dir.string() + ":$PATH " + array + quoted(out.string()) + " 3 >/dev/null").c_str()),
            0);
  const std::string arguments = content(dir / "arguments");
  EXPECT_NE(arguments.find("sweep\nrun\n" + out.string() + "\n--shard\n1/3\n"), std::string::npos) << arguments;
  EXPECT_NE(arguments.find("sweep\nmerge\n" + out.string() + "\n--force\n"), std::string::npos) << arguments;
  EXPECT_FALSE(fs::exists(dir / "executed"));
  EXPECT_NE(
      std::system(("PATH=" + dir.string() + ":$PATH " + array + quoted(out.string()) + " '3;x' 2>/dev/null").c_str()),
      0);
}

}  // namespace
