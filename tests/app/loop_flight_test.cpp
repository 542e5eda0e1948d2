// Loops whose base is the flight and laws inferred from followed flights, as cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/read_paths.hpp"
#include "build_info.hpp"
#include "command.hpp"
#include "golf/units.hpp"
#include "models/flight/flight.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

const fs::path kCase = fs::path(HOSEL_SOURCE_DIR) / "cases" / "loop-flights";

TEST(LoopFlight, TheShippedCaseNamesTheDrag) {
  const fs::path out = fresh_directory("loop_flights");
  const Outcome o = command("run " + kCase.string() + " --force --out " + out.string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto report = nlohmann::json::parse(content(out / "report.json"));
  EXPECT_EQ(report["base"], "flight");
  EXPECT_EQ(report["rows"]["used"], 80);
  EXPECT_EQ(report["adopted"], nlohmann::json({"drag-level"}));
  EXPECT_EQ(report["verdict"], "explained");
  const auto& best = report["candidates"].front();
  EXPECT_EQ(best["effects"], nlohmann::json({"drag-level"}));
  EXPECT_NEAR(best["parameters"][0]["value"].get<double>(), 0.06, 0.015);
  EXPECT_TRUE(fs::exists(out / "report.html"));
}

TEST(LoopFlight, SaysWhatIsWrong) {
  const auto error = [&](const std::string& set) {
    const Outcome o = command("check " + kCase.string() + " " + set);
    EXPECT_EQ(o.status, 2) << o.text;
    return o.text;
  };
  EXPECT_NE(error("--set data.noise.carry_yd=1").find("did you mean 'carry_m'"), std::string::npos);
  EXPECT_NE(error("--set 'data.group_by=[\"holes\"]'").find("no column 'holes'"), std::string::npos);
  EXPECT_NE(error("--set 'model.effects=[\"head-mass\"]'").find("no effect 'head-mass'"), std::string::npos);
  EXPECT_NE(error("--set flight.turf.rolling=0.1").find("end at the first landing"), std::string::npos);
  EXPECT_NE(error("--set 'data.paths=\"shots.csv\"' --set data.position_noise_m=0.1").find("time_s"),
            std::string::npos);
}

/// A shot that stands twice, under its own number or another, counts once, and that is said.
TEST(LoopFlight, ARowThatRepeatsIsTold) {
  const fs::path dir = fresh_directory("loop_flights_repeat");
  const std::string text = content(kCase / "shots.csv");
  const auto second = text.find('\n') + 1, third = text.find('\n', second) + 1;
  const std::string row = text.substr(second, third - second);
  write(dir / "case" / "case.toml", content(kCase / "case.toml"));
  write(dir / "case" / "shots.csv", text + row + "999" + row.substr(row.find(',')));
  const Outcome o = command("run " + (dir / "case").string() + " --set 'model.effects=[\"drag-level\"]' --out " +
                            (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("2 rows of the shots repeat an earlier row: each shot counts once"), std::string::npos)
      << o.text;
  EXPECT_EQ(nlohmann::json::parse(content(dir / "out" / "report.json"))["rows"]["used"], 80);
}

/// Every row keeps the air of its own flight where a copied flight before it is left out.
TEST(LoopFlight, ACopiedFlightOfARadarChangesNothing) {
  const char* data = std::getenv("HOSEL_DATA");
  const fs::path file = fs::path(data ? data : "") / "radar_flights" / "trajectories.csv";
  if (!data || !fs::exists(file)) GTEST_SKIP() << "HOSEL_DATA names no radar_flights";
  const fs::path dir = fresh_directory("loop_radar_copy");
  std::ifstream in(file);
  std::string head, line;
  std::getline(in, head);
  std::map<std::string, std::vector<std::string>> events;  // twelve flights each: one air each
  while (std::getline(in, line))
    if (auto& of = events[line.substr(0, line.find(','))]; of.size() < 12) of.push_back(line);
  const auto &thin = events.at("006"), &dense = events.at("016");
  const auto report = [&](const std::string& name, bool copied) {
    std::string csv = head + '\n';
    for (std::size_t i = 0; i < thin.size(); ++i) csv += thin[i] + '\n' + (copied && i == 1 ? thin[i] + '\n' : "");
    for (const std::string& flight : dense) csv += flight + '\n';
    write(dir / name / "flights.csv", csv);
    write(dir / name / "case.toml",
          "kind = \"loop\"\n[model]\nbase = \"flight\"\neffects = [\"drag-level\"]\n[flight]\n[paths]\n"
          "file = \"flights.csv\"\ngroup_by = [\"event\"]\nchannels = \"ends\"\nnoise_m = 0.5\nwind_mps = 3.0\n"
          "carry_noise_m = 2\nside_noise_m = 2\napex_noise_m = 1\ntime_noise_s = 0.1\n"
          "[split]\nby = \"player\"\n[[paths.site]]\nevent = \"006\"\ndensity_kg_per_m3 = 0.9\n"
          "[[paths.site]]\nevent = \"016\"\ndensity_kg_per_m3 = 1.3\n");
    const Outcome o = command("run " + (dir / name).string() + " --out " + (dir / name / "out").string());
    EXPECT_EQ(o.status, 0) << o.text;
    EXPECT_EQ(o.text.find("1 row of the shots repeats") != std::string::npos, copied) << o.text;
    return nlohmann::json::parse(content(dir / name / "out" / "report.json"));
  };
  const auto once = report("once", false), copied = report("copied", true);
  ASSERT_GT(once["rows"]["used"], 12);
  EXPECT_EQ(once["rows"]["used"], copied["rows"]["used"]);
  for (std::size_t c = 0; c < once["channels"].size(); ++c)
    EXPECT_EQ(once["channels"][c]["before"], copied["channels"][c]["before"]) << once["channels"][c].dump();
}

/// Positions at common instants are channels: three a time.
TEST(LoopFlight, PathsAreChannels) {
  const fs::path dir = fresh_directory("loop_paths");
  fs::create_directories(dir / "case");
  std::string shots = "shot,ball_speed_mps,launch_angle_deg,azimuth_deg,spin_rate_rpm,spin_axis_deg\n",
              paths = "shot,time_s,along_m,right_m,up_m\n";
  for (int i = 0; i < 12; ++i) {
    const double speed = 68 + i;
    shots += std::to_string(i) + "," + std::to_string(speed) + ",11,0,2600,0\n";
    for (const double t : {1.0, 2.0})  // no drag, no lift: nothing that flies so
      paths += std::to_string(i) + "," + std::to_string(t) + "," + std::to_string(0.98 * speed * t) + ",0," +
               std::to_string(0.19 * speed * t - 4.9 * t * t) + "\n";
  }
  write(dir / "case" / "shots.csv", shots);
  write(dir / "case" / "paths.csv", paths);
  write(dir / "case" / "case.toml",
        "kind = \"loop\"\n[model]\nbase = \"flight\"\n[flight]\n[data]\nshots = \"shots.csv\"\npaths = \"paths.csv\"\n"
        "position_noise_m = 0.3\n");
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto report = nlohmann::json::parse(content(dir / "out" / "report.json"));
  ASSERT_EQ(report["channels"].size(), 6U);
  EXPECT_EQ(report["channels"][0]["name"], "along_at_1_s_m");
  EXPECT_NE(report["verdict"], "no-residual");
}

/// Whose path is whose hangs on the numbers of the shots; a copy is one with its path.
TEST(LoopFlight, APathBelongsToOneShot) {
  const fs::path dir = fresh_directory("loop_paths_of");
  const std::string head = "shot,ball_speed_mps,launch_angle_deg,azimuth_deg,spin_rate_rpm,spin_axis_deg\n",
                    of_path = "shot,time_s,along_m,right_m,up_m\n";
  const auto launch = [](int i) { return "," + std::to_string(70 + 0.37 * i) + ",12.25,0.51,2553,1.52\n"; };
  const auto told = [&](const std::string& shots, const std::string& paths) {
    write(dir / "case" / "shots.csv", shots);
    write(dir / "case" / "paths.csv", paths);
    write(dir / "case" / "case.toml",
          "kind = \"loop\"\n[model]\nbase = \"flight\"\n[flight]\n[data]\nshots = \"shots.csv\"\npaths = "
          "\"paths.csv\"\nposition_noise_m = 0.5\n");
    return command("run " + (dir / "case").string() + " --force --out " + (dir / "out").string());
  };
  const auto used = [&] { return nlohmann::json::parse(content(dir / "out" / "report.json"))["rows"]["used"]; };
  std::string numbered = head, alike = head, sessions = "session," + head, paths = of_path, of_sessions = of_path;
  for (int i = 0; i < 6; ++i) {
    const std::string n = std::to_string(i + 1), of_day = std::to_string(i % 3 + 1),
                      position = ",1," + std::to_string(60 + i) + "," + std::to_string(0.1 * i) + ",12\n";
    numbered += n + launch(i);
    alike += n + launch(0);
    sessions += (i < 3 ? "a," : "b,") + of_day + launch(i);
    paths += n + position;
    of_sessions += of_day + position;
  }
  const Outcome shared = told(sessions, of_sessions);
  EXPECT_EQ(shared.status, 2);
  EXPECT_NE(shared.text.find("shot '1' stands 2 times in"), std::string::npos) << shared.text;
  EXPECT_NE(shared.text.find("paths.csv:2:"), std::string::npos) << shared.text;

  const Outcome again = told(numbered, paths + "1,1.0,999,999,999\n");
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.text.find("paths.csv:8: shot '1' has a position at 1 s already"), std::string::npos) << again.text;

  const Outcome stranger = told(numbered, paths + "9,1,60,0,12\n");
  EXPECT_EQ(stranger.status, 2);
  EXPECT_NE(stranger.text.find("paths.csv:8: no shot '9'"), std::string::npos) << stranger.text;

  const Outcome equal_launches = told(alike, paths);
  ASSERT_EQ(equal_launches.status, 0) << equal_launches.text;
  EXPECT_EQ(used(), 6) << "six flights of equal launches";

  const Outcome copied = told(numbered + "7" + launch(0), paths + "7,1.0,60,0,12.0\n");
  ASSERT_EQ(copied.status, 0) << copied.text;
  EXPECT_EQ(used(), 6);
  EXPECT_NE(copied.text.find("1 row of the shots repeats an earlier row"), std::string::npos) << copied.text;
  EXPECT_NE(copied.text.find("1 position of shots that repeat an earlier one: not used"), std::string::npos)
      << copied.text;
}

TEST(FlightLawCase, LeavesOutPlayersByTheirName) {
  // FNV-1a of "a" is 0xe40c292c, of "b" 0xe70c2de5 (the function's published test values).
  EXPECT_FALSE(hosel::app::held_out("a"));
  EXPECT_TRUE(hosel::app::held_out("b"));
}

TEST(FlightLawCase, ReachesWhatAPointWithDragAndLiftCan) {
  const fs::path out = fresh_directory("flight_law");
  const Outcome o = command("run " + (fs::path(HOSEL_SOURCE_DIR) / "cases" / "radar-law").string() + " --force --out " +
                            out.string());
  ASSERT_EQ(o.status, 0) << o.text;
  if (o.text.find("SKIPPED") != std::string::npos) GTEST_SKIP() << "HOSEL_DATA names no radar_flights";
  const auto left_out = nlohmann::json::parse(content(out / "summary.json"))["left_out"];
  const auto &by_path = left_out["by_path"]["inferred"], &at_will = left_out["at_will"]["inferred"];
  EXPECT_GT(at_will["shots"], 50);
  EXPECT_GT(at_will["carry_rms_m"], 1);  // the radar's own continuation, which no law follows
  // Axis, ball and wind of a shot leave no more than a quarter beyond drag, lift and wind at will.
  EXPECT_LT(by_path["carry_rms_m"].get<double>(), 1.25 * at_will["carry_rms_m"].get<double>());
  EXPECT_LT(std::abs(by_path["carry_bias_m"].get<double>()), 1.5);
}

/// A radar's flights by the names of their columns: polynomials of the times' powers.
struct RadarTable {
  std::vector<std::string> names, cells;

  RadarTable() {
    for (const char axis : {'x', 'y', 'z'})
      for (int k = 0; k < 7; ++k) {
        names.push_back(axis + std::to_string(k));
        cells.push_back(axis == 'x' && k == 1   ? "60"
                        : axis == 'y' && k == 1 ? "20"
                        : axis == 'y' && k == 2 ? "-4"
                                                : "0");
      }
    for (const auto& [name, cell] : {std::pair{"carry_m_level", "250"},
                                     {"apex_m_poly", "25"},
                                     {"time_level_s", "5"},
                                     {"measured_time_s", "5"},
                                     {"spin0_fit_rpm", "2500"},
                                     {"spin_decay_per_s", "0.05"},
                                     {"launch_spin_rpm", "2500"},
                                     {"player", "A"},
                                     {"event", "1"}})
      names.emplace_back(name), cells.emplace_back(cell);
  }
  static std::string line(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& w : words) out += (out.empty() ? "" : ",") + w;
    return out + "\n";
  }
  /// A flight with these cells in place of the usual ones.
  std::string flight(const std::map<std::string, std::string>& other) const {
    std::vector<std::string> row = cells;
    for (const auto& [name, cell] : other) row.at(std::size_t(std::ranges::find(names, name) - names.begin())) = cell;
    return line(row);
  }
};

