// What a run reads is what its results are of, and what it writes is its own: nothing mixed, nothing overwritten,
// nothing lost without a word.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "child.hpp"
#include "command.hpp"
#include "golf/units.hpp"
#include "post/csv.hpp"

namespace hosel::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json summary(const fs::path& out) { return json::parse(content(out / "summary.json")); }

/// Status 124 where the command waits for something that does not come: what it does takes a second.
Outcome unless_it_waits(const std::string& arguments) {
  return shell("timeout 300 " + hosel_command() + " " + arguments);
}

/// A shaft of two stations; the butt's stiffness is what the tests change.
std::string shaft_csv(double butt) {
  return fmt::format(
      "arc_length_mm,bending_stiffness_N_m2,torsional_stiffness_N_m2,mass_per_length_g_per_m,mean_radius_mm\n"
      "0,{},{},70,7\n1100,20,20,50,4.5\n",
      butt, butt);
}

/// A coarse blow with a club whose shaft is a CSV beside it.
void write_club_case(const fs::path& dir, double butt) {
  write(dir / "shaft.csv", shaft_csv(butt));
  write(dir / "case.toml", R"(kind = "impact"
models = ["fe-full-club"]
accuracy = "look"
error_estimate = false
[delivery]
club_speed_mps = 50.0
dynamic_loft_deg = 10.0
impact_toe_mm = 20.0
[head]
mass_kg = 0.2
cg_mm = [-35.0, 0.0, 4.0]
inertia_kg_m2 = [[2.0e-4, 0, 0], [0, 3.0e-4, 0], [0, 0, 4.5e-4]]
[shaft]
damping_ratio = 0.01
damping_frequency_Hz = 1000
[shaft.table]
file = "shaft.csv"
[hosel]
position_mm = [-15.0, 55.0, 10.0]
lie_deg = 58.0
lean_deg = 10.0
[contact]
face_friction = 0.4
[mesh]
harmonics = 2
antisymmetric = 2
[output]
steps_per_frame = 1
)");
}

TEST(Inputs, ABlowDoesNotGoOnWithAnotherShaftsCheckpoint) {
  const fs::path dir = fresh_directory("shaft_changed"), out = dir / "out";
  write_club_case(dir / "case", 60);
  const std::string run = "run " + (dir / "case").string() + " --quiet --out " + out.string();
  Child begun(hosel_command() + " " + run);
  ASSERT_TRUE(begun.until([&] { return fs::exists(out / "vtk/ball/ball_0012.vtu"); }));
  const int status = begun.end(SIGTERM);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_EQ(WEXITSTATUS(status), 143);
  ASSERT_TRUE(fs::exists(out / "checkpoint.cbor"));
  write_club_case(dir / "case", 25);
  ASSERT_EQ(command(run).status, 0);
  ASSERT_EQ(command("run " + (dir / "case").string() + " --quiet --out " + (dir / "afresh").string()).status, 0);
  const json mixed = summary(out), right = summary(dir / "afresh");
  EXPECT_EQ(mixed, right);
  EXPECT_EQ(content(out / "log.txt").find("goes on from"), std::string::npos);
}

/// A map whose variant alone names a file.
void write_map_case(const fs::path& dir, double butt) {
  write(dir / "shaft.csv", shaft_csv(butt));
  std::string text = study_of_blow();
  text.replace(text.find("[\"rigid-eccentric\"]"), 19, "[\"shaft-coupled\"]");
  write(dir / "case.toml", text + R"([volumetric]
published = "driver"
[grid]
columns = 3
rows = 3
[shaft]
name = "composite-driver"
[hosel]
position_mm = [-15.0, 55.0, 10.0]
lie_deg = 58.0
[[variant]]
name = "own shaft"
set = ["shaft={table={file=\"shaft.csv\"}}"]
)");
}

