// What the command says of itself, and what it does with finished runs.
#include <gtest/gtest.h>
#include <regex>

#include <nlohmann/json.hpp>

#include "app/cases.hpp"
#include "app/terminal.hpp"
#include "command.hpp"

namespace hosel::test {
namespace {

namespace fs = std::filesystem;

std::string bash(const std::string& script) {
  const fs::path file = fresh_directory("bash") / "script";
  write(file, script);
  FILE* pipe = popen(("bash '" + file.string() + "' 2>&1").c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer;
  while (fgets(buffer.data(), int(buffer.size()), pipe)) text += buffer.data();
  pclose(pipe);
  return text;
}

/// What bash offers behind these words.
std::string completed(const std::string& words, int at) {
  return bash("source <(" HOSEL_COMMAND " completion)\nCOMP_WORDS=(" + words + ")\nCOMP_CWORD=" + std::to_string(at) +
              "\n_hosel\necho \"${COMPREPLY[@]}\"\n");
}

TEST(CommandLine, CompletesCommandsOptionsAndCases) {
  EXPECT_EQ(completed("hosel ch", 1), "check\n");
  EXPECT_EQ(completed("hosel run driver-t", 2), "driver-toe\n");
  EXPECT_EQ(completed("hosel run driver-toe --fo", 3), "--force\n");
  EXPECT_EQ(completed("hosel sweep run x --sh", 4), "--shard\n");
  EXPECT_EQ(completed("hosel keys landing-t", 2), "landing-times\n");
}

TEST(CommandLine, AMistypedCommandIsNamed) {
  for (const char* typed : {"runn iron7-trackman", "help runn"}) {
    const Outcome o = command(typed);
    EXPECT_EQ(o.status, 2);
    EXPECT_NE(o.text.find("no command 'runn'; did you mean 'run'?"), std::string::npos) << o.text;
  }
}

TEST(CommandLine, ManPageNamesEveryCommand) {
  const std::string page = command("man").text;
  EXPECT_TRUE(page.starts_with(".TH HOSEL 1")) << page.substr(0, 200);
  for (const char* name : {"run CASE", "check CASE", "sweep plan CASE", "import FILE", "diff A B", "keys [OF]"})
    EXPECT_NE(page.find(std::string(".SS hosel ") + name), std::string::npos) << name;
  EXPECT_NE(page.find("\\-\\-strict"), std::string::npos);
}

TEST(CommandLine, DiffNamesInputsAndLaunches) {
  const fs::path home = fresh_directory("diff"), blow = home / "blow";
  write(blow / "case.toml", kEccentricBlow);
  const auto run = [&](const std::string& name, const std::string& more) {
    const Outcome o = command("run '" + blow.string() + "' --quiet --out '" + (home / name).string() + "' " + more);
    ASSERT_EQ(o.status, 0) << o.text;
  };
  run("a", "");
  run("b", "--set delivery.club_speed_mps=46");
  run("c", "");
  const auto diff = [&](const std::string& one, const std::string& other) {
    return command("diff '" + (home / one).string() + "' '" + (home / other).string() + "'");
  };
  const Outcome moved = diff("a", "b"), same = diff("a", "c");
  EXPECT_EQ(moved.status, 0) << moved.text;
  EXPECT_NE(moved.text.find("delivery.club_speed_mps"), std::string::npos) << moved.text;
  EXPECT_NE(moved.text.find("rigid-eccentric ball_speed_mps"), std::string::npos) << moved.text;
  EXPECT_NE(moved.text.find("beyond"), std::string::npos) << moved.text;
  EXPECT_EQ(moved.text.find("dynamic_loft"), std::string::npos) << moved.text;
  EXPECT_EQ(moved.text.find("e-1"), std::string::npos) << "digits of arithmetic: " << moved.text;
  // Inputs in the digits that were stated; errors in two digits without an exponent.
  run("d", "--set delivery.impact_toe_mm=0.7 --set delivery.club_speed_mps=46.1");
  const Outcome stated = diff("a", "d");
  EXPECT_NE(stated.text.find(" 0.7\n"), std::string::npos) << stated.text;
  EXPECT_NE(stated.text.find(" 46.1\n"), std::string::npos) << stated.text;
  EXPECT_FALSE(std::regex_search(stated.text, std::regex("e\\+0[0-9] +(beyond|within)"))) << stated.text;
  EXPECT_NE(same.text.find("inputs\n  the same\nlaunches\n  the same"), std::string::npos) << same.text;
  EXPECT_EQ(same.text.find("beyond"), std::string::npos) << same.text;
  // A value in another unit is the same value.
  std::string text = kEccentricBlow;
  text.replace(text.find("mass_kg = 0.2"), 13, "mass_g = 200")
      .replace(text.find("cg_mm = [-35.0"), 14, "cg_m = [-0.035");
  write(blow / "case.toml", text);
  run("grams", "");
  run("heavier", "--set head.mass_g=201");
  EXPECT_NE(diff("a", "grams").text.find("inputs\n  the same\n"), std::string::npos) << diff("a", "grams").text;
  const Outcome heavier = diff("a", "heavier");
  EXPECT_NE(heavier.text.find("head.mass_g"), std::string::npos) << heavier.text;
  EXPECT_NE(heavier.text.find("head.mass_kg"), std::string::npos) << heavier.text;
  const Outcome none = diff("a", "nothing");
  expect_refused(none, "no finished run");
}

TEST(CommandLine, DiffNamesFilesOfOtherContent) {
  const fs::path home = fresh_directory("diff_files"), shaft = home / "shaft";
  write(shaft / "case.toml", "kind = \"modes\"\ncount = 2\nvtk = false\n[shaft.table]\nfile = \"profile.csv\"\n");
  const auto run = [&](const std::string& name, const std::string& radius, const std::string& more) {
    write(shaft / more,
          "arc_length_mm,bending_stiffness_N_m2,torsional_stiffness_N_m2,mass_per_length_g_per_m,mean_"
          "radius_mm\n0," +
              radius + ",48,72,7.5\n1140,16,19,62,4.4\n");
    const Outcome o = command("run '" + shaft.string() + "' --quiet --set shaft.table.file=" + more + " --out '" +
                              (home / name).string() + "'");
    ASSERT_EQ(o.status, 0) << o.text;
  };
  run("a", "62", "profile.csv");
  run("b", "82", "profile.csv");
  run("c", "62", "profile.csv");
  run("d", "62", "other.csv");
  const auto diff = [&](const std::string& other) {
    return command("diff '" + (home / "a").string() + "' '" + (home / other).string() + "'").text;
  };
  const std::string stiffer = diff("b"), same = diff("c"), named = diff("d");
  ASSERT_EQ(stiffer.find("0 of"), std::string::npos) << "the frequencies differ: " << stiffer;
  EXPECT_EQ(stiffer.find("the same"), std::string::npos) << stiffer;
  EXPECT_NE(stiffer.find("inputs\n  inputs/profile.csv: its content differs\n"), std::string::npos) << stiffer;
  EXPECT_NE(same.find("inputs\n  the same\n"), std::string::npos) << same;
  EXPECT_NE(named.find("  inputs/other.csv: in B only\n  inputs/profile.csv: in A only\n"), std::string::npos) << named;
}

TEST(CommandLine, DiffSaysWhichModelsOneRunAloneAsked) {
  const fs::path home = fresh_directory("diff_models"), blow = home / "blow";
  write(blow / "case.toml", kEccentricBlow);
  for (const char* model : {"rigid-eccentric", "stick-slip"}) {
    const Outcome o = command("run '" + blow.string() + "' --quiet --set 'models=[\"" + model + "\"]' --out '" +
                              (home / model).string() + "'");
    ASSERT_EQ(o.status, 0) << o.text;
  }
  const std::string none =
      command("diff '" + (home / "rigid-eccentric").string() + "' '" + (home / "stick-slip").string() + "'").text;
  ASSERT_NE(none.find("  models "), std::string::npos) << none;
  EXPECT_NE(none.find("launches\n  rigid-eccentric: in A only\n  stick-slip: in B only\n"), std::string::npos) << none;
}

TEST(CommandLine, DiffNamesNumbersOfOneRunAlone) {
  const fs::path home = fresh_directory("diff_alone"), blow = home / "blow";
  write(blow / "case.toml", kEccentricBlow);
  const std::string flying = kEccentricBlow + "[flight]\nunits = \"metres\"\n";
  write(home / "flying/case.toml", flying);
  for (const char* name : {"blow", "flying"})
    ASSERT_EQ(command("run '" + (home / name).string() + "' --quiet --out '" + (home / name).string() + "-out'").status,
              0);
  const auto diff = [&](const char* a, const char* b) {
    return command("diff '" + (home / a).string() + "-out' '" + (home / b).string() + "-out'").text;
  };
  const std::string more = diff("blow", "flying"), less = diff("flying", "blow"), same = diff("blow", "blow");
  EXPECT_NE(more.find(" in B only"), std::string::npos) << more;
  EXPECT_EQ(more.find(" in A only"), std::string::npos) << more;
  EXPECT_NE(more.find("\n    flights.rigid-eccentric.carry_m\n"), std::string::npos) << more;
  EXPECT_NE(less.find(" in A only"), std::string::npos) << less;
  EXPECT_EQ(less.find(" in B only"), std::string::npos) << less;
  EXPECT_EQ(same.find(" only"), std::string::npos) << same;
}

TEST(CommandLine, DiffTellsTextsFlagsAndListsOfOtherLengths) {
  const fs::path home = fresh_directory("diff_words");
  const auto run = [&](const std::string& name, const std::string& summary) {
    write(home / name / "summary.json", summary);
    write(home / name / "case.resolved.toml", "kind = \"study\"\n");
  };
  run("a", R"({"verdict": "holds", "clean": true, "n": 3.0, "list": [1, 2, 3, [4, 5]], "same": [1, 2]})");
  run("b", R"({"verdict": "fails", "clean": true, "n": null, "list": [2, 3, [4]], "same": [1, 2]})");
  const std::string text = command("diff '" + (home / "a").string() + "' '" + (home / "b").string() + "'").text;
  EXPECT_NE(text.find("verdict\n    A: holds\n    B: fails"), std::string::npos) << text;
  EXPECT_NE(text.find("n\n    A: 3\n    B: null"), std::string::npos) << text;
  EXPECT_NE(text.find("list: 4 entries in A, 3 in B"), std::string::npos) << text;
  EXPECT_EQ(text.find("list."), std::string::npos) << text;
  EXPECT_EQ(text.find("clean"), std::string::npos) << text;
  EXPECT_EQ(text.find(" only"), std::string::npos) << text;
}

/// A mean over the points is no launch.
TEST(CommandLine, DiffComparesPointsByTheirTable) {
  const fs::path home = fresh_directory("diff_studies");
  write(home / "case.toml", study_of_blow("[\"ball_speed_mps\", \"launch_angle_deg\"]") +
                                "[[axis]]\nkey = \"head.mass_kg\"\nvalues = [0.19, 0.2]\n");
  for (const auto& [name, set] : {std::pair{"a", ""}, {"b", " --set delivery.club_speed_mps=46"}, {"c", ""}})
    ASSERT_EQ(command("run '" + home.string() + "' --quiet --out '" + (home / name).string() + "'" + set).status, 0);
  const auto diff = [&](const char* other) {
    return command("diff '" + (home / "a").string() + "' '" + (home / other).string() + "'").text;
  };
  const std::string moved = diff("b"), same = diff("c");
  EXPECT_EQ(moved.find("launches\n"), std::string::npos) << moved;
  EXPECT_NE(moved.find("points\n  points.csv: its content differs"), std::string::npos) << moved;
  EXPECT_NE(moved.find("  mean.ball_speed_mps "), std::string::npos) << moved;
  EXPECT_NE(same.find("points\n  points.csv: the same\n"), std::string::npos) << same;
}

TEST(CommandLine, DiffSaysWhereItsErrorComesFrom) {
  const fs::path home = fresh_directory("diff_band"), blow = home / "blow";
  write(blow / "case.toml", kEccentricBlow + "[ball]\nmodel = \"tour\"\n[contact]\nface_friction = 0.3\n");
  const auto run = [&](const std::string& name, const std::string& more) {
    const Outcome o = command("run '" + blow.string() +
                              "' --quiet --set 'models=[\"fe-free-body\"]' --set accuracy=look --out '" +
                              (home / name).string() + "' " + more);
    ASSERT_EQ(o.status, 0) << o.text;
  };
  run("a", "");
  run("b", "--set delivery.club_speed_mps=45.001");
  run("c", "--set delivery.club_speed_mps=45.001 --set time.steps_per_contact=40");
  const auto diff = [&](const std::string& other) {
    return command("diff '" + (home / "a").string() + "' '" + (home / other).string() + "'").text;
  };
  const std::string same = diff("b"), other = diff("c");
  ASSERT_NE(same.find("  within\n"), std::string::npos) << same;
  EXPECT_NE(same.find("numerical: the larger error of the two runs"), std::string::npos) << same;
  EXPECT_NE(same.find("most of that error is common to both"), std::string::npos) << same;
  ASSERT_NE(other.find("  within\n"), std::string::npos) << other;
  EXPECT_EQ(other.find("most of that error is common to both"), std::string::npos) << other;
}

TEST(CommandLine, CheckTellsAShaftsFigures) {
  const fs::path dir = fresh_directory("shaft_figures");
  const std::string head = "kind = \"modes\"\nsupport = \"clamped\"\n";
  const auto check = [&](const std::string& shaft) {
    write(dir / "case.toml", head + shaft);
    return command("check '" + dir.string() + "'");
  };
  const std::string even =
      "[shaft.table]\narc_length_mm = [0, 500, 1000]\nbending_stiffness_N_m2 = [40, 40, 40]\n"
      "torsional_stiffness_N_m2 = [30, 30, 30]\nmass_per_length_g_per_m = [60, 60, 60]\nmean_radius_mm = [6, 6, 6]\n";
  const Outcome plain = check(even);
  ASSERT_EQ(plain.status, 0) << plain.text;
  EXPECT_NE(plain.text.find("length 1000.0 mm, mass 60.00 g, balance point 500.0 mm from the butt (50.0 %)"),
            std::string::npos)
      << plain.text;
  EXPECT_NE(plain.text.find("EI at the butt 40, at the tip 40 N m^2"), std::string::npos) << plain.text;
  write(dir / "again" / "case.toml", plain.text);
  EXPECT_EQ(command("check '" + (dir / "again").string() + "'").text, plain.text) << "what is printed is a case";
  const Outcome tip = check(even + "[shaft.tip]\nfrom_mm = 750\nbending_scale = 2\ntorsion_scale = 0.5\n");
  EXPECT_NE(tip.text.find("EI at the butt 40, at the tip 80 N m^2"), std::string::npos) << tip.text;
  EXPECT_NE(tip.text.find("GJ at the butt 30, at the tip 15 N m^2"), std::string::npos) << tip.text;
  const Outcome beyond = check(even + "[shaft.tip]\nfrom_mm = 1000\nbending_scale = 2\ntorsion_scale = 1\n");
  expect_refused(beyond, "the shaft ends at 1 m");
  const Outcome both = check("[shaft]\nname = \"x\"\n" + even);
  expect_refused(both, "give one of `name` and `table`");
}

TEST(CommandLine, AStrikeOffTheFaceWarns) {
  const fs::path home = fresh_directory("off_the_face"), blow = home / "blow";
  write(blow / "case.toml", kEccentricBlow);
  const auto run = [&](const std::string& more) {
    return command("run '" + blow.string() + "' --force --out '" + (home / "out").string() + "' " + more);
  };
  const Outcome on = run("--set delivery.impact_toe_mm=30"), off = run("--set delivery.impact_toe_mm=70");
  EXPECT_EQ(on.status, 0);
  EXPECT_EQ(on.text.find("off the face"), std::string::npos) << on.text;
  EXPECT_EQ(off.status, 0);
  EXPECT_NE(off.text.find("struck off the face: 70 mm towards the toe"), std::string::npos) << off.text;
  const Outcome strict = run("--strict --set delivery.impact_toe_mm=70");
  EXPECT_EQ(strict.status, 3);
  EXPECT_NE(strict.text.find("--strict: the ball is struck off the face"), std::string::npos) << strict.text;
  EXPECT_EQ(strict.text.find("no convergence"), std::string::npos) << strict.text;
}

TEST(CommandLine, AClubWithoutAShaftIsRefusedWithFileAndLine) {
  const fs::path blow = fresh_directory("no_shaft");
  for (const char* model : {"fe-full-club", "shaft-coupled"}) {
    write(blow / "case.toml", std::string(kEccentricBlow).replace(kEccentricBlow.find("rigid-eccentric"), 15, model));
    const Outcome o = command("check '" + blow.string() + "'");
    expect_refused(o, std::string("case.toml:2: models: ") + model + " needs the club's shaft: [shaft]");
  }
}

TEST(CommandLine, ACharacteristicTimePassesOrFails) {
  const fs::path out = fresh_directory("characteristic_time");
  const auto verdict = [&](const std::string& more) {
    const Outcome o =
        command("run characteristic-time/face --force --set axis[1].values=[0] --out '" + out.string() + "' " + more);
    EXPECT_EQ(o.status, 0) << o.text;
    return nlohmann::json::parse(content(out / "summary.json"))["statements"][0]["verdict"].get<std::string>();
  };
  EXPECT_EQ(verdict(""), "holds");
  EXPECT_EQ(verdict("--set face.stiffness_N_per_m=4e6"), "fails");
}

TEST(CommandLine, AFolderThatIsNoCaseHidesNoShippedOne) {
  const fs::path dir = fresh_directory("command_shadow"), before = fs::current_path();
  fs::create_directories(dir / "material-point" / "vtk");
  fs::current_path(dir);
  const fs::path found = app::find_case("material-point");
  write("material-point/case.toml", "kind = \"modes\"\n");
  const fs::path own = app::find_case("material-point");
  fs::current_path(before);
  EXPECT_TRUE(found.is_absolute() && fs::exists(found / "case.toml")) << found;
  EXPECT_EQ(own, "material-point");
}

/// A table wider than the terminal has its heading in several rows, and goes on below, its rows named again; one whose
/// names are sentences does not.
TEST(CommandLine, AWideTableFoldsInATerminal) {
  const post::TextTable table{.rows = {{"point", "ball speed [m/s]", "launch angle [deg]", "backspin [rpm]"},
                                       {"loft 10\xC2\xB0", "66.651", "7.8367", "2127"},
                                       {"loft 15\xC2\xB0", "65.494", "11.879", "3063.5"}},
                              .margin = 1,
                              .least_width = 9,
                              .even = false};
  EXPECT_EQ(app::folded(table, 0), table.text());
  EXPECT_EQ(app::folded(table, 200), table.text());
  EXPECT_EQ(app::folded(table, 60),
            "                       ball   launch          \n"
            "                      speed    angle  backspin\n"
            "point                 [m/s]    [deg]     [rpm]\n"
            "loft 10\xC2\xB0             66.651   7.8367      2127\n"
            "loft 15\xC2\xB0             65.494   11.879    3063.5");
  EXPECT_EQ(app::folded(table, 40),
            "                       ball   launch\n"
            "                      speed    angle\n"
            "point                 [m/s]    [deg]\n"
            "loft 10\xC2\xB0             66.651   7.8367\n"
            "loft 15\xC2\xB0             65.494   11.879\n"
            "\n"
            "                    backspin\n"
            "point                  [rpm]\n"
            "loft 10\xC2\xB0                2127\n"
            "loft 15\xC2\xB0              3063.5");
  post::TextTable sentences = table;
  sentences.rows[1][0] = "the ball is faster with the club over the whole face";
  EXPECT_EQ(app::folded(sentences, 80), sentences.text());
}

TEST(CommandLine, OpenSaysWhatIsMissing) {
  const fs::path home = fresh_directory("open");
  EXPECT_NE(command("open '" + home.string() + "'").text.find("no series for ParaView"), std::string::npos);
  write(home / "vtk" / "ball.pvd", "");
  const std::string open = HOSEL_COMMAND " open '" + home.string() + "'\n";
  EXPECT_NE(bash("PATH=/nowhere " + open).find("ParaView is not installed"), std::string::npos);
  // A program of that name, and no screen; then it is started with the script and the folder.
  const fs::path bin = fresh_directory("open_bin");  // a program inside OUT is not started
  write(bin / "paraview", "#!/bin/sh\necho started \"$@\" $HOSEL_VTK\n");
  fs::permissions(bin / "paraview", fs::perms::owner_all);
  const std::string path = "PATH='" + bin.string() + ":/bin' ";
  EXPECT_NE(bash("unset DISPLAY WAYLAND_DISPLAY\nPATH='" + bin.string() + "' " + open).find("no screen"),
            std::string::npos);
  const std::string started = bash("DISPLAY=:0 " + path + open);
  EXPECT_NE(started.find("open.py"), std::string::npos) << started;
  EXPECT_NE(started.find((home / "vtk").string()), std::string::npos) << started;
}

/// Of two models the last that the case names answers it, whatever the order of their names.
TEST(CommandLine, FilmIsOfTheModelThatAnswers) {
  const fs::path home = fresh_directory("film_of"), bin = fresh_directory("film_of_bin");
  for (const char* model : {"fe-free-body", "fe-full-club"}) write(home / model / "vtk" / "ball.pvd", "");
  write(home / "case.resolved.toml", "models = [\"fe-full-club\", \"rigid-planar\", \"fe-free-body\"]\n");
  fs::create_directories(bin / "cache/hosel/paraview-python/usr");
  for (const char* name : {"pvbatch", "xvfb-run", "ffmpeg"}) {
    write(bin / name, "#!/bin/sh\necho \"$@\"\nexit 1\n");
    fs::permissions(bin / name, fs::perms::owner_all);
  }
  const std::string said = bash("XDG_CACHE_HOME='" + (bin / "cache").string() + "' PATH='" + bin.string() +
                                ":/usr/bin:/bin' " HOSEL_COMMAND " film '" + home.string() + "'");
  EXPECT_NE(said.find((home / "fe-free-body").string()), std::string::npos) << said;
  EXPECT_EQ(said.find((home / "fe-full-club").string()), std::string::npos) << said;
}

/// What makes the pictures is ended with it, and nothing is left beside the series.
TEST(CommandLine, AFilmThatIsStoppedLeavesNothing) {
  const fs::path home = fresh_directory("film_stopped"), bin = fresh_directory("film_stopped_bin");
  write(home / "vtk" / "ball.pvd", "");
  fs::create_directories(bin / "cache/hosel/paraview-python/usr");
  const std::string begun = (bin / "begun").string();
  for (const char* name : {"pvbatch", "xvfb-run", "ffmpeg"}) {
    write(bin / name, "#!/bin/sh\necho $$ > '" + begun + "'\nsleep 30\n");
    fs::permissions(bin / name, fs::perms::owner_all);
  }
  const std::string said = bash("export XDG_CACHE_HOME='" + (bin / "cache").string() + "' PATH='" + bin.string() +
                                ":/usr/bin:/bin'; " HOSEL_COMMAND " film '" + home.string() +
                                "' & film=$!; for i in $(seq 300); do [ -s '" + begun +
                                "' ] && break; sleep 0.1; done; at_work=$(cat '" + begun +
                                "'); kill -0 $at_work && echo at work; kill -TERM $film; wait $film; echo status $?; "
                                "kill -0 $at_work || echo ended");
  EXPECT_NE(said.find("at work"), std::string::npos) << said;
  EXPECT_NE(said.find("stopped by SIGTERM; no film was made"), std::string::npos) << said;
  EXPECT_NE(said.find("status 143"), std::string::npos) << said;
  EXPECT_NE(said.find("ended"), std::string::npos) << said;
  EXPECT_EQ(std::distance(fs::directory_iterator(home), fs::directory_iterator()), 1) << "the series alone";
}

TEST(CommandLine, FilmSaysWhatIsMissing) {
  const fs::path home = fresh_directory("film");
  EXPECT_NE(command("film '" + home.string() + "'").text.find("no series of a blow"), std::string::npos);
  write(home / "vtk" / "ball.pvd", "");
  const std::string film = HOSEL_COMMAND " film '" + home.string() + "'";
  EXPECT_NE(bash("PATH=/nowhere " + film).find("pvbatch is not installed (Debian: apt-get install paraview)"),
            std::string::npos);
  const fs::path bin = fresh_directory("film_bin");
  for (const char* name : {"pvbatch", "xvfb-run"}) {
    write(bin / name, "#!/bin/sh\n");
    fs::permissions(bin / name, fs::perms::owner_all);
  }
  EXPECT_NE(
      bash("PATH='" + bin.string() + "' " + film).find("ffmpeg is not installed (Debian: apt-get install ffmpeg)"),
      std::string::npos);
  EXPECT_NE(bash(film + " --to film.avi").find("a film is an .mp4 or a .gif"), std::string::npos);
  const Outcome nowhere = command("film '" + home.string() + "' --to '" + (home / "none" / "film.mp4").string() + "'");
  expect_refused(nowhere, "none: no such directory");
  write(home / "film.mp4", "mine");
  EXPECT_NE(bash(film).find("exists"), std::string::npos);
  EXPECT_EQ(content(home / "film.mp4"), "mine");
}

}  // namespace
}  // namespace hosel::test