/// Rows that a loop leaves out are told, and a group's name is no number.
TEST(RadarPaths, ALoopTellsWhatItLeavesOutAndKeepsTheNamesOfGroups) {
  const fs::path dir = fresh_directory("radar_loop");
  const RadarTable table;
  std::string csv = RadarTable::line(table.names);
  for (int i = 0; i < 12; ++i) {
    const double along = 68 + 0.4 * i, up = 14 + 0.2 * ((i * 5) % 7);
    hosel::Launch l;
    l.velocity = {along, 0, up};
    l.spin = {0, -2500 * hosel::kRadPerSecPerRpm, 0};
    hosel::models::FlightConditions c;
    c.air.density = 1.2;
    const hosel::models::Flight f = hosel::models::fly(l, {}, c);
    csv += table.flight({{"x1", std::to_string(along)},
                         {"y1", std::to_string(up)},
                         {"carry_m_level", std::to_string(f.carry)},
                         {"apex_m_poly", std::to_string(f.apex)},
                         {"time_level_s", std::to_string(f.time)},
                         {"measured_time_s", std::to_string(f.time)},
                         {"event", i % 2 ? "016" : "16"}});
  }
  csv += table.flight({{"spin0_fit_rpm", ""}, {"launch_spin_rpm", ""}, {"event", "16"}});
  csv += table.flight({{"measured_time_s", "1"}, {"event", "16"}});
  csv += table.flight({{"measured_time_s", "2"}, {"event", "16"}});
  write(dir / "case" / "flights.csv", csv);
  write(dir / "case" / "case.toml",
        "kind = \"loop\"\n[model]\nbase = \"flight\"\n[flight]\n[paths]\nfile = \"flights.csv\"\ngroup_by = "
        "[\"event\"]\nchannels = \"ends\"\nnoise_m = 0.5\nwind_mps = 3.0\ncarry_noise_m = 2\nside_noise_m = 2\n"
        "apex_noise_m = 1\ntime_noise_s = 0.1\n[[paths.site]]\nevent = \"016\"\ndensity_kg_per_m3 = 1.2\n"
        "[[paths.site]]\nevent = \"16\"\ndensity_kg_per_m3 = 1.2\n");
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string notes = nlohmann::json::parse(content(dir / "out" / "report.json"))["notes"].dump();
  for (const char* said :
       {"1 row without a spin: not used", "2 rows too short, too low or not followed long enough: not used"}) {
    EXPECT_NE(notes.find(said), std::string::npos) << said << ": " << notes;
    EXPECT_NE(o.text.find(said), std::string::npos) << said << ": " << o.text;
  }
  for (const char* group : {"wind of 016:", "wind of 16:"})
    EXPECT_NE(notes.find(group), std::string::npos) << group << ": " << notes;
}