TEST(Inputs, AMapTakesNoPointsOfAnotherShaft) {
  const fs::path dir = fresh_directory("map_changed");
  write_map_case(dir / "case", 60);
  const std::string out = (dir / "out").string();
  ASSERT_EQ(command("sweep plan " + (dir / "case").string() + " --out " + out).status, 0);
  ASSERT_EQ(command("sweep run " + out + " --shard 1/2 --quiet").status, 0);
  write_map_case(dir / "case", 25);
  const Outcome second = command("sweep run " + out + " --shard 2/2 --quiet");
  expect_refused(second, "has changed since it was planned");
  EXPECT_EQ(command("sweep merge " + out + " --quiet").status, 2);
  // Nor without a plan.
  const Outcome run = command("run " + (dir / "case").string() + " --quiet --out " + out);
  expect_refused(run, "holds points of another case");
}

TEST(Inputs, ShardsOfASweepAreOfOneTable) {
  const fs::path dir = fresh_directory("sweep_changed");
  write(dir / "club/shaft.csv", shaft_csv(60));
  write(dir / "club/case.toml",
        kEccentricBlow +
            "[volumetric]\npublished = \"driver\"\n[shaft.table]\nfile = \"shaft.csv\"\n[hosel]\n"
            "position_mm = [-15.0, 55.0, 10.0]\nlie_deg = 58.0\n");
  write(dir / "sweep/case.toml",
        "kind = \"study\"\ncase = \"../club\"\nset = ['models=[\"shaft-coupled\"]']\n"
        "[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [40.0, 41.0, 42.0]\n");
  const std::string out = (dir / "out").string();
  const Outcome planned = command("sweep plan " + (dir / "sweep").string() + " --out " + out);
  ASSERT_EQ(planned.status, 0) << planned.text;
  ASSERT_EQ(command("sweep run " + out + " --shard 1/2 --quiet").status, 0);
  write(dir / "club/shaft.csv", shaft_csv(25));
  EXPECT_EQ(command("sweep run " + out + " --shard 2/2 --quiet").status, 2);
  write(dir / "club/shaft.csv", shaft_csv(60));
  EXPECT_EQ(command("sweep run " + out + " --shard 2/2 --quiet").status, 0) << "the same content is the same input";
  EXPECT_EQ(command("sweep merge " + out + " --quiet").status, 0);
}

TEST(Inputs, AreNotOverwritten) {
  const fs::path dir = fresh_directory("own_folder");
  write(dir / "case/case.toml", kEccentricBlow);
  const std::string before = content(dir / "case/case.toml");
  // OUT is the case's folder: what a case names there could have the name of an output.
  for (const std::string& out : {(dir / "case").string(), dir.string()}) {
    const Outcome o = command("run " + (dir / "case").string() + " --quiet --force --out " + out);
    expect_refused(o, "would write over what it reads");
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(dir / "case"), {}), 1);
  // A log replaces a log, and nothing else.
  const std::string run = "run " + (dir / "case").string() + " --quiet --force --out " + (dir / "out").string();
  write(dir / "thesis.tex", "years");
  for (const fs::path& file : {dir / "case/case.toml", dir / "thesis.tex"}) {
    const Outcome o = command(run + " --log " + file.string());
    expect_refused(o, "no log of a run");
  }
  EXPECT_EQ(content(dir / "case/case.toml"), before);
  EXPECT_EQ(content(dir / "thesis.tex"), "years");
  for (int again = 0; again < 2; ++again) {
    const Outcome o = command(run + " --log " + (dir / "own.log").string());
    EXPECT_EQ(o.status, 0) << o.text;
  }
  EXPECT_EQ(content(dir / "own.log"), content(dir / "out/log.txt"));
}

TEST(OwnFiles, WhatIsLinkedToAFileOfOutIsUntouched) {
  const fs::path dir = fresh_directory("hard_links"), out = dir / "out";
  std::string map = kEccentricBlow;
  map.replace(map.find("\"impact\""), 8,
              "\"study\"\noutputs = [\"ball_speed_mps\", \"azimuth_deg\", \"backspin_rpm\", \"sidespin_rpm\", "
              "\"spin_axis_deg\"]");
  write(dir / "case/case.toml", map + "[grid]\ncolumns = 3\nrows = 3\n");
  const std::string run = "run " + (dir / "case").string() + " --quiet --force --out " + out.string();
  ASSERT_EQ(command(run).status, 0);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(out))
    if (entry.is_regular_file()) files.push_back(entry.path());
  ASSERT_GT(files.size(), 20u) << "log, lock, points, table, series, script, pictures";
  // A victim under the name of every file that a run leaves.
  for (std::size_t i = 0; i < files.size(); ++i) {
    const fs::path victim = dir / fmt::format("victim_{}", i);
    write(victim, "years");
    fs::remove(files[i]);
    fs::create_hard_link(victim, files[i]);
  }
  const Outcome o = command(run);
  EXPECT_EQ(o.status, 0) << o.text;
  for (std::size_t i = 0; i < files.size(); ++i)
    EXPECT_EQ(content(dir / fmt::format("victim_{}", i)), "years") << files[i];
  EXPECT_TRUE(fs::exists(out / "summary.json"));
}

