// The loop whose base is the flight alone: what the law, the air, the wind or the record of the spin's axis lack is
// named from launches and landings, beside what every shot and every group of shots has of its own. The flights are
// made by an integration of the test's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <random>
#include <utility>
#include <vector>

#include "loop/flights/problem.hpp"

namespace hosel::loop {
namespace {

/// What is true and not declared.
struct Hidden {
  double drag = 0, lift = 0, decay = 0, density = 0, wind_along = 0, wind_right = 0, axis = 0;
};

struct Landing {
  double carry, side, apex, time, angle;
};

/// Runge and Kutta's fourth order with steps of 10 ms, the landing by a cubic through the last step.
Landing reference(const Vec3& velocity, const Vec3& spin, const Ball& ball, const models::FlightLaw& law,
                  const models::Air& air, const Hidden& h, double along, double right, double own_drag) {
  using State = Eigen::Matrix<double, 7, 1>;
  const double area = kPi * ball.radius * ball.radius, rho = air.density * (1 + h.density);
  const Vec3 axis = spin.normalized();
  const auto rate = [&](const State& y) {
    const double z = std::max(0.0, y[2]), share = std::log(1 + z / 0.03) / std::log(1 + 10 / 0.03);
    const Vec3 u = y.segment<3>(3) - share * Vec3(along + h.wind_along, -right - h.wind_right, 0);
    const double speed = u.norm();
    const auto k = law.at(2 * ball.radius * rho * speed / air.viscosity, spin.norm() * y[6] * ball.radius / speed);
    State d;
    d.head<3>() = y.segment<3>(3);
    d.segment<3>(3) = 0.5 * rho * area / ball.mass * speed *
                      (k.lift * (1 + h.lift) * axis.cross(u) - k.drag * (1 + h.drag) * (1 + own_drag) * u);
    d[5] -= kGravity;
    d[6] = -(law.decay.travel * speed / ball.radius + h.decay) * y[6];
    return d;
  };
  State y;
  y << Vec3::Zero(), velocity, 1;
  constexpr double dt = 0.01;
  Landing out{};
  for (double t = 0;; t += dt) {
    const State k1 = rate(y), k2 = rate(y + dt / 2 * k1), k3 = rate(y + dt / 2 * k2), k4 = rate(y + dt * k3);
    const State next = y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    out.apex = std::max(out.apex, y[2] + std::pow(std::max(0.0, y[5]), 2) / (2 * kGravity) * (y[5] < 0.2));
    if (next[2] < 0 && t > 0.5) {
      double s = y[2] / (y[2] - next[2]);
      for (int i = 0; i < 30; ++i) {  // of z(s) between the two, by its values and slopes
        const auto z = [&](double x) {
          return (2 * x * x * x - 3 * x * x + 1) * y[2] + (x * x * x - 2 * x * x + x) * dt * y[5] +
                 (3 * x * x - 2 * x * x * x) * next[2] + (x * x * x - x * x) * dt * next[5];
        };
        s -= z(s) / ((z(s + 1e-6) - z(s - 1e-6)) / 2e-6);
      }
      const State at = y + s * (next - y);
      out.carry = std::hypot(at[0], at[1]);
      out.side = -at[1];
      out.time = t + s * dt;
      out.angle = std::atan2(-at[5], std::hypot(at[3], at[4]));
      return out;
    }
    y = next;
  }
}

/// Drives of a few groups, each in a wind of its own, with balls of their own; read with the errors that are declared.
FlightCase drives(const Hidden& h, int flights, unsigned seed, double group_wind = 1.5) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  FlightCase c;
  c.base = "flight";
  c.conditions.law = models::find_flight_law("radar-2022")->make();
  c.unknown.wind = group_wind;
  c.unknown.drag = 0.02;
  c.group_by = {"hole"};
  c.noise = {{"ball_speed_mps", 0.15}, {"launch_angle_deg", 0.1}, {"azimuth_deg", 0.1}, {"spin_rate_rpm", 50},
             {"spin_axis_deg", 1.5},   {"carry_m", 1.5},          {"side_m", 1.5},      {"apex_m", 0.4},
             {"flight_time_s", 0.04},  {"landing_angle_deg", 0.7}};
  post::Sheet sheet{.file = "drives", .names = {"shot", "hole"}, .columns = {}, .lines = {}};
  for (const char* name : {"ball_speed_mps", "launch_angle_deg", "azimuth_deg", "spin_rate_rpm", "spin_axis_deg",
                           "carry_m", "side_m", "apex_m", "flight_time_s", "landing_angle_deg"})
    sheet.names.emplace_back(name);
  sheet.columns.resize(sheet.names.size());
  constexpr int groups = 5;
  std::array<double, groups> along{}, right{};
  for (int g = 0; g < groups; ++g)
    along[std::size_t(g)] = group_wind * gauss(random), right[std::size_t(g)] = group_wind * gauss(random);
  for (int i = 0; i < flights; ++i) {
    const auto g = std::size_t(i % groups);
    const double speed = 74 + 4 * gauss(random), up = radians(11.5 + 2.5 * gauss(random)),
                 azimuth = radians(2.5 * gauss(random)), spin = (2700 + 500 * gauss(random)) * kRadPerSecPerRpm,
                 axis = radians(7 * gauss(random));
    const Vec3 v = speed * Vec3(std::cos(up) * std::cos(azimuth), -std::cos(up) * std::sin(azimuth), std::sin(up));
    const Vec3 w = spin * Vec3(0, -std::cos(axis + h.axis), -std::sin(axis + h.axis));
    const Landing l =
        reference(v, w, c.ball, c.conditions.law, c.conditions.air, h, along[g], right[g], 0.02 * gauss(random));
    const std::array<double, 10> read = {
        speed + 0.15 * gauss(random),           degrees(up) + 0.1 * gauss(random),
        degrees(azimuth) + 0.1 * gauss(random), spin / kRadPerSecPerRpm + 50 * gauss(random),
        degrees(axis) + 1.5 * gauss(random),    l.carry + 1.5 * gauss(random),
        l.side + 1.5 * gauss(random),           l.apex + 0.4 * gauss(random),
        l.time + 0.04 * gauss(random),          degrees(l.angle) + 0.7 * gauss(random)};
    sheet.columns[0].push_back(std::to_string(i + 1));
    sheet.columns[1].push_back(std::string("h") + std::to_string(g));
    for (std::size_t k = 0; k < read.size(); ++k) sheet.columns[k + 2].push_back(std::to_string(read[k]));
    sheet.lines.push_back(std::size_t(i) + 2);
  }
  c.shots = read_shots(sheet, true);
  return c;
}

enum class Said { alone, tied, nothing, wrong };

Said what(const LoopResult& r, const std::string& truth) {
  const bool tied = std::ranges::any_of(r.ties, [&](const auto& t) { return std::ranges::count(t, truth) > 0; });
  const bool named = std::ranges::count(r.adopted, truth) > 0;
  for (const std::string& e : r.adopted)
    if (e != truth) return Said::wrong;
  return named ? Said::alone : tied ? Said::tied : Said::nothing;
}

std::string told(const LoopResult& r) {
  std::string text(name(r.verdict));
  for (const auto& e : r.adopted) text += " +" + e;
  for (const auto& t : r.ties) {
    text += " tie:";
    for (const auto& e : t) text += " " + e;
  }
  for (const auto& u : r.unexplained) text += " at " + u.channel + "/" + u.regressor + " (" + u.detail + ")";
  return text;
}

double value(const LoopResult& r, const std::string& parameter) {
  const auto all = r.selection.chosen.model.parameters();
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k]->name == parameter) return r.selection.chosen.p[Eigen::Index(k)];
  return std::nan("");
}