/// A flight without a coefficient, or without the time at which it is level again, is none, whatever the rest says.
TEST(RadarPaths, FlightsWithEmptyCellsAreLeftOut) {
  const fs::path dir = fresh_directory("radar_paths");
  const RadarTable table;
  std::string csv = RadarTable::line(table.names) + table.flight({});
  const std::vector<std::string> lacking{"x4", "y0", "z6", "time_level_s", "apex_m_poly"};
  for (const std::string& name : lacking) csv += table.flight({{name, ""}});
  write(dir / "paths.csv", csv);
  write(dir / "case.toml",
        "kind = \"flight-law\"\n[paths]\nfile = \"paths.csv\"\ngroup_by = [\"event\"]\n[[paths.site]]\nevent = \"1\"\n"
        "density_kg_per_m3 = 1.2\n");
  hosel::app::CaseFile file(dir);
  const hosel::app::RadarPaths paths = hosel::app::read_paths(file.root().table("paths"), {});
  ASSERT_EQ(paths.flights.size(), 1u);
  EXPECT_EQ(paths.flights.front().path.times.size(), 10u);
  int left_out = 0;
  for (const auto& [why, count] : paths.left_out) left_out += count;
  EXPECT_EQ(left_out, int(lacking.size()));
}

TEST(FlightLawCase, SkipsWithoutTheData) {
  const fs::path out = fresh_directory("flight_law_skipped");
  const Outcome o = command("run " + (fs::path(HOSEL_SOURCE_DIR) / "cases" / "radar-law").string() + " --force --out " +
                            out.string() + " --set paths.file=not-there/t.csv");
  EXPECT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("SKIPPED"), std::string::npos) << o.text;
}

}  // namespace
