// Measured flights close the loop: what the flight law, the air or the wind lack is named, from the launches that a
// monitor saw.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "loop/shots/run.hpp"
#include "models/registry.hpp"

namespace hosel::loop {
namespace {

namespace fs = std::filesystem;

/// Two dozen blows, their launches and flights as instruments read them; `truth` is the air that they met, `spread` how
/// much the blows differ.
std::string csv(const models::FlightConditions& truth, double spread, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  const auto model = models::find("rigid-eccentric")->make({});
  std::string text =
      "shot,club_speed_mps,attack_angle_deg,dynamic_loft_deg,face_angle_deg,impact_toe_mm,ball_speed_mps,"
      "launch_angle_deg,azimuth_deg,backspin_rpm,sidespin_rpm,carry_m,side_m,apex_m,flight_time_s,landing_angle_deg\n";
  for (int i = 0; i < 24; ++i) {
    Blow b;
    b.club.head = {.mass = 0.2,
                   .cg = Vec3(-0.035, 0, 0),
                   .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(),
                   .face = {0.3, 0.3}};
    b.delivery = {.club_speed = 44 + spread * 4 * gauss(random),
                  .attack_angle = radians(spread * 2 * gauss(random)),
                  .dynamic_loft = radians(18 + spread * 5 * gauss(random)),
                  .face_angle = radians(spread * 2 * gauss(random)),
                  .impact_toe = spread * 0.008 * gauss(random)};
    Launch l = model->launch(b);
    l.spin.x() = 0;  // no monitor sees it
    const models::Flight f = models::fly(l, b.ball, truth);
    char line[512];
    std::snprintf(line, sizeof line, "%d,%.3f,%.3f,%.3f,%.3f,%.2f,%.3f,%.3f,%.3f,%.1f,%.1f,%.2f,%.2f,%.2f,%.3f,%.2f\n",
                  i + 1, b.delivery.club_speed, degrees(b.delivery.attack_angle), degrees(b.delivery.dynamic_loft),
                  degrees(b.delivery.face_angle), 1e3 * b.delivery.impact_toe, l.ball_speed() + 0.1 * gauss(random),
                  degrees(l.launch_angle()) + 0.1 * gauss(random), degrees(l.azimuth()) + 0.1 * gauss(random),
                  rpm(l.backspin()) + 30 * gauss(random), rpm(l.sidespin()) + 30 * gauss(random),
                  f.carry + 1.0 * gauss(random), f.side + 0.5 * gauss(random), f.apex + 0.3 * gauss(random),
                  f.time + 0.03 * gauss(random), degrees(f.landing_angle) + 0.4 * gauss(random));
    text += line;
  }
  return text;
}

/// `only`: the one reading of the flight that is kept; none: all. `unaimed`: the azimuths so many degrees from the
/// target line are not recorded.
LoopResult loop_on(const models::FlightConditions& truth, const std::string& only = "", double spread = 1,
                   unsigned seed = 1, double unaimed = 1000) {
  const fs::path file = fs::path(testing::TempDir()) / ("hosel_flight_loop_" + std::to_string(getpid()) + ".csv");
  std::ofstream(file, std::ios::binary) << csv(truth, spread, seed);
  static const auto model = models::find("rigid-eccentric")->make({});
  ShotCase c;
  c.base = "rigid-eccentric";
  c.model = model.get();
  c.head_mass_declared = c.inertia_declared = true;
  c.blow.club.head = {
      .mass = 0.2, .cg = Vec3(-0.035, 0, 0), .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal(), .face = {0.3, 0.3}};
  c.flight.emplace();
  c.shots = read_shots(post::read_csv(file), true);
  fs::remove(file);
  for (double& x : c.shots.find("azimuth_deg")->value)
    if (std::abs(x) >= radians(unaimed)) x = std::nan("");
  if (!only.empty())
    std::erase_if(c.shots.columns, [&](const Column& k) {
      const auto output = output_of(k.stem);
      return output && of_flight(*output) && k.stem != only;
    });
  c.noise = {{"ball_speed_mps", 0.1}, {"launch_angle_deg", 0.1}, {"azimuth_deg", 0.1}, {"backspin_rpm", 30},
             {"sidespin_rpm", 30},    {"carry_m", 1.0},          {"side_m", 0.5},      {"apex_m", 0.3},
             {"flight_time_s", 0.03}, {"landing_angle_deg", 0.4}};
  return run(c);
}

double parameter_value(const LoopResult& r, const std::string& parameter) {
  const auto all = r.selection.chosen.model.parameters();
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k]->name == parameter) return r.selection.chosen.p[Eigen::Index(k)];
  return std::nan("");
}

TEST(FlightEffects, NothingHiddenNothingAdopted) {
  const LoopResult r = loop_on({});
  EXPECT_EQ(r.used, 24);
  EXPECT_EQ(r.channels.size(), 10U);
  EXPECT_TRUE(r.adopted.empty());
  EXPECT_EQ(r.verdict, Verdict::no_residual);
}