TEST(FlightBase, TheReferenceIsTheFlight) {
  // Two integrations of one law: what they differ by is the larger of their errors, a centimetre.
  const Ball ball;
  models::FlightConditions c{.law = models::find_flight_law("radar-2022")->make()};
  Launch l;
  l.velocity = Vec3(73, 2, 15);
  l.spin = Vec3(0, -280, -30);
  c.wind = {.speed = 3, .towards = radians(60)};
  const models::Flight f = models::fly(l, ball, c, {.tolerance = 1e-9});
  const Landing r =
      reference(l.velocity, l.spin, ball, c.law, c.air, {}, 3 * std::cos(radians(60)), 3 * std::sin(radians(60)), 0);
  EXPECT_GT(f.carry, 200);
  EXPECT_NEAR(f.carry, r.carry, 0.02);
  EXPECT_NEAR(f.side, r.side, 0.02);
  EXPECT_NEAR(f.apex, r.apex, 0.02);
  EXPECT_NEAR(f.time, r.time, 1e-3);
  EXPECT_NEAR(f.landing_angle, r.angle, 1e-3);
}

/// An effect that is hidden, with its parameters.
struct Named {
  const char* effect;
  Hidden hidden;
  std::vector<std::pair<const char*, double>> sizes;
  int flights = 30;  ///< a tilt and a wind from the side part at some more
};
void PrintTo(const Named& n, std::ostream* out) { *out << n.effect; }

