// [flight] in a case: where the ball goes after any blow, in the units asked for.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "command.hpp"
#include "csv_file.hpp"
#include "post/csv.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

nlohmann::json run(const std::string& name, const std::string& text, Outcome* outcome = nullptr) {
  const fs::path dir = fresh_directory(name);
  write(dir / "case" / "case.toml", text);
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  if (outcome) *outcome = o;
  EXPECT_EQ(o.status, 0) << o.text;
  return o.status ? nlohmann::json{} : nlohmann::json::parse(content(dir / "out" / "summary.json"));
}

TEST(FlightCase, IsTheSameBallInYardsAndInMetres) {
  const auto yards = run("flight_yards",
                         kEccentricBlow + "[flight]\nunits = \"yards\"\n[flight.turf]\n")["flights"]["rigid-eccentric"];
  const auto metres =
      run("flight_metres", kEccentricBlow + "[flight]\nunits = \"metres\"\n")["flights"]["rigid-eccentric"];
  ASSERT_GT(metres["carry_m"], 100);
  for (const char* name : {"carry", "apex", "side"})
    EXPECT_NEAR(0.9144 * yards[std::string(name) + "_yd"].get<double>(), metres[std::string(name) + "_m"].get<double>(),
                1e-9);
  EXPECT_EQ(yards["flight_time_s"], metres["flight_time_s"]);
  EXPECT_GT(yards["total_yd"], yards["carry_yd"]);
  EXPECT_FALSE(metres.contains("total_m"));
}

/// A stated rolling resistance beyond the spread of turfs widens the spread to itself: the total stays inside it.
TEST(FlightCase, TheSpreadOfTurfsHoldsTheOneThatIsStated) {
  const auto totals = [](const std::string& rolling) {
    const auto s =
        run("flight_turf", kEccentricBlow + "[flight]\n[flight.turf]\n" + rolling)["flights"]["rigid-eccentric"];
    return std::array{s["total_firm_yd"].get<double>(), s["total_yd"].get<double>(), s["total_slow_yd"].get<double>()};
  };
  const auto usual = totals(""), firm = totals("rolling = 0.05\n"), slow = totals("rolling = 0.3\n");
  EXPECT_GT(usual[0], usual[1] + 0.3);
  EXPECT_GT(usual[1], usual[2] + 0.3);
  EXPECT_EQ(firm[0], firm[1]);
  EXPECT_GT(firm[1], usual[0] + 0.3);
  EXPECT_EQ(firm[2], usual[2]);
  EXPECT_EQ(slow[2], slow[1]);
  EXPECT_LT(slow[1], usual[2] - 0.3);
  EXPECT_EQ(slow[0], usual[0]);
}

TEST(FlightCase, LeavesACaseWithoutItAlone) {
  Outcome with, without;
  const auto a = run("flight_none", kEccentricBlow, &without),
             b = run("flight_some", kEccentricBlow + "[flight]\n", &with);
  EXPECT_FALSE(a.contains("flights"));
  EXPECT_EQ(without.text.find("carry"), std::string::npos);
  EXPECT_NE(with.text.find("carry [yd]"), std::string::npos);
  EXPECT_EQ(a["models"]["rigid-eccentric"]["ball_speed_mps"], b["models"]["rigid-eccentric"]["ball_speed_mps"]);
}

TEST(FlightCase, WeatherWindAndHeightActAsTheyDo) {
  // Lofted: a ball that lacks lift falls short in thin air, one that has plenty flies farther.
  std::string lofted = kEccentricBlow;
  lofted.replace(lofted.find("dynamic_loft_deg = 10"), 21, "dynamic_loft_deg = 25");
  const auto carry = [&](const std::string& name, const std::string& flight) {
    return run(name, lofted + "[flight]\n" + flight)["flights"]["rigid-eccentric"]["carry_yd"].get<double>();
  };
  const double calm = carry("flight_calm", "");
  EXPECT_GT(carry("flight_warm", "temperature_degC = 35.0\n"), calm + 1);
  EXPECT_GT(carry("flight_high", "altitude_m = 1600.0\n"), calm + 5);
  EXPECT_LT(carry("flight_head", "[flight.wind]\nspeed_mps = 5.0\ntowards_deg = 180.0\n"), calm - 5);
  EXPECT_GT(carry("flight_drop", "[flight.ground]\nheight_m = -10.0\n"), calm + 3);
}