TEST(OwnFiles, APipeIsWaitedForByNobody) {
  const fs::path dir = fresh_directory("pipes"), out = dir / "out";
  write(dir / "case/case.toml", kEccentricBlow);
  const std::string run = "run " + (dir / "case").string() + " --quiet --force --out " + out.string();
  ASSERT_EQ(command(run).status, 0);
  const auto pipe_at = [](const fs::path& file) {
    fs::remove(file);
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  };
  pipe_at(out / "log.txt");
  EXPECT_EQ(unless_it_waits(run).status, 0);
  EXPECT_TRUE(fs::is_regular_file(out / "log.txt"));
  for (const char* name : {"history.csv", "report.html", "case.resolved.toml"}) {
    pipe_at(out / name);
    EXPECT_EQ(unless_it_waits(run).status, 0) << name;
    fs::remove(out / name);
  }
  pipe_at(out / ".lock");
  EXPECT_EQ(unless_it_waits(run).status, 2);
  fs::remove(out / ".lock");
  pipe_at(dir / "log");
  EXPECT_EQ(unless_it_waits(run + " --log " + (dir / "log").string()).status, 2);
  ASSERT_EQ(command(run).status, 0);
  for (const char* name : {"summary.json", "case.resolved.toml"}) {
    fs::remove_all(dir / "other");
    fs::copy(out, dir / "other", fs::copy_options::recursive);
    pipe_at(dir / "other" / name);
    const Outcome o = unless_it_waits("diff " + out.string() + " " + (dir / "other").string());
    EXPECT_EQ(o.status, 2) << name << ": " << o.text;
  }
}

TEST(OwnFiles, AGnuplotAmongTheFilesOfARunIsNotStarted) {
  const fs::path dir = fresh_directory("own_gnuplot"), out = dir / "out";
  write(dir / "case/case.toml", R"(kind = "material-point"
[material]
young_MPa = 100.0
poisson = 0.4
[path]
kind = "shear"
shear = 0.1
duration_ms = 1.0
)");
  for (const fs::path& place : {out, out / "bin", dir}) {
    write(place / "gnuplot", "#!/bin/sh\ntouch " + (dir / "executed").string() + "\n");
    fs::permissions(place / "gnuplot", fs::perms::owner_all);
  }
  const std::string run = hosel_command() + " run " + (dir / "case").string() + " --quiet --force --out " +
                          out.string();
  for (const std::string& path : {std::string("."), out.string(), (out / "bin").string(), std::string("")}) {
    const Outcome o = shell("cd " + dir.string() + " && PATH=" + path + ":$PATH " + run);
    EXPECT_EQ(o.status, 0) << o.text;
    EXPECT_FALSE(fs::exists(dir / "executed")) << "PATH begins with '" << path << "'";
    EXPECT_TRUE(fs::exists(out / "curve.png")) << "the one that is installed is found";
    fs::remove(out / "curve.png");
  }
  // None at all: said, even to a quiet person, on the page and in the summary.
  const Outcome none = shell("PATH=. " + run);
  EXPECT_EQ(none.status, 0);
  EXPECT_NE(none.text.find("no picture: gnuplot is not installed"), std::string::npos) << none.text;
  EXPECT_NE(summary(out).dump().find("no picture"), std::string::npos);
  EXPECT_NE(content(out / "report.html").find("no picture"), std::string::npos);
}