class FlightBaseNames : public testing::TestWithParam<Named> {};

TEST_P(FlightBaseNames, WhatIsHiddenAndItsSize) {
  const Named& n = GetParam();
  const LoopResult r = run(drives(n.hidden, n.flights, 2, 0.5));
  EXPECT_EQ(what(r, n.effect), Said::alone) << told(r);
  const auto& sd = r.candidates.front().sd;
  for (std::size_t k = 0; k < n.sizes.size(); ++k) {
    const auto [parameter, size] = n.sizes[k];
    EXPECT_NEAR(value(r, parameter), size, 3 * sd.at(k)) << parameter;
    EXPECT_LT(sd.at(k), std::abs(size) / 3) << parameter;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Loop, FlightBaseNames,
    testing::Values(Named{"drag-level", {.drag = 0.1}, {{"relative_drag", 0.1}}},
                    Named{"lift-law", {.lift = -0.12}, {{"relative_lift", -0.12}}},
                    Named{"air-density", {.density = -0.1}, {{"relative_density", -0.1}}},
                    Named{"wind", {.wind_along = -3, .wind_right = 2}, {{"wind_along", -3}, {"wind_to_the_right", 2}}},
                    Named{"spin-axis-bias", {.axis = radians(4)}, {{"tilt", radians(4)}}, 40},
                    Named{"spin-decay", {.decay = 0.1}, {{"change_of_rate", 0.1}}}),
    [](const auto& p) {
      std::string name = p.param.effect;
      std::ranges::replace(name, '-', '_');
      return name;
    });

/// One carry of a hole is wrong: it is that one, wherever it stands.
TEST(FlightBase, AWrongFlightIsFoundWhereverItStands) {
  for (const bool first : {true, false}) {
    FlightCase c = drives({}, 60, 4);
    const auto hole = std::ranges::find(c.shots.columns, "hole", &Column::name),
               carry = std::ranges::find(c.shots.columns, "carry_m", &Column::name);
    ASSERT_NE(carry, c.shots.columns.end());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < hole->text.size(); ++i)
      if (hole->text[i] == "h2" && (!first || wrong == 0)) wrong = i;
    carry->value[wrong] += 14;
    const LoopResult r = run(c);
    ASSERT_EQ(r.flagged.size(), 1U) << first << ": " << told(r);
    EXPECT_EQ(r.flagged.front().row, int(wrong));
    EXPECT_EQ(r.flagged.front().column, "carry_m");
  }
}

/// A column that holds something else than its header says: factor on it and what is added [header's unit].
struct Misread {
  const char *column, *finding, *word;
  double factor = 1, more = 0;
  double beside = 0.06;  ///< of the drag, that the law lacks
};
void PrintTo(const Misread& m, std::ostream* out) { *out << m.column << ' ' << m.finding; }

class FlightColumnsTold : public testing::TestWithParam<Misread> {};

