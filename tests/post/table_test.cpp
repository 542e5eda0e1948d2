#include "post/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "post/csv.hpp"

namespace hosel::post {
namespace {

/// A head of every sort, and a row of every sort of cell.
Table of_every_sort() {
  Table t{{{"name", "{}", "ball"},
           {"contact_time_s", "{:.3g}", "contact [ms]", "{:.2f}", 1e3},
           {"blows", "{:.3g}", "blows"},
           {.heading = "remark"},
           {"own, exact"}},
          {.first_width = 6, .margin = 2, .least_width = 8, .even = false}};
  t.add("range \"x\", 1", 4.5678e-4, 12, "soft", 0.1);
  t.add("=1+1", std::nullopt, 3L, std::string(), std::optional<double>());
  return t;
}

TEST(Table, WritesRfc4180WithEachColumnsOwnDigits) {
  EXPECT_EQ(of_every_sort().csv(),
            "name,contact_time_s,blows,\"own, exact\"\n"
            "\"range \"\"x\"\", 1\",0.000457,12,0.1\n"
            "'=1+1,,3,\n");
}

TEST(Csv, AnotherSeparatorThanACommaIsNamed) {
  const auto refused = [](const char* text) {
    try {
      parse_csv(text, "t");
    } catch (const DataError& e) { return std::string(e.what()); }
    return std::string();
  };
  EXPECT_NE(
      refused("a;b\n1,5;2\n").find("t:1: cells are separated by semicolons here: a comma is what separates cells"),
      std::string::npos);
  // Whole numbers would stand in one column of that name.
  EXPECT_NE(refused("a;b\n1;2\n").find("separated by semicolons"), std::string::npos);
  EXPECT_NE(refused("a\tb\n1\t2\n").find("separated by tabs"), std::string::npos);
  EXPECT_EQ(refused("a\n1,5\n").find("a comma is what"), std::string::npos);
}

TEST(Csv, ANumberKeepsItsSignAndHasOne) {
  EXPECT_EQ(number("+5"), 5.0);
  EXPECT_EQ(number("1e-400"), 0.0);
  EXPECT_EQ(number("-1e400"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(number("1e400"), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(number("+-5"));
  EXPECT_FALSE(number("+"));
}

TEST(Table, TheStrictReaderReadsWhatItWrites) {
  const Sheet sheet = parse_csv(of_every_sort().csv(), "written");
  ASSERT_EQ(sheet.rows(), 2U);
  ASSERT_EQ(sheet.names.back(), "own, exact");
  EXPECT_EQ(sheet.columns[0][0], "range \"x\", 1");
  EXPECT_EQ(number(sheet.columns[3][0]), 0.1) << "all digits of a number without a format";
}

TEST(Table, PeopleReadTheirOwnHeadingsUnitsAndDigits) {
  const TextTable shown = of_every_sort().shown();
  ASSERT_EQ(shown.rows.size(), 3U);
  EXPECT_EQ(shown.rows[0], (std::vector<std::string>{"ball", "contact [ms]", "blows", "remark"}));
  EXPECT_EQ(shown.rows[1], (std::vector<std::string>{"range \"x\", 1", "0.46", "12", "soft"}));
  EXPECT_EQ(shown.rows[2], (std::vector<std::string>{"=1+1", "-", "3", ""}));
  // The first column as wide as its longest cell and the margin, 14; the others as wide as their own cells and two.
  EXPECT_EQ(shown.text(),
            "ball            contact [ms]   blows  remark\n"
            "range \"x\", 1            0.46      12    soft\n"
            "=1+1                       -       3        ");
}

TEST(Table, JsonHoldsTheNumbersThemselves) {
  const nlohmann::json j = of_every_sort().json();
  ASSERT_EQ(j.size(), 2U);
  EXPECT_EQ(j[0], (nlohmann::json{
                      {"name", "range \"x\", 1"}, {"contact_time_s", 4.5678e-4}, {"blows", 12}, {"own, exact", 0.1}}));
  EXPECT_TRUE(j[1]["contact_time_s"].is_null());
}

TEST(Table, ARangeGivesACellForEachElement) {
  Table t;
  t.in_files({"a", "b"}).in_files({"c"}, "{:.1f}");
  t.add(std::vector<std::string>{"x", "y"});
  t.more(if_finite(0.25));
  t.add(std::vector{1.0, 2.0}, if_finite(std::nan("")));
  t.add("", std::nullopt, 3.0);
  EXPECT_EQ(t.csv(), "a,b,c\nx,y,0.2\n1,2,\n,,3.0\n");
}

TEST(Table, ARowOfAnotherLengthIsAnError) {
  Table t;
  t.in_files({"a", "b"});
  t.add(1);
  EXPECT_THROW(t.csv(), std::logic_error);
  EXPECT_THROW(t.shown(), std::logic_error);
  EXPECT_THROW(t.json(), std::logic_error);
  t.more(2);
  EXPECT_EQ(t.csv(), "a,b\n1,2\n");
}

}  // namespace
}  // namespace hosel::post