TEST(OwnFiles, ADirectoryThatGoesAwayIsNoFinishedRun) {
  const fs::path dir = fresh_directory("gone");
  write_club_case(dir / "case", 60);
  const auto run = [&](const fs::path& out) {
    return "run " + (dir / "case").string() + " --quiet --out " + out.string();
  };
  // A folder of OUT, all of OUT, or its name, while the run is at work.
  for (const char* what : {"rm -rf OUT/vtk/ball", "rm -rf OUT/vtk", "rm -rf OUT", "mv OUT OUT.moved"}) {
    const fs::path out = dir / "out";
    fs::remove_all(out);
    fs::remove_all(dir / "out.moved");
    std::string act = what;
    for (std::size_t at; (at = act.find("OUT")) != std::string::npos;) act.replace(at, 3, out.string());
    // A run that ends without that frame is waited for no longer.
    const Outcome o = shell(hosel_command() + " " + run(out) + " & pid=$!; while [ ! -e " + out.string() +
                            "/vtk/ball/ball_0006.vtu ] && kill -0 $pid; do sleep 0.01; done; " + act + "; wait $pid");
    EXPECT_NE(o.status, 0) << what << ": " << o.text;
    EXPECT_NE(o.text.find("hosel: "), std::string::npos) << what << ": " << o.text;
  }
}

/// A run that found no room, and went on when there was some, tells what one tells that always had room.
TEST(OwnFiles, APageAfterAFullDiskIsThatOfARunWithRoom) {
  const fs::path dir = fresh_directory("full_and_grown");
  write_club_case(dir / "case", 60);
  const auto run = [&](const fs::path& out, const std::string& before) {
    fs::create_directories(dir / "at");
    // The same word for OUT in every run: it stands on the page.
    const Outcome o = shell("cd " + (dir / "at").string() + "; " + before + hosel_command() + " run " +
                            (dir / "case").string() + " --quiet --out " + out.string());
    return o;
  };
  const auto page = [&](const fs::path& out) {
    std::string text = content(dir / "at" / out / "report.html");
    const std::size_t at = text.find(" UTC");  // when it was made
    return at == std::string::npos ? text : text.erase(at - 16, 16);
  };
  ASSERT_EQ(run("out", "").status, 0);
  const std::string whole = page("out");
  ASSERT_GT(whole.size(), 1000u);
  int grown = 0;
  for (const int blocks : {2, 48, 192, 384}) {
    fs::remove_all(dir / "at/out");
    const Outcome full = run("out", fmt::format("ulimit -f {}; ", blocks));
    if (full.status == 0) continue;
    EXPECT_EQ(full.status, 1) << full.text;
    EXPECT_EQ(std::ranges::count(full.text, '\n'), 1) << full.text;
    ASSERT_EQ(run("out", "").status, 0) << blocks;
    EXPECT_EQ(page("out"), whole) << blocks << " blocks";
    ++grown;
  }
  EXPECT_GE(grown, 2);
}

/// A gnuplot that cannot draw costs the pictures and nothing else: said, on the page and in the summary; status 0.
TEST(OwnFiles, AGnuplotThatFailsIsSaid) {
  const fs::path dir = fresh_directory("bad_gnuplot"), out = dir / "out";
  write(dir / "case/case.toml", study_of_blow() + "[grid]\ncolumns = 3\nrows = 3\n");
  for (const char* fails : {"exit 1", "exit 0", "kill -9 $$"}) {
    write(dir / "bin/gnuplot", std::string("#!/bin/sh\n") + fails + "\n");
    fs::permissions(dir / "bin/gnuplot", fs::perms::owner_all);
    const Outcome o = shell("PATH=" + (dir / "bin").string() + ":$PATH " + hosel_command() + " run " +
                            (dir / "case").string() + " --quiet --force --out " + out.string());
    EXPECT_EQ(o.status, 0) << fails << ": " << o.text;
    EXPECT_NE(o.text.find("no picture: gnuplot could not draw"), std::string::npos) << fails << ": " << o.text;
    EXPECT_NE(summary(out).dump().find("no picture"), std::string::npos) << fails;
    EXPECT_NE(content(out / "report.html").find("no picture"), std::string::npos) << fails;
    EXPECT_TRUE(fs::exists(out / "map.csv") || !fs::is_empty(out)) << fails;
  }
}