/// Told with what it is instead, beside a drag that the law lacks too; as it should be it is not accused.
TEST_P(FlightColumnsTold, WhatTheyAreInstead) {
  const Misread& m = GetParam();
  for (const bool wrong : {true, false}) {
    FlightCase c = drives({.drag = m.beside}, 30, 5);
    for (Column& column : c.shots.columns)
      if (wrong && column.name == m.column)
        for (double& x : column.value) x = m.factor * x + m.more * column.si;
    const LoopResult r = run(c);
    ASSERT_EQ(r.columns.size(), wrong) << told(r);
    if (!wrong) continue;
    EXPECT_EQ(r.verdict, Verdict::unexplained);
    EXPECT_EQ(r.columns.front().column, m.column);
    EXPECT_EQ(r.columns.front().finding, m.finding) << r.columns.front().text;
    EXPECT_NE(r.columns.front().text.find(m.word), std::string::npos) << r.columns.front().text;
  }
}

INSTANTIATE_TEST_SUITE_P(Loop, FlightColumnsTold,
                         testing::Values(Misread{"carry_m", "unit", "like yd", 1 / 0.9144},
                                         Misread{"apex_m", "unit", "like feet", 1 / 0.3048},
                                         Misread{"ball_speed_mps", "unit", "like mph", 1 / kMpsPerMph},
                                         Misread{"side_m", "sign", "other sign", -1},
                                         Misread{"spin_axis_deg", "sign", "other sign", -1},
                                         Misread{"spin_rate_rpm", "scale", "reads 0.", 0.5, 0, 0},
                                         Misread{"launch_angle_deg", "offset", "too high", 1, 3, 0},
                                         Misread{"landing_angle_deg", "offset", "too high", 1, 5, 0}),
                         [](const auto& p) { return std::string(p.param.column) + "_" + p.param.finding; });

/// Spins that were counted twice: each is told, with what it should be.
TEST(FlightBase, SpinsCountedTwiceAreToldOneByOne) {
  FlightCase c = drives({}, 60, 4, 0.5);
  const auto spin = std::ranges::find(c.shots.columns, "spin_rate_rpm", &Column::name);
  ASSERT_NE(spin, c.shots.columns.end());
  for (const std::size_t row : {3, 20, 32, 55}) spin->value[row] *= 2;
  const LoopResult r = run(c);
  EXPECT_EQ(r.verdict, Verdict::no_residual) << told(r);
  ASSERT_EQ(r.flagged.size(), 4U);
  for (const Flag& f : r.flagged) {
    EXPECT_EQ(f.column, "spin_rate_rpm");
    EXPECT_NE(f.reason.find("half as large"), std::string::npos) << f.reason;
  }
}

/// A carry that was written a row late, on more flights than are looked at: told. Sides in feet, whose spread is far
/// below what an unknown tilt makes of them, are no sides in metres.
TEST(FlightBase, AColumnMovedByARowIsToldAndAQuietOneIsNotAccused) {
  FlightCase c = drives({}, 100, 9);
  const auto carry = std::ranges::find(c.shots.columns, "carry_m", &Column::name);
  ASSERT_NE(carry, c.shots.columns.end());
  std::rotate(carry->value.begin(), carry->value.end() - 1, carry->value.end());
  const LoopResult moved = run(c);
  ASSERT_EQ(moved.columns.size(), 1U) << told(moved);
  EXPECT_EQ(moved.columns.front().column, "carry_m");
  EXPECT_EQ(moved.columns.front().finding, "rows");

  FlightCase quiet = drives({}, 45, 10, 0);
  std::erase_if(quiet.shots.columns, [](const Column& column) { return column.name == "spin_axis_deg"; });
  quiet.noise.erase("spin_axis_deg");
  quiet.unknown.axis = radians(30);
  quiet.noise.erase("side_m");
  quiet.noise["side_ft"] = 5;
  for (Column& column : quiet.shots.columns)
    if (column.name == "side_m") {
      column.name = "side_ft", column.si = 0.3048;
      for (double& x : column.value) x *= 0.2;
    }
  EXPECT_TRUE(run(quiet).columns.empty());
}

/// Few flights whose noise is not declared fit this or that slip by chance: no column is accused.
TEST(FlightBase, FewFlightsAccuseNoColumn) {
  for (const int flights : {8, 11, 14, 20})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      FlightCase c = drives({}, flights, seed);
      c.noise.clear();
      const LoopResult r = run(c);
      EXPECT_TRUE(r.columns.empty()) << flights << " flights, seed " << seed << ": " << r.columns.front().text;
    }
}