/// A shot without an azimuth did not set out on the target line: its side is not judged.
TEST(FlightEffects, ASideWithoutAnAzimuthIsNotJudged) {
  const auto tells = [](const LoopResult& r, const std::string& of) {
    return std::ranges::any_of(r.notes, [&](const std::string& n) {
      return n.starts_with("side_m: " + of) && n.ends_with("not judged there");
    });
  };
  const LoopResult some = loop_on({}, "", 1, 1, 2), none = loop_on({}, "", 1, 1, 0);
  EXPECT_EQ(some.used, 24);
  EXPECT_EQ(some.channels.size(), 10U);
  EXPECT_TRUE(some.flagged.empty());
  EXPECT_EQ(some.verdict, Verdict::no_residual);
  EXPECT_TRUE(tells(some, ""));
  EXPECT_EQ(none.channels.size(), 8U) << "neither azimuth nor side";
  EXPECT_TRUE(none.flagged.empty());
  EXPECT_TRUE(tells(none, "24 rows have no azimuth"));
}

TEST(FlightEffects, NamesDrag) {
  models::FlightConditions truth;
  truth.law.drag_scale = 1.06;
  const LoopResult r = loop_on(truth);
  EXPECT_EQ(r.adopted, std::vector<std::string>{"drag-level"});
  EXPECT_NEAR(parameter_value(r, "relative_drag"), 0.06, 0.01);
}

TEST(FlightEffects, NamesLift) {
  models::FlightConditions truth;
  truth.law.lift_scale = 0.9;
  const LoopResult r = loop_on(truth);
  EXPECT_EQ(r.adopted, std::vector<std::string>{"lift-law"});
  EXPECT_NEAR(parameter_value(r, "relative_lift"), -0.1, 0.01);
}

TEST(FlightEffects, NamesDensity) {
  models::FlightConditions truth;
  truth.air.density *= 0.92;
  const LoopResult r = loop_on(truth);
  EXPECT_EQ(r.adopted, std::vector<std::string>{"air-density"});
  EXPECT_NEAR(parameter_value(r, "relative_density"), -0.08, 0.01);
}

TEST(FlightEffects, NamesWind) {
  models::FlightConditions truth;
  truth.wind = {.speed = 3, .towards = radians(120)};
  const LoopResult r = loop_on(truth);
  EXPECT_EQ(r.adopted, std::vector<std::string>{"wind"});
  EXPECT_NEAR(parameter_value(r, "wind_along"), 3 * std::cos(radians(120)), 0.3);
  EXPECT_NEAR(parameter_value(r, "wind_to_the_right"), 3 * std::sin(radians(120)), 0.3);
}

/// One club and one swing: drag, lift, density and wind along the line all shorten the carry alike.
TEST(FlightEffects, CarryOfOneSwingDoesNotTellDragFromDensity) {
  models::FlightConditions truth;
  truth.law.drag_scale = 1.04;
  const LoopResult r = loop_on(truth, "carry", 0.1);
  EXPECT_EQ(r.channels.size(), 6U);
  EXPECT_EQ(r.verdict, Verdict::ambiguous);
  EXPECT_TRUE(r.adopted.empty());
  const auto tied = [&](const char* name) {
    return std::ranges::any_of(r.ties, [&](const auto& t) { return std::ranges::find(t, name) != t.end(); });
  };
  EXPECT_TRUE(tied("drag-level"));
  EXPECT_TRUE(tied("air-density"));
}

TEST(FlightEffects, TheLaunchIsSeenWholeOrNotAtAll) {
  post::Sheet sheet;
  sheet.file = "shots";
  sheet.names = {"ball_speed_mps", "launch_angle_deg", "spin_rate_rpm", "spin_axis_deg", "azimuth_deg"};
  sheet.columns = {{"70", "70", "70"}, {"12", "", "12"}, {"2500", "2500", ""}, {"-90", "0", "0"}, {"3", "3", "3"}};
  sheet.lines = {2, 3, 4};
  const Shots shots = read_shots(sheet);
  const auto first = seen_launch(shots, 0);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->ball_speed(), 70, 1e-12);
  EXPECT_NEAR(first->azimuth(), radians(3), 1e-12);
  EXPECT_NEAR(first->sidespin(), -2500 * kRadPerSecPerRpm, 1e-9);
  EXPECT_FALSE(seen_launch(shots, 1));
  EXPECT_FALSE(seen_launch(shots, 2));
}

TEST(FlightEffects, NamesTheDecayOfSpin) {
  models::FlightConditions truth;
  truth.law.decay.rate = 0.1;
  const LoopResult r = loop_on(truth);
  EXPECT_EQ(r.adopted, std::vector<std::string>{"spin-decay"});
  EXPECT_NEAR(parameter_value(r, "change_of_rate"), 0.1, 0.02);
}

}  // namespace
}  // namespace hosel::loop