TEST(Tables, NamesAreCellsWhateverStandsInThem) {
  const fs::path dir = fresh_directory("names");
  const std::vector<std::string> names = {"7-iron, \"soft\"",
                                          "=1+1",
                                          "@SUM(A1)",
                                          "+cmd",
                                          "-cmd",
                                          "a b",
                                          "a_b",
                                          "]]> & <b>",
                                          "&#x0; x",
                                          std::string(200, 'n'),
                                          "\xC3\xA9t\xC3\xA9"};
  std::string flight =
      "kind = \"study\"\noutputs = [\"carry_m\"]\n[launch]\nball_speed_mps = 60.0\nlaunch_angle_deg = 12.0\n"
      "backspin_rpm = 2500.0\n[flight]\n[[flight.launch_error]]\nsource = \"radar\"\nball_speed_mps = 0.1\n";
  std::string variants = study_of_blow();
  for (const std::string& n : names) {
    const std::string quoted = "'''" + n + "'''";
    flight += "[[variant]]\nname = " + quoted + "\n";
    variants += "[[variant]]\nname = " + quoted + "\nset = [\"delivery.club_speed_mps=44.0\"]\n";
  }
  write(dir / "flight/case.toml", flight);
  write(dir / "variants/case.toml", variants);
  for (const auto& [kind, table] : {std::pair{"flight", "flights.csv"}, {"variants", "points.csv"}}) {
    const fs::path out = dir / kind / "../out" / kind;
    const Outcome o = command("run " + (dir / kind).string() + " --quiet --out " + out.string());
    ASSERT_EQ(o.status, 0) << kind << ": " << o.text;
    const post::Sheet sheet = post::read_csv(out / table);
    const auto named = std::ranges::find(sheet.names, std::string(kind) == "flight" ? sheet.names[0] : "variant");
    ASSERT_NE(named, sheet.names.end());
    const std::vector<std::string>& cells = sheet.columns[std::size_t(named - sheet.names.begin())];
    std::set<std::string> seen(cells.begin(), cells.end());
    EXPECT_EQ(seen.size(), names.size()) << kind;
    for (const std::string& cell : cells)
      EXPECT_EQ(std::string_view("=@+-").find(cell.front()), std::string_view::npos) << cell;
    for (std::size_t i = 0; i < names.size(); ++i)
      EXPECT_TRUE(cells[i] == names[i] || cells[i] == "'" + names[i]) << names[i];
    if (std::string(kind) != "flight") continue;
    EXPECT_EQ(summary(out).at("launches").size(), names.size()) << kind;
    std::size_t series = 0, pictures = 0;
    for (const auto& entry : fs::directory_iterator(out / "vtk")) series += entry.path().extension() == ".pvd";
    for (const auto& entry : fs::recursive_directory_iterator(out / "figures")) {
      pictures += entry.path().extension() == ".png";
      if (entry.path().extension() != ".svg") continue;
      EXPECT_EQ(shell("xmllint --noout " + entry.path().string() +
                      " 2>/dev/null || python3 -c 'import sys, "
                      "xml.dom.minidom as m; m.parse(sys.argv[1])' " +
                      entry.path().string())
                    .status,
                0)
          << entry.path() << " is well-formed";
    }
    EXPECT_EQ(series, names.size()) << "a series of each";
    EXPECT_EQ(pictures, names.size() + 2) << "a picture of each, one of all, and the study's own";
  }
}

