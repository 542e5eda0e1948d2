// What a table of shots says does not hang on its units, on the order of its columns and rows, on rows that stand twice
// or on what clubs are called. HOSEL_CHECKS says how often in all; a failure names its seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "build_info.hpp"
#include "loop/shots/audit.hpp"
#include "loop/shots/shots.hpp"
#include "tests/properties/random_blows.hpp"

namespace hosel::loop {
namespace {

/// Eleven digits: far beyond what a monitor shows, as a spreadsheet writes a converted number.
std::string written(double x, int digits = 11) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

/// A column in another unit of its dimension.
void convert(post::Sheet& sheet, std::size_t column, const Unit& to, int digits) {
  const SplitName split = split_unit(sheet.names[column]);
  sheet.names[column] = split.stem + "_" + std::string(to.suffix);
  for (std::string& cell : sheet.columns[column])
    if (!cell.empty()) cell = written(std::stod(cell) * split.unit->si / to.si, digits);
}

template <class R>
void shuffle_columns(post::Sheet& sheet, R& random) {
  std::vector<std::size_t> order(sheet.names.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::shuffle(order, random);
  post::Sheet old = sheet;
  for (std::size_t c = 0; c < order.size(); ++c) {
    sheet.names[c] = old.names[order[c]];
    sheet.columns[c] = old.columns[order[c]];
  }
}

/// Rows in another order, some of them twice.
template <class R>
void shuffle_rows(post::Sheet& sheet, R& random, std::size_t twice) {
  std::vector<std::size_t> order(sheet.rows());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::shuffle(order, random);
  for (std::size_t k = 0; k < twice; ++k) order.push_back(order[k]);
  const post::Sheet old = sheet;
  sheet.lines.clear();
  for (auto& column : sheet.columns) column.clear();
  for (const std::size_t i : order) {
    sheet.lines.push_back(sheet.lines.size() + 2);
    for (std::size_t c = 0; c < sheet.columns.size(); ++c) sheet.columns[c].push_back(old.columns[c][i]);
  }
}

/// What was found, without units: the columns that a relation ties, and whether on a part of the rows. Which of them
/// was computed from the others is not compared: where a relation explains two columns alike, resolutions decide, and a
/// conversion changes these.
std::set<std::string> told(const post::Sheet& sheet) {
  const Shots shots = read_shots(sheet);
  std::set<std::string> all;
  for (const DerivedColumn& d : audit(shots, {})) {
    std::set<std::string> tied = {split_unit(d.column).stem};
    for (const std::string& f : d.from) tied.insert(split_unit(f).stem);
    std::string text;
    for (const std::string& t : tied) text += (text.empty() ? "" : " ") + t;
    all.insert(text + (d.share == 1 ? "" : " in part"));
  }
  return all;
}

std::map<std::string, std::vector<double>> values(const Shots& shots) {
  std::map<std::string, std::vector<double>> all;
  for (const Column& c : shots.columns)
    if (c.numeric && c.role != Role::bookkeeping) all[c.stem] = c.value;
  for (auto& [stem, x] : all) std::ranges::sort(x);
  return all;
}

/// The shots of the seven irons, whose loft was computed from the ball, with columns that people add.
post::Sheet irons() {
  post::Sheet s = post::read_csv(std::string(HOSEL_SOURCE_DIR) + "/cases/loop-irons/shots.csv");
  const auto at = [&](const char* name) {
    return std::size_t(std::ranges::find(s.names, std::string(name)) - s.names.begin());
  };
  s.names.push_back("spin_loft_deg");
  s.names.push_back("attack_angle_deg");
  s.names.push_back("temperature");
  s.columns.resize(s.names.size());
  std::mt19937_64 random(2);
  for (std::size_t i = 0; i < s.rows(); ++i) {
    const double attack = -0.1 * double(random() % 40), loft = std::stod(s.columns[at("dynamic_loft_deg")][i]);
    s.columns[at("attack_angle_deg")].push_back(written(attack));
    s.columns[at("spin_loft_deg")].push_back(written(loft - attack));
    s.columns[at("temperature")].push_back(std::to_string(15 + random() % 9));
  }
  return s;
}

TEST(UnitsAndOrder, AnInstrumentsFormulasAreFoundInAnyOfThem) {
  const post::Sheet plain = irons();
  const auto wanted = told(plain);
  // Of all clubs but one, in whose rows another quantity stands (cases/loop-irons).
  ASSERT_TRUE(wanted.contains("ball_speed dynamic_loft launch_angle spin_rate in part")) << *wanted.begin();
  ASSERT_TRUE(wanted.contains("attack_angle dynamic_loft spin_loft"));
  const int rounds = std::max(12, test::checks(10000) / 40);
  for (int k = 0; k < rounds; ++k) {
    std::mt19937_64 random(unsigned(3000 + k));
    post::Sheet s = plain;
    for (std::size_t c = 0; c < s.names.size(); ++c)
      if (const auto unit = split_unit(s.names[c]).unit; unit && random() % 2) {
        std::vector<Unit> others;
        for (const Unit& u : units())
          if (u.dimension == unit->dimension) others.push_back(u);
        convert(s, c, others[random() % others.size()], 8 + int(random() % 10));
      }
    shuffle_columns(s, random);
    shuffle_rows(s, random, random() % 5);
    for (std::size_t c = 0; c < s.names.size(); ++c)
      if (s.names[c] == "club")
        for (std::string& cell : s.columns[c]) cell = cell == "4i" ? "9 wood" : "x" + cell;
    EXPECT_EQ(told(s), wanted) << "seed " << 3000 + k;
    // What is told of each shot is the same number: eight digits and more were written.
    const auto there = values(read_shots(s)), here = values(read_shots(plain));
    ASSERT_EQ(there.size(), here.size()) << "seed " << 3000 + k;
    for (const auto& [stem, x] : here) {
      const std::vector<double>& y = there.at(stem);
      ASSERT_EQ(x.size(), y.size()) << stem;
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 1e-6 * std::abs(x[i]) + 1e-9) << stem;
    }
  }
}

TEST(UnitsAndOrder, AResolutionIsThatOfTheInstrument) {
  const auto resolution = [](const std::string& header, auto&& cell) {
    post::Sheet s{.file = "x.csv", .names = {header}};
    s.columns.resize(1);
    for (int i = 0; i < 40; ++i) {
      // Some above a radian: of as many digits they have a decimal less.
      s.columns[0].push_back(cell(20 + 0.1 * ((i * 37) % 101) + (i % 5 == 0 ? 60 : 0)));
      s.lines.push_back(std::size_t(i + 2));
    }
    return read_shots(s).columns[0].resolution;
  };
  const double tenth = radians(0.1);
  EXPECT_NEAR(resolution("dynamic_loft_deg", [](double x) { return written(x); }), tenth, 1e-12);
  for (const int digits : {5, 8, 12, 17})
    EXPECT_NEAR(resolution("dynamic_loft_rad", [&](double x) { return written(radians(x), digits); }), tenth, 1e-12)
        << digits << " digits";
  // As a program writes a number with all its digits: 20.100000000000001.
  for (const int digits : {16, 17})
    EXPECT_NEAR(resolution("dynamic_loft_deg", [&](double x) { return written(x, digits); }), tenth, 1e-12)
        << digits << " digits";
  // Two decimals of a radian are half a degree: there is nothing to find.
  EXPECT_NEAR(resolution("dynamic_loft_rad", [](double x) { return written(std::round(100 * radians(x)) / 100); }),
              0.01, 1e-12);
  // Nor in radians that are no degrees.
  EXPECT_NEAR(resolution("dynamic_loft_rad", [](double x) { return written(std::round(1e4 * std::sin(x)) / 1e4); }),
              1e-4, 1e-12);
}

TEST(UnitsAndOrder, NumberedShotsStandInTheOrderOfTheirNumbers) {
  post::Sheet s = irons();
  s.names.push_back("shot");
  s.columns.emplace_back();
  for (std::size_t i = 0; i < s.rows(); ++i) s.columns.back().push_back(std::to_string(100 + i));
  const Shots plain = read_shots(s);
  std::mt19937_64 random(4);
  shuffle_columns(s, random);
  shuffle_rows(s, random, 3);
  const Shots shuffled = read_shots(s);
  EXPECT_EQ(shuffled.repeated, 3u);
  ASSERT_EQ(plain.id, shuffled.id);
  ASSERT_EQ(plain.columns.size(), shuffled.columns.size());
  for (std::size_t c = 0; c < plain.columns.size(); ++c) {
    EXPECT_EQ(plain.columns[c].name, shuffled.columns[c].name);
    EXPECT_EQ(plain.columns[c].value, shuffled.columns[c].value);
    EXPECT_EQ(plain.columns[c].text, shuffled.columns[c].text);
  }
}

}  // namespace
}  // namespace hosel::loop
