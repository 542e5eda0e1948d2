// Units as people read them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "golf/units.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"

namespace {

using hosel::post::label;
using hosel::post::symbol;

TEST(Labels, UnitsAreRaisedOnce) {
  EXPECT_EQ(symbol("mps"), "m/s");
  EXPECT_EQ(symbol("kg_m2"), "kg m²");
  EXPECT_EQ(symbol("1/m^2"), "1/m²");
  EXPECT_EQ(label("contact.restitution_falloff_per_m2"), "restitution falloff [1/m²]");
  EXPECT_EQ(label("weather.temperature_degC"), "temperature [°C]");
  EXPECT_EQ(label("launch_angle_slope_deg_per_mm"), "launch angle slope [deg/mm]");
  EXPECT_EQ(label("flight.wind.speed_mps"), "wind speed [m/s]");
  EXPECT_EQ(label("flight.wind.towards_deg"), "wind towards [deg]");
  EXPECT_EQ(label("ball_speed_mps.4"), "ball speed 4 [m/s]");  // of a list in a summary
  EXPECT_EQ(symbol("kg m^2"), "kg m²");
  EXPECT_EQ(symbol("N_s_per_m"), "N s/m");
  EXPECT_EQ(label("normal_impulse_N_s"), "normal impulse [N s]");
  EXPECT_EQ(hosel::post::spoken_key("normal_impulse_N_s").words, "normal impulse");
  EXPECT_EQ(hosel::post::spoken_key("hosel_moment_impulse_x_N_m_s").unit, "N m s");
}

TEST(Labels, OneIsNoPlural) {
  EXPECT_EQ(hosel::post::counted(1, "shot"), "1 shot");
  EXPECT_EQ(hosel::post::counted(0, "place"), "0 places");
}

TEST(Channels, AnglesAreComparedOnTheCircle) {
  using namespace hosel::post;
  const Channel &axis = *find_channel("spin_axis"), &speed = *find_channel("ball_speed");
  EXPECT_NEAR(difference(axis, 179.5, -179.5), -1, 1e-12);
  EXPECT_NEAR(difference(axis, -180, 180), 0, 1e-12);
  EXPECT_EQ(difference(axis, 10.25, -20.5), 30.75);
  EXPECT_EQ(difference(speed, 400, 10), 390);
}

/// A top spin whose axis is at 179.5 deg on the fine mesh and at -179.5 deg on the coarse one errs by one degree.
TEST(Channels, TheErrorOfAnAngleIsTheShorterWayRound) {
  const auto tilted = [](double degrees) {
    const double a = hosel::radians(degrees);
    return hosel::Launch{.velocity = hosel::Vec3(60, 0, 5), .spin = -200 * hosel::Vec3(0, std::cos(a), std::sin(a))};
  };
  const auto table = hosel::post::launch_table({{.title = "m", .launch = tilted(179.5), .coarser = tilted(-179.5)}});
  const auto row = std::ranges::find(table.rows, "spin axis [deg]", [](const auto& r) { return r.front(); });
  ASSERT_NE(row, table.rows.end());
  EXPECT_EQ(row->back(), "179.50 +-1.00");
}

/// As the cards above the table have it: rounded up, never zero; and no zero has a sign.
TEST(LaunchTable, StatesUpperBoundsAndZerosWithoutASign) {
  const hosel::Launch fine{.velocity = hosel::Vec3(60, 0, 5), .spin = hosel::Vec3(0, -200, 0)};
  hosel::Launch coarse = fine;
  coarse.velocity.x() += 0.0213;
  const auto table = hosel::post::launch_table(
      {{.title = "m", .launch = fine, .oblique = {.tangential_restitution = -2e-4}, .coarser = coarse}});
  const auto said = [&](const char* name) {
    const auto row = std::ranges::find(table.rows, name, [](const auto& r) { return r.front(); });
    return row == table.rows.end() ? std::string("-") : row->back();
  };
  EXPECT_EQ(said("ball speed [m/s]"), "60.21 +-0.03");
  EXPECT_EQ(said("riflespin [rpm]").substr(1), " +-1");
  EXPECT_EQ(said("e_t [-]"), "0.000");
}

/// One ball does not stop, and the others' totals are told all the same.
TEST(LaunchTable, ARowIsThereWhereAnyColumnHasIt) {
  const hosel::post::ShotFlight lands{}, rests{.flight = {}, .run = hosel::models::Run{.total = 200}};
  const auto table = hosel::post::launch_table(
      {{.title = "a", .launch = {}, .flight = lands}, {.title = "b", .launch = {}, .flight = rests}});
  const auto row = std::ranges::find(table.rows, "total [yd]", [](const auto& r) { return r.front(); });
  ASSERT_NE(row, table.rows.end());
  EXPECT_EQ((*row)[1], "-");
  EXPECT_EQ((*row)[2], "218.7");
}

}  // namespace