TEST(Tables, TwoOfOneNameAreRefused) {
  const fs::path dir = fresh_directory("doubled");
  const auto refused = [&](const char* kind, const std::string& text) {
    write(dir / kind / "case.toml", text);
    const Outcome o = command("run " + (dir / kind).string() + " --quiet --out " + (dir / "out").string());
    EXPECT_EQ(o.status, 2) << kind << ": " << o.text;
    EXPECT_NE(o.text.find("is there twice"), std::string::npos) << kind << ": " << o.text;
  };
  std::string variants = study_of_blow();
  for (int k = 0; k < 2; ++k) variants += "[[variant]]\nname = \"soft\"\n";
  refused("variants", variants);
  std::string flight = "kind = \"study\"\noutputs = [\"carry_m\"]\n[flight]\n";
  for (int k = 0; k < 2; ++k) flight += "[[flight.launch_error]]\nsource = \"monitor\"\nball_speed_mps = 0.1\n";
  flight += "[launch]\nball_speed_mps = 60.0\nlaunch_angle_deg = 12.0\nbackspin_rpm = 2500.0\n";
  refused("flight", flight);
  std::string models = kEccentricBlow;
  models.replace(models.find("[\"rigid-eccentric\"]"), 19, "[\"rigid-eccentric\", \"rigid-eccentric\"]");
  refused("models", models);
  std::string sought = study_of_blow();
  sought += "[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = [40.0, 45.0]\n";
  for (int k = 0; k < 2; ++k)
    sought +=
        "[[solve]]\nname = \"loft\"\nkey = \"delivery.dynamic_loft_deg\"\nrange = [5, 40]\n"
        "output = \"launch_angle_deg\"\nvalue = 12\n";
  refused("sought", sought);
}

TEST(Terminal, WhatCannotBePrintedIsAnError) {
  const fs::path dir = fresh_directory("full_device");
  write(dir / "case/case.toml", kEccentricBlow);
  const std::string run = hosel_command() + " run " + (dir / "case").string() + " --force --out " +
                          (dir / "out").string();
  for (const std::string& line : {hosel_command() + " check " + (dir / "case").string(), hosel_command() + " help",
                                  hosel_command() + " man", hosel_command() + " list", run}) {
    const Outcome o = shell(line + " >/dev/full");
    EXPECT_EQ(o.status, 1) << line;
    EXPECT_NE(o.text.find("hosel: "), std::string::npos) << line << ": " << o.text;
  }
  // Streams that are closed are nobody's files.
  const Outcome closed = shell(run + " <&- >&- 2>&-");
  EXPECT_EQ(closed.status, 0);
  EXPECT_EQ(content(dir / "out/report.html").rfind("<!doctype html>", 0), 0u);
  EXPECT_EQ(shell("tail -c 8 " + (dir / "out/report.html").string()).text, "</html>\n");
  EXPECT_TRUE(json::accept(content(dir / "out/summary.json")));
}

TEST(Terminal, TextsOfACaseMoveNoCursor) {
  const fs::path dir = fresh_directory("escapes");
  write(dir / "case/case.toml",
        "kind = \"study\"\noutputs = [\"carry_m\"]\n[[variant]]\nname = \"a\\u001b[2Jb\\nc\\u0085d\\u2028e\\u202ef\"\n"
        "[launch]\nball_speed_mps = 60.0\nlaunch_angle_deg = 12.0\nbackspin_rpm = 2500.0\n"
        "[[flight.launch_error]]\nsource = \"radar\"\nball_speed_mps = 0.1\n");
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("a [2Jb c d e f"), std::string::npos) << o.text;
  for (const char* moves : {"\x1b", "\xC2\x85", "\xE2\x80\xA8", "\xE2\x80\xAE"})
    EXPECT_EQ(o.text.find(moves), std::string::npos);
}

TEST(Terminal, AMistakeIsOneLineOfAReadableLength) {
  const fs::path dir = fresh_directory("one_line");
  for (const std::string& value : {std::string(5000, 'x'), std::string("a\\nb"), std::string("a\\u2028b\\u0085c")}) {
    std::string text = kEccentricBlow;
    text.replace(text.find("\"impact\""), 8, '"' + value + '"');
    write(dir / "case/case.toml", text);
    const Outcome o = command("check " + (dir / "case").string());
    EXPECT_EQ(o.status, 2) << o.text;
    EXPECT_EQ(std::ranges::count(o.text, '\n'), 1) << o.text;
    EXPECT_LT(o.text.size(), 1100u);
    for (const char* moves : {"\xC2\x85", "\xE2\x80\xA8"}) EXPECT_EQ(o.text.find(moves), std::string::npos);
  }
  // Of names that no disk stores, and of bytes that are no text, likewise.
  for (const std::string& name : {std::string(300, 'n'), std::string(5000, 'n'), std::string("'\xFF\xFE'")}) {
    const Outcome o = command("run " + name);
    EXPECT_EQ(o.status, 2) << o.text;
    EXPECT_EQ(std::ranges::count(o.text, '\n'), 1) << o.text;
  }
}

