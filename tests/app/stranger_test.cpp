// A case is data: whatever stands in its names, headers and paths, nothing of it is executed, and nothing outside OUT
// is written.
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
  std::string text = study_of_blow();
  text += "[grid]\ncolumns = 3\nrows = 3\n[[variant]]\nname = \"own\"\n[[variant]]\nset = [\"head.mass_kg=0.25\"]\n";
  // A quote alone is doubled, so that what follows the line break must do without.
  text += "name = \"\"\"heavy\nsystem(\\\"touch " + mark.string() + "\\\")\n#\"\"\"\n";
  write(dir / "case.toml", text);
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  EXPECT_EQ(o.status, 0) << o.text;
  EXPECT_TRUE(fs::exists(dir / "out/figures/map-own.png"));
  std::size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(dir / "out/figures")) pictures += entry.path().extension() == ".png";
  EXPECT_GE(pictures, 2u) << "the stranger's map is drawn all the same";
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

/// A case that brings its OUT along, in which something points at what is not the run's.
TEST(Stranger, LinksInOutLeadNowhere) {
  const fs::path dir = fresh_directory("stranger_link"), victim = dir / "victim", out = dir / "out";
  write(dir / "blow/case.toml", kEccentricBlow);
  const auto refused = [&](const fs::path& link, const fs::path& target, const std::string& arguments) {
    fs::remove_all(victim);
    write(victim / "thesis.tex", "years");
    fs::create_directories(link.parent_path());
    fs::create_symlink(target, link);
    const Outcome o = command(arguments);
    expect_refused(o, link.filename().string() + ": a link");
    EXPECT_EQ(content(victim / "thesis.tex"), "years") << link;
    EXPECT_EQ(std::distance(fs::directory_iterator(victim), {}), 1) << link;
    fs::remove(link);
  };
  const std::string run = "run " + (dir / "blow").string() + " --quiet --out " + out.string();
  for (const char* name : {".lock", "log.txt", "figures/map.png"}) refused(out / name, victim / "thesis.tex", run);
  for (const char* name : {"vtk", "vtk/ball", "figures"}) {
    fs::remove_all(out);
    refused(out / name, victim, run);
  }
  fs::remove_all(out);
  EXPECT_EQ(command(run).status, 0);

  write(dir / "sweep/case.toml",
        "kind = \"study\"\ncase = \"../blow\"\n[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [40.0]\n");
  const std::string swept = (dir / "swept").string();
  ASSERT_EQ(command("sweep plan " + (dir / "sweep").string() + " --out " + swept).status, 0);
  refused(dir / "swept/shards/1-of-1/points.jsonl", victim / "thesis.tex", "sweep run " + swept + " --quiet");
  fs::remove_all(dir / "swept/shards");
  refused(dir / "swept/shards", victim, "sweep run " + swept + " --quiet");
  EXPECT_EQ(command("sweep run " + swept + " --quiet").status, 0);

  // Where nobody named OUT: in the working directory, which may be the stranger's too.
  const auto at_home = [&] {
    return std::system(("cd " + dir.string() + " && " + HOSEL_COMMAND + " run blow --quiet >/dev/null 2>&1").c_str());
  };
  for (const fs::path& link : {out, out / "blow"}) {
    fs::remove_all(out);
    if (link != out) fs::create_directories(out);
    fs::create_directory_symlink(victim, link);
    EXPECT_EQ(WEXITSTATUS(at_home()), 2) << link;
    EXPECT_EQ(std::distance(fs::directory_iterator(victim), {}), 1) << link;
  }
  // Who names a link means what it points at.
  fs::create_directory_symlink(dir / "elsewhere", dir / "named");
  fs::create_directories(dir / "elsewhere");
  EXPECT_EQ(command("run " + (dir / "blow").string() + " --quiet --out " + (dir / "named").string()).status, 0);
  EXPECT_TRUE(fs::exists(dir / "elsewhere/summary.json"));
}

TEST(Stranger, ACaseIsNotCopiedIntoItself) {
  const fs::path dir = fresh_directory("stranger_copy");
  write(dir / "mine/case.toml", kEccentricBlow);
  const Outcome o = command("new " + (dir / "mine/variant").string() + " --from " + (dir / "mine").string());
  expect_refused(o, "lies in what is copied");
  EXPECT_FALSE(fs::exists(dir / "mine/variant"));
  fs::create_directory_symlink(".", dir / "mine/again");
  const Outcome endless = command("new " + (dir / "copy").string() + " --from " + (dir / "mine").string());
  expect_refused(endless, "cannot be copied");
  EXPECT_FALSE(fs::exists(dir / "copy"));
}

}  // namespace
