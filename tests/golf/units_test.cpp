#include "golf/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "golf/quantities.hpp"

namespace hosel {
namespace {

/// What the units are by their definitions (the yard and the pound of 1959, the SI brochure), not by the table.
const std::map<std::string, double> kBySi = {{"m", 1},
                                             {"mm", 1 / 1000.0},
                                             {"um", 1 / 1e6},
                                             {"yd", 3 * 12 * 25.4 / 1000},
                                             {"rad", 1},
                                             {"deg", std::atan(1) / 45},
                                             {"mps", 1},
                                             {"kmh", 1000 / 3600.0},
                                             {"mph", 1760 * 0.9144 / 3600},
                                             {"rad_per_s", 1},
                                             {"rpm", 8 * std::atan(1) / 60},
                                             {"deg_per_s", std::atan(1) / 45},
                                             {"kg", 1},
                                             {"g", 1 / 1000.0},
                                             {"s", 1},
                                             {"ms", 1 / 1000.0},
                                             {"us", 1 / 1e6},
                                             {"Hz", 1},
                                             {"kHz", 1000},
                                             {"cpm", 1 / 60.0},
                                             {"N", 1},
                                             {"kN", 1000},
                                             {"N_m", 1},
                                             {"Pa", 1},
                                             {"hPa", 100},
                                             {"kPa", 1000},
                                             {"MPa", 1e6},
                                             {"GPa", 1e9},
                                             {"kg_per_m3", 1},
                                             {"kg_m2", 1},
                                             {"g_cm2", 1e-3 * 1e-4},
                                             {"N_m2", 1},
                                             {"kg_per_m", 1},
                                             {"g_per_m", 1 / 1000.0},
                                             {"N_per_m", 1},
                                             {"MN_per_m", 1e6},
                                             {"N_m_per_rad", 1},
                                             {"N_s_per_m", 1},
                                             {"N_m_s_per_rad", 1},
                                             {"N_per_m3", 1},
                                             {"s_per_m", 1},
                                             {"m_per_s2", 1},
                                             {"J", 1},
                                             {"m2", 1},
                                             {"mm2", 1e-3 * 1e-3},
                                             {"pct", 1 / 100.0},
                                             {"in", 25.4 / 1000},
                                             {"ft", 12 * 25.4 / 1000},
                                             {"lb", 453.59237 / 1000},
                                             {"oz", 453.59237 / 16 / 1000},
                                             {"lbf", 453.59237 / 1000 * 9.80665}};

TEST(Units, AreWhatTheyAreDefinedToBe) {
  std::set<std::string> seen;
  for (const Unit& u : all_units()) {
    const std::string suffix(u.suffix);
    EXPECT_TRUE(seen.insert(suffix).second) << suffix << " stands twice";
    ASSERT_TRUE(kBySi.contains(suffix)) << suffix << " has no value here";
    EXPECT_NEAR(u.si / kBySi.at(suffix), 1, 4e-16) << suffix;  // two roundings
    EXPECT_FALSE(name(u.dimension).empty());
  }
  EXPECT_EQ(seen.size(), kBySi.size());
}

TEST(Units, TheLongestSuffixOfANameIsItsUnit) {
  // Every suffix ends a name, though some end in others (rad_per_s in s, N_m_per_rad in rad).
  for (const Unit& u : all_units()) {
    const SplitName split = split_unit("some_name_" + std::string(u.suffix));
    ASSERT_TRUE(split.unit) << u.suffix;
    EXPECT_EQ(split.unit->suffix, u.suffix);
    EXPECT_EQ(split.stem, "some_name");
  }
  for (const char* none : {"mass", "kg", "_kg", "mass_", "masskg", "", "spin_axis", "mass_KG"}) {
    EXPECT_FALSE(split_unit(none).unit) << none;
    EXPECT_EQ(split_unit(none).stem, none);
  }
}

TEST(Units, TurnIntoEachOther) {
  EXPECT_DOUBLE_EQ(radians(180), std::acos(-1));
  EXPECT_DOUBLE_EQ(degrees(radians(12.8)), 12.8);
  EXPECT_DOUBLE_EQ(rpm(2 * std::acos(-1)), 60);  // a turn a second
}

TEST(Quantities, AreReadAndSetByTheirNames) {
  std::set<std::string_view> seen;
  for (int k = 0; k < kInputs; ++k) {
    const InputQuantity& q = quantity(Input(k));
    EXPECT_TRUE(seen.insert(q.name).second) << q.name;
    EXPECT_EQ(input_of(q.name), Input(k));
    EXPECT_LT(q.low, q.high);
    EXPECT_GT(q.step, 0);
    // Each its own place in the blow: what one sets no other reads.
    Blow blow;
    set(blow, Input(k), 0.125);
    for (int other = 0; other < kInputs; ++other) EXPECT_EQ(get(blow, Input(other)) == 0.125, k == other) << q.name;
  }
  for (int o = 0; o < kOutputs; ++o) {
    EXPECT_TRUE(seen.insert(quantity(Output(o)).name).second);
    EXPECT_EQ(output_of(quantity(Output(o)).name), Output(o));
    EXPECT_EQ(quantity(Output(o)).of == nullptr, of_flight(Output(o)));
  }
  EXPECT_FALSE(input_of("ball_speed"));
  EXPECT_FALSE(output_of("club_speed"));
}

}  // namespace
}  // namespace hosel