TEST(Terminal, AnAddressLimitIsRefusedAndNotWaitedFor) {
  const std::string fe =
      " run driver-toe --set accuracy=look --set 'models=[\"fe-free-body\"]' --quiet --force --out " +
      (fresh_directory("address") / "out").string();
  for (const int megabytes : {100, 150, 200, 300, 400, 500}) {
    const Outcome o =
        shell(fmt::format("ulimit -v {}; timeout -s KILL 300 {}{}", 1000 * megabytes, hosel_command(), fe));
    EXPECT_EQ(o.status, 2) << megabytes << " MB: " << o.text;
    EXPECT_NE(o.text.find("address space"), std::string::npos) << o.text;
  }
}

/// Without friction a wall spins no ball. A head that is struck on its toe turns, and carries the flattened ball round
/// with it, the other way than gear effect: as fast as it turns, so with thrice the inertia a third. The answer says
/// so.
TEST(Impact, SpinWithoutFrictionIsThatOfTheHeadsTurn) {
  const fs::path dir = fresh_directory("frictionless");
  const auto spin = [&](const std::string& name, const std::string& head, bool warned) {
    const Outcome o = command(
        "run driver-toe --set 'models=[\"fe-free-body\"]' --set accuracy=look --set error_estimate=false --set "
        "output.vtk=false --set contact.face_friction=0 --set \"face={name='rigid'}\" --set \"head=" +
        head + "\" --out " + (dir / name).string());
    EXPECT_EQ(o.status, 0) << o.text;
    EXPECT_EQ(o.text.find("without friction the ball leaves with") != std::string::npos, warned) << o.text;
    const json launch = summary(dir / name).at("models").at("fe-free-body");
    return std::pair(launch.at("spin_rate_rpm").get<double>(), launch.at("sidespin_rpm").get<double>());
  };
  const auto head = [](const char* mass, double inertia) {
    return fmt::format("{{mass_kg={}, cg_mm=[-35,0,0], inertia_kg_m2=[[{},0,0],[0,{},0],[0,0,{}]]}}", mass, inertia,
                       inertia, inertia);
  };
  const auto light = spin("light", head("0.204", 3e-4), true), heavy = spin("heavy", head("0.204", 9e-4), true);
  EXPECT_GT(light.second, 0.8 * light.first);  // as an opening face turns
  EXPECT_GT(light.first, 30);
  // The mesh's own part, at "look", does not turn with the head.
  EXPECT_NEAR(heavy.first / light.first, 1.0 / 3, 0.15);
  EXPECT_LT(spin("wall", head("inf", 3e-4), false).first, 0.1);
}

/// Doubling a file changes no verdict, and an impossible number fills no screen.
TEST(Loop, RowsThatRepeatCountOnceAndAnImpossibleSpinIsOneRow) {
  const fs::path dir = fresh_directory("repeated");
  const std::string shipped = std::string(HOSEL_SOURCE_DIR) + "/cases/loop-irons";
  const auto report = [&](const std::string& name, const std::string& shots) {
    write(dir / name / "case.toml", content(shipped + "/case.toml"));
    write(dir / name / "club_means.csv", content(shipped + "/club_means.csv"));
    write(dir / name / "shots.csv", shots);
    const Outcome ran = command("run " + (dir / name).string() + " --out " + (dir / name / "out").string());
    EXPECT_EQ(ran.status, 0) << ran.text;
    return std::pair(json::parse(content(dir / name / "out" / "report.json")), ran.text);
  };
  const std::string text = content(shipped + "/shots.csv"), rows = text.substr(text.find('\n') + 1);
  auto [once, told_once] = report("once", text);
  auto [twice, told_twice] = report("twice", text + rows);
  EXPECT_NE(told_twice.find("36 rows of the shots repeat an earlier row"), std::string::npos) << told_twice;
  EXPECT_EQ(once["verdict"], twice["verdict"]);
  EXPECT_EQ(once["adopted"], twice["adopted"]);
  std::string wild = text;
  wild.replace(wild.find(",3875,"), 6, ",1e308,");
  const std::string told = report("wild", wild).second;
  EXPECT_LT(std::ranges::count(told, '\n'), std::ranges::count(told_once, '\n') + 20) << told;
}