/// A wind that is the same at every height is the ball seen from a frame that moves with it: the calm flight of a ball
/// that is launched slower by the wind, carried on by wind times time.
TEST(FlightCase, AUniformWindIsAMovingFrame) {
  const fs::path dir = fresh_directory("flight_frame");
  constexpr double speed = 60, up = 14 * std::numbers::pi / 180, spin = 3000;
  const double along = speed * std::cos(up), rise = speed * std::sin(up);
  std::string text =
      "kind = \"study\"\noutputs = [\"carry_m\", \"apex_m\", \"flight_time_s\"]\n[launch]\nball_speed_mps = 60\n"
      "launch_angle_deg = 14\nbackspin_rpm = 3000\n[flight]\nlaw = \"ferguson-2022\"\nunits = \"metres\"\n";
  const std::vector<double> winds = {6, -4};  // helping, into the face
  for (const double wind : winds) {
    text += fmt::format(
        "[[variant]]\nname = \"wind {}\"\nset = [\"flight.wind={{speed_mps={}, towards_deg={}, "
        "profile='uniform'}}\"]\n",
        wind, std::abs(wind), wind > 0 ? 0 : 180);
    text += fmt::format(
        "[[variant]]\nname = \"frame {}\"\nset = [\"launch={{ball_speed_mps={:.15g}, launch_angle_deg={:.15g}, "
        "backspin_rpm={}}}\"]\n",
        wind, std::hypot(along - wind, rise), std::atan2(rise, along - wind) * 180 / std::numbers::pi, spin);
  }
  write(dir / "case.toml", text);
  const Outcome o = command("run " + dir.string() + " --quiet --set figures=false --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const CsvFile points(dir / "out" / "points.csv");
  ASSERT_EQ(points.rows(), 2 * winds.size());
  for (std::size_t k = 0; k < winds.size(); ++k) {
    const std::size_t blown = 2 * k, calm = blown + 1;
    const double time = points.number("flight_time_s", calm), carried = winds[k] * time;
    ASSERT_GT(std::abs(carried), 15);
    // Two flights by steps of their own: some millimetres each.
    EXPECT_NEAR(points.number("carry_m", blown), points.number("carry_m", calm) + carried, 0.01);
    EXPECT_NEAR(points.number("apex_m", blown), points.number("apex_m", calm), 0.01);
    EXPECT_NEAR(points.number("flight_time_s", blown), time, 1e-3);
  }
}

TEST(FlightCase, FollowsEveryVariant) {
  std::string text = kEccentricBlow + "[flight]\n";
  text.replace(text.find("\"impact\""), 8, "\"study\"\noutputs = [\"carry_yd\"]");
  Outcome o;
  const auto s = run("flight_variants", text + R"([[variant]]
name = "as it is"
[[variant]]
name = "faster"
set = ["delivery.club_speed_mps=47.0"]
)",
                     &o)["range"]["carry_yd"];
  EXPECT_GT(s[1], s[0].get<double>() + 3);
  EXPECT_NE(o.text.find("carry [yd]"), std::string::npos);
}

