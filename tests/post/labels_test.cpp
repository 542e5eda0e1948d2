// Units as people read them.
#include <gtest/gtest.h>

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
  EXPECT_EQ(label("ball_speed_mps.4"), "ball speed 4 [m/s]");  // of a list in a summary
  EXPECT_EQ(symbol("kg m^2"), "kg m²");
  EXPECT_EQ(symbol("N_s_per_m"), "N s/m");
}

TEST(Channels, AnglesAreComparedOnTheCircle) {
  using namespace hosel::post;
  const Channel &axis = *find_channel("spin_axis"), &speed = *find_channel("ball_speed");
  EXPECT_NEAR(difference(axis, 179.5, -179.5), -1, 1e-12);
  EXPECT_NEAR(difference(axis, -180, 180), 0, 1e-12);
  EXPECT_EQ(difference(axis, 10.25, -20.5), 30.75);
  EXPECT_EQ(difference(speed, 400, 10), 390);
}

}  // namespace