/// The measured irons with their loft in radians, their columns and rows in another order and their clubs called
/// otherwise: the same verdict and names, from as many shots, by the same formulas of the instrument.
TEST(Loop, UnitsAndOrderChangeNoVerdict) {
  const fs::path dir = fresh_directory("loop_units");
  const std::string shipped = std::string(HOSEL_SOURCE_DIR) + "/cases/loop-irons";
  const post::Sheet plain = post::read_csv(shipped + "/shots.csv");
  const std::string means = content(shipped + "/club_means.csv");
  const auto report = [&](const std::string& name, const post::Sheet& shots, const std::string& clubs) {
    write(dir / name / "case.toml", content(shipped + "/case.toml"));
    write(dir / name / "club_means.csv", clubs);
    std::string text = fmt::format("{}\n", fmt::join(shots.names, ","));
    for (std::size_t i = 0; i < shots.rows(); ++i)
      for (std::size_t c = 0; c < shots.names.size(); ++c)
        text += shots.columns[c][i] + (c + 1 < shots.names.size() ? "," : "\n");
    write(dir / name / "shots.csv", text);
    const Outcome ran = command("run " + (dir / name).string() + " --quiet --out " + (dir / name / "out").string());
    EXPECT_EQ(ran.status, 0) << ran.text;
    const json told = json::parse(content(dir / name / "out" / "report.json"));
    json all = {{"verdict", told.at("verdict")}, {"adopted", told.at("adopted")}, {"flagged", json::array()}};
    for (const json& d : told.at("derived_columns")) {
      std::set<std::string> from;
      for (const std::string f : d.at("from")) from.insert(split_unit(f).stem);
      all["computed"].push_back(
          {split_unit(d.at("column").get<std::string>()).stem, from, d.at("rows"), d.at("share")});
    }
    for (const json& c : told.at("channels"))
      all["channels"].push_back(split_unit(c.at("name").get<std::string>()).stem);
    for (const json& c : told.at("columns")) all["columns"].push_back(c.at("finding"));
    for (const json& f : told.at("flagged_rows")) all["flagged"].push_back(f.at("finding"));
    return all;
  };
  const auto degrees = report("degrees", plain, means);
  ASSERT_EQ(degrees["verdict"], "ambiguous");
  ASSERT_FALSE(degrees["adopted"].empty());
  ASSERT_FALSE(degrees["computed"].empty());
  post::Sheet other = plain;
  for (std::size_t c = 0; c < other.names.size(); ++c)
    if (other.names[c] == "dynamic_loft_deg") {
      other.names[c] = "dynamic_loft_rad";
      for (std::string& cell : other.columns[c]) cell = fmt::format("{:.6f}", std::stod(cell) * std::acos(-1) / 180);
    }
  EXPECT_EQ(report("radians", other, means), degrees);
  std::ranges::reverse(other.names);
  std::ranges::reverse(other.columns);
  EXPECT_EQ(report("columns", other, means), degrees);
  for (auto& column : other.columns) std::ranges::reverse(column);
  EXPECT_EQ(report("rows", other, means), degrees);
  std::string renamed;  // "4i" is "Kurt 4i"
  for (std::size_t begin = 0, end; (end = means.find('\n', begin)) != std::string::npos; begin = end + 1)
    renamed += (begin ? "Kurt " : "") + means.substr(begin, end + 1 - begin);
  for (std::size_t c = 0; c < other.names.size(); ++c)
    if (other.names[c] == "club")
      for (std::string& cell : other.columns[c]) cell.insert(0, "Kurt ");
  EXPECT_EQ(report("names", other, renamed), degrees);
}

TEST(Shards, AreCountedFromOne) {
  for (const char* shard : {"-1/-1", "0/1", "2/1", "+1/2", "1/2x", "1/"}) {
    const Outcome o = command(std::string("sweep run nowhere --shard ") + shard);
    EXPECT_EQ(o.status, 2) << shard;
    EXPECT_NE(o.text.find("expected k/n"), std::string::npos) << o.text;
  }
}

}  // namespace
}  // namespace hosel::test