/// Carries of a ball whose restitution is known: tuning on nothing but them finds it.
TEST(FlightCase, TunesOnCarry) {
  const std::string head = kEccentricBlow.substr(kEccentricBlow.find("[head]"));
  std::string shots = "shot,club_speed_mps,dynamic_loft_deg,carry_m\n";
  int shot = 0;
  for (const double speed : {40.0, 48.0})
    for (const double loft : {12.0, 20.0}) {
      const std::string blow = "kind = \"impact\"\nmodels = [\"rigid-eccentric\"]\n[delivery]\nclub_speed_mps = " +
                               std::to_string(speed) + "\ndynamic_loft_deg = " + std::to_string(loft) + "\n" + head;
      const auto s = run("flight_tune_shot", blow + "[contact]\nrestitution = 0.81\n[flight]\nunits = \"metres\"\n");
      shots += std::to_string(++shot) + "," + std::to_string(speed) + "," + std::to_string(loft) + "," +
               std::to_string(s["flights"]["rigid-eccentric"]["carry_m"].get<double>()) + "\n";
    }
  const fs::path dir = fresh_directory("flight_tune");
  write(dir / "case" / "shots.csv", shots);
  write(dir / "case" / "case.toml", "kind = \"tune\"\nmodel = \"rigid-eccentric\"\n" + head +
                                        "[flight]\n[data]\nshots = \"shots.csv\"\n[data.noise]\ncarry_m = 0.5\n"
                                        "[[parameters]]\nname = \"restitution\"\nstart = 0.75\n");
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto found = nlohmann::json::parse(content(dir / "out" / "summary.json"))["parameters"][0];
  EXPECT_NEAR(found["value"].get<double>(), 0.81, 1e-3);
}

const std::string kLaunches = R"(kind = "study"
outputs = ["carry_yd", "spin_axis_deg"]
[launch]
ball_speed_mph = 165.0
launch_angle_deg = 11.0
spin_rate_rpm = 2600.0
spin_axis_deg = 8.0
[[variant]]
name = "drive"
measured = {carry_yd = 270.0}
[[variant]]
name = "wedge"
set = ["launch={ball_speed_mph=100.0, launch_angle_deg=26.0, backspin_rpm=9000.0}"]
[flight]
beside = ["smits-smith-1994"]
[[flight.launch_error]]
source = "radar"
ball_speed_mph = 0.5
)";

TEST(FlightCase, ReportsErrorsAndWarnsOutsideTheLaw) {
  const fs::path dir = fresh_directory("flight_budget");
  write(dir / "case" / "case.toml", kLaunches);
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto s = nlohmann::json::parse(content(dir / "out" / "summary.json"));
  const auto& drive = s["launches"]["drive"];
  EXPECT_GT(drive["side_yd"], 5);  // fade goes right
  const auto& carry = drive["budget"]["carry_yd"];
  EXPECT_LT(carry["integration"], 1e-2);
  // A drive gains 1.5 to 2.5 yd a mile per hour.
  EXPECT_NEAR(carry["launch"]["radar"].get<double>(), 1.0, 0.3);
  EXPECT_NE(carry["laws"]["smits-smith-1994"], carry["value"]);
  EXPECT_EQ(drive["outside_law_range"], 0);
  EXPECT_GT(s["launches"]["wedge"]["outside_law_range"], 0.1);
  EXPECT_NE(o.text.find("wedge: "), std::string::npos);
  EXPECT_NE(o.text.find("outside the range of ferguson-2022"), std::string::npos);
  // The study's own table says the same of the stated launches, beside what was measured.
  EXPECT_NEAR(s["range"]["spin_axis_deg"][1].get<double>(), 8, 1e-9);
  const auto& off = s["compare"]["differences"][0];
  EXPECT_EQ(off["points"], 1);
  EXPECT_NEAR(off["mean"].get<double>(), drive["carry_yd"].get<double>() - 270, 1e-9);
  const hosel::post::Sheet by_law = hosel::post::read_csv(dir / "out" / "flights.csv");
  EXPECT_EQ(by_law.rows(), 4U) << "two launches by two laws";
  const auto pictured = [&] { return fs::exists(dir / "out" / "figures" / "flight-drive.gp"); };
  EXPECT_TRUE(pictured());
  fs::remove_all(dir / "out");
  ASSERT_EQ(command("run " + (dir / "case").string() + " --set figures=false --out " + (dir / "out").string()).status,
            0);
  EXPECT_TRUE(fs::exists(dir / "out" / "flights.csv"));
  EXPECT_FALSE(pictured());
}