/// A launch without an azimuth did not set out on the target line: where it lands to the side says nothing.
TEST(FlightBase, ASideWithoutAnAzimuthIsNotJudged) {
  FlightCase c = drives({}, 44, 2);
  const auto azimuth = std::ranges::find(c.shots.columns, "azimuth_deg", &Column::name);
  ASSERT_NE(azimuth, c.shots.columns.end());
  std::vector<double> sizes;
  for (const double x : azimuth->value) sizes.push_back(std::abs(x));
  std::ranges::sort(sizes);
  for (double& x : azimuth->value)
    if (std::abs(x) >= sizes[40]) x = kNaN;
  const LoopResult some = run(c);
  EXPECT_TRUE(some.flagged.empty()) << told(some);
  EXPECT_TRUE(
      std::ranges::any_of(some.notes, [](const std::string& n) { return n.starts_with("4 rows have no azimuth"); }));

  std::erase_if(c.shots.columns, [](const Column& column) { return column.name == "azimuth_deg"; });
  c.noise.erase("azimuth_deg");
  const LoopResult none = run(c);
  EXPECT_EQ(none.used, 44) << told(none);
  for (const ChannelResult& channel : none.channels) EXPECT_FALSE(channel.refuted) << channel.name;
  EXPECT_TRUE(
      std::ranges::any_of(none.notes, [](const std::string& n) { return n.starts_with("44 rows have no azimuth"); }));
}

/// Nothing is told of the wind of a group whose only flight does not count.
TEST(FlightBase, AGroupWithoutFlightsHasNoWind) {
  FlightCase c = drives({}, 44, 2);
  for (Column& column : c.shots.columns)
    if (column.name == "hole") column.text[0] = "lost";
    else if (column.name == "carry_m") column.value[0] *= 0.5;
  const LoopResult r = run(c);
  ASSERT_EQ(r.flagged.size(), 1U) << told(r);
  ASSERT_EQ(r.flagged.front().row, 0);
  EXPECT_TRUE(std::ranges::none_of(r.notes, [](const std::string& n) { return n.starts_with("wind of lost"); }));
  EXPECT_TRUE(std::ranges::any_of(r.notes, [](const std::string& n) { return n.starts_with("wind of h0"); }));
}

/// A backspin without a sidespin is not what the spin is taken from where there is a rate.
TEST(FlightBase, TheNoiseOfASpinIsThatOfTheColumnItIsTakenFrom) {
  const FlightCase c = drives({}, 20, 2);
  FlightCase with = c;
  Column back = *c.shots.find_stem("spin_rate");
  back.name = "backspin_rpm", back.stem = "backspin";
  with.shots.columns.push_back(back);
  EXPECT_DOUBLE_EQ(FlightProblem(with).sigma(0, 0), FlightProblem(c).sigma(0, 0));
}

/// Winds far beyond what is declared of them are told, though each flight is explained by one.
TEST(FlightBase, WindsBeyondTheDeclaredAreTold) {
  FlightCase c = drives({}, 60, 6, 3);
  c.unknown.wind = 1;
  const LoopResult r = run(c);
  EXPECT_EQ(r.verdict, Verdict::unexplained) << told(r);
  EXPECT_TRUE(std::ranges::any_of(r.unexplained, [](const Location& l) {
    return l.detail.starts_with("the winds of the groups are");
  })) << told(r);
}

/// An apex in feet under metres: no ball flies as it asks for, and there is a report.
TEST(FlightBase, ReadingsThatNoBallFliesEndInAReport) {
  FlightCase c = drives({.drag = 0.08}, 20, 8);
  for (Column& column : c.shots.columns)
    if (column.name == "apex_m")
      for (double& x : column.value) x *= 3.6;
  EXPECT_EQ(run(c).verdict, Verdict::unexplained);
}

TEST(FlightBase, OneOfTwoClustersIsHeldOut) {
  FlightCase c = drives({}, 60, 3, 0);
  for (Column& column : c.shots.columns)
    if (column.name == "hole")
      for (std::size_t i = 0; i < column.text.size(); ++i) column.text[i] = i % 2 ? "odd" : "even";
  c.split.by = "hole";
  EXPECT_EQ(run(c).holdout, 30);
}

}  // namespace
}  // namespace hosel::loop