TEST(FlightCase, StatedLaunchesAreSweptAsBlowsAre) {
  const auto s = run("flight_sweep",
                     "kind = \"study\"\noutputs = [\"ball_speed_mps\", \"carry_m\"]\n"
                     "[launch]\nball_speed_mps = 60\nlaunch_angle_deg = 12\nspin_rate_rpm = 2500\n"
                     "[flight]\n[[axis]]\nkey = \"launch.ball_speed_mps\"\nvalues = [50, 60, 70]\n");
  EXPECT_EQ(s["failed"], 0);
  EXPECT_FALSE(s.contains("launches")) << "a budget where the case asks for one";
  EXPECT_NEAR(s["range"]["ball_speed_mps"][0].get<double>(), 50, 1e-9);
  EXPECT_NEAR(s["range"]["ball_speed_mps"][1].get<double>(), 70, 1e-9);
  const std::string struck = study_of_blow("[\"carry_m\"]");
  const auto blow = run("flight_swept", struck +
                                            "[launch]\nball_speed_mps = 70\nlaunch_angle_deg = 12\nazimuth_deg = 0\n"
                                            "spin_rate_rpm = 2500\n[flight]\n[[variant]]\nname = \"stated\"\n");
  EXPECT_NEAR(s["range"]["carry_m"][1].get<double>(), blow["range"]["carry_m"][1].get<double>(), 1e-9)
      << "as the launch in place of a model's";
}

/// A level launch below raised ground comes no higher, as one downwards does.
TEST(FlightCase, ABallThatIsLaunchedLevelDoesNotRise) {
  for (const char* angle : {"-1", "0"}) {
    const auto s =
        run("flight_level", fmt::format("kind = \"study\"\noutputs = [\"ball_speed_mps\", \"carry_m\"]\n[launch]\n"
                                        "ball_speed_mps = 60\nspin_rate_rpm = 500\nlaunch_angle_deg = {}\n[flight]\n"
                                        "[flight.ground]\nheight_m = 1\n[[axis]]\nkey = \"launch.ball_speed_mps\"\n"
                                        "values = [50, 60]\n",
                                        angle));
    EXPECT_EQ(s["failed"], 0) << angle;
    EXPECT_EQ(s["points"], 2);
  }
}

TEST(FlightCase, OfAStatedLaunchNothingOfABlowIsKnown) {
  const std::string launch = "[launch]\nball_speed_mps = 60\nlaunch_angle_deg = 12\nspin_rate_rpm = 2500\n[flight]\n";
  std::string sixty_one = "[61";
  for (int k = 0; k < 60; ++k) sixty_one += ", " + std::to_string(k + 1);
  const std::string axis = "[[axis]]\nkey = \"launch.ball_speed_mps\"\nvalues = ", few = axis + "[50, 60]\n";
  for (const auto& [text, says] :
       {std::pair{"outputs = [\"smash_factor\"]\n" + launch + few, "nothing of a blow is called 'smash_factor'"},
        {"outputs = [\"carry_m\"]\nmatched_launch = true\n" + launch + few, "matched_launch"},
        {"outputs = [\"carry_m\"]\n" + launch + few + "[delivery]\nclub_speed_mps = 40\n", "delivery"},
        {"outputs = [\"carry_m\"]\n" + launch + "beside = [\"libgolf\"]\n" + axis + sixty_one + "]\n", "60 at most"}}) {
    const fs::path dir = fresh_directory("flight_launch_alone");
    write(dir / "case.toml", "kind = \"study\"\n" + text);
    const Outcome o = command("check " + dir.string());
    EXPECT_EQ(o.status, 2) << text << o.text;
    EXPECT_NE(o.text.find(says), std::string::npos) << o.text;
  }
}

TEST(FlightCase, AStudyOfBlowsTakesNoErrorOfALaunch) {
  const std::string struck = study_of_blow("[\"carry_m\"]");
  const std::string varied = "[[variant]]\nname = \"stated\"\n[flight]\n";
  for (const auto& [text, status] : {std::pair{"", 0},
                                     {"beside = [\"libgolf\"]\n", 2},
                                     {"[[flight.launch_error]]\nsource = \"radar\"\nspin_rate_rpm = 50\n", 2}}) {
    const fs::path dir = fresh_directory("flight_blow_errors");
    write(dir / "case.toml", struck + varied + text);
    const Outcome o = command("check " + dir.string());
    EXPECT_EQ(o.status, status) << text << o.text;
    EXPECT_EQ(o.text.find("tell of a stated launch") != std::string::npos, status == 2) << o.text;
  }
}

/// The ball lands, and then bounces on for ever, or comes faster than the turf's law knows: the flight is an answer,
/// and the reason why there is no total is told.
TEST(FlightCase, AFlightWhoseRunHasNoEndHasACarry) {
  for (const auto& [flight, set, why] :
       {std::tuple{"ground.slope_deg = -3.5\n", "", "on this slope a bouncing ball does not come to rest"},
        {"", " --set delivery.dynamic_loft_deg=1 --set delivery.attack_angle_deg=-1 --set delivery.club_speed_mps=70",
         "above 54 m/s the turf's law turns the ball back"}}) {
    const fs::path dir = fresh_directory("flight_no_run");
    const std::string tables = std::string("[flight]\n") + flight + "[flight.turf]\n";
    write(dir / "case.toml", kEccentricBlow + tables);
    const auto run = [&] { return command("run " + dir.string() + " --force --out " + (dir / "out").string() + set); };
    const Outcome o = run();
    ASSERT_EQ(o.status, 0) << o.text;
    EXPECT_NE(o.text.find(std::string("warning: rigid-eccentric: the carry has no total: bounce and roll: ") + why),
              std::string::npos)
        << o.text;
    const auto shot = nlohmann::json::parse(content(dir / "out/summary.json"))["flights"]["rigid-eccentric"];
    EXPECT_GT(shot["carry_yd"].get<double>(), 10);
    EXPECT_FALSE(shot.contains("total_yd"));
    // A study says the same, and does not ask for the turf that is there.
    write(dir / "case.toml", study_of_blow("[\"carry_m\", \"total_m\"]") + tables +
                                 "[[axis]]\nkey = \"delivery.club_path_deg\"\nvalues = [0, 0.1]\n");
    const Outcome points = run();
    ASSERT_EQ(points.status, 0) << points.text;
    EXPECT_NE(points.text.find("2 of 2 points: a flight without a total."), std::string::npos) << points.text;
    EXPECT_NE(points.text.find(why), std::string::npos) << points.text;
    EXPECT_NE(points.text.find("no point has it"), std::string::npos) << points.text;
    EXPECT_EQ(points.text.find("needs [flight.turf]"), std::string::npos) << points.text;
    EXPECT_EQ(CsvFile(dir / "out/points.csv").text("carry_m", 1).empty(), false);
  }
}

/// A law beside the case's is as published: what multiplies the case's own is named with it.
TEST(FlightCase, AFactorOnTheLawIsTold) {
  Outcome o;
  run("flight_factor", kEccentricBlow + "[flight]\ndrag_scale = 0.9\n", &o);
  EXPECT_NE(o.text.find("ferguson-2022 (drag x 0.9) in air of"), std::string::npos) << o.text;
}

TEST(FlightCase, ABadTableIsOneLine) {
  for (const auto& [text, says] : {std::pair{"law = \"fergusen-2022\"\n", "did you mean 'ferguson-2022'"},
                                   {"units = \"feet\"\n", "allowed: yards, metres"},
                                   {"temperature_degC = 99.0\n", "out of range"},
                                   {"[flight.wind]\nspeed_mps = 3.0\n", "towards"},
                                   {"[flight.turf]\n[flight.ground]\nslope_deg = 5.0\n", "does not come to rest"}}) {
    const fs::path dir = fresh_directory("flight_bad");
    write(dir / "case.toml", kEccentricBlow + "[flight]\n" + text);
    const Outcome o = command("check " + dir.string());
    EXPECT_EQ(o.status, 2) << text;
    EXPECT_NE(o.text.find(says), std::string::npos) << o.text;
  }
}

}  // namespace
