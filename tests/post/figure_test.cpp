// Figures: the script carries its data, gnuplot draws it.
#include "post/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/fresh_directory.hpp"

namespace hosel::post {
namespace {

Figure two_panels() {
  Figure f{.title = "it's a test", .columns = 2};
  Panel curve{.title = "curve", .x_label = "loft [deg]", .y_label = "spin [rpm]"};
  Series line{.label = "sine"}, dots{.label = "measured", .style = "points"};
  for (int i = 0; i <= 20; ++i) {
    line.x.push_back(3 * i);
    line.y.push_back(11205.4 * std::sin(3 * i * 0.01745));
  }
  dots.x = {12, 30};
  dots.y = {2500, 6000};
  dots.error = {200, 300};
  curve.series = {line, dots};
  Panel map{.title = "map", .x_label = "toe [mm]", .y_label = "high [mm]", .map_label = "ball speed [m/s]"};
  for (int i = -5; i <= 5; ++i) map.map_x.push_back(4 * i);
  for (int j = -3; j <= 3; ++j) map.map_y.push_back(4 * j);
  for (const double y : map.map_y)
    for (const double x : map.map_x) map.map.push_back(68 - 0.004 * (x - 2) * (x - 2) - 0.01 * y * y);
  f.panels = {curve, map};
  return f;
}

/// Quotes at the begin of a name or after each other, what is no character, and more than a picture has room for.
TEST(Figure, AnyNameIsDrawn) {
  const test::FreshDirectory home("figure_names");
  const auto stem = home.path() / "names";
  std::string accents;
  for (int i = 0; i < 1000; ++i) accents += "\xC3\xA9";
  for (const std::string& name :
       {std::string("' at the begin"), std::string("two '' and four ''''"), std::string("\xEF\xBF\xBF]]>&#x0;"),
        std::string(1000, 'n'), accents, std::string("%s%n {} @ _ ^ `id` $(id) \\ \""), std::string(79, '%')}) {
    Figure f = two_panels();
    f.title = name;
    for (Panel& p : f.panels) {
      p.title = p.x_label = p.y_label = p.map_label = name;
      for (Series& s : p.series) s.label = name;
      if (p.map.empty()) p.y_names = {name, "plain"};
    }
    EXPECT_EQ(draw(f, stem, true), "") << name;
    std::ifstream svg(stem.parent_path() / panel_files(f, "names").front().picture);
    const std::string text{std::istreambuf_iterator<char>(svg), {}};
    EXPECT_NE(text.find("</svg>"), std::string::npos) << name;
    EXPECT_EQ(text.find("\xEF\xBF\xBF"), std::string::npos) << name;
    EXPECT_EQ(text.find("&#x0;"), std::string::npos) << name;
    std::filesystem::remove_all(stem);
  }
}

TEST(Figure, PictureIsDrawn) {
  const test::FreshDirectory home("figure");
  const auto stem = home.path() / "figure";
  ASSERT_EQ(draw(two_panels(), stem), "");
  std::ifstream png(stem.string() + ".png", std::ios::binary);
  std::string magic(8, 0);
  png.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(std::filesystem::file_size(stem.string() + ".png"), 10000u);
}

TEST(Figure, EachPanelIsAFileOfItsOwn) {
  const test::FreshDirectory home("figure_panels");
  const auto stem = home.path() / "figure";
  Figure f = two_panels();
  f.panels.insert(f.panels.begin(), Panel{.title = "nothing was measured", .series = {{.label = "measured"}}});
  ASSERT_EQ(draw(f, stem), "");
  const auto files = panel_files(f, stem.string());
  ASSERT_EQ(files.size(), 2u) << "a panel without data is not drawn";
  EXPECT_EQ(files[0].picture, stem.string() + "/1-curve.svg");
  EXPECT_EQ(files[1].picture, stem.string() + "/2-map.png");
  for (const PanelFile& file : files)
    for (const std::string& name : {file.picture, file.pdf}) {
      ASSERT_TRUE(std::filesystem::exists(name)) << name;
      EXPECT_GT(std::filesystem::file_size(name), 5000u) << name;
    }
  EXPECT_NE(draw({.title = "empty", .panels = {Panel{}}}, stem), "") << "no picture of nothing";
}

TEST(Figure, PointsAndPlacesTellTheirValues) {
  const test::FreshDirectory home("figure_told");
  const auto stem = home.path() / "figure";
  Figure f = two_panels();
  f.panels[0].series[1].label = "<b>";
  f.panels[0].series[1].y[0] = NAN;  // not drawn: the next one keeps its own values
  ASSERT_EQ(draw(f, stem), "");
  const auto files = panel_files(f, stem.string());
  std::ifstream in(files[0].picture);
  const std::string curves(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(curves.find("<title>sine: loft 3 deg, spin 586.33 rpm</title>"), std::string::npos);
  EXPECT_NE(curves.find("<title>&lt;b&gt;: loft 30 deg, spin 6000 rpm ± 3e+02</title>"), std::string::npos);
  EXPECT_EQ(curves.find("onmouse"), std::string::npos);
  EXPECT_EQ(curves.find("<title>gnuplot"), std::string::npos);
  const std::string map = map_values(f.panels[1], files[1]);
  EXPECT_NE(map.find("<title>map: ball speed 67.984 m/s\ntoe 4 mm, high 0 mm</title>"), std::string::npos) << map;
  // The place of the greatest value in the picture is where the axes say: the map fills them.
  EXPECT_NEAR(files[1].left * files[1].width, 92, 1e-9);
  EXPECT_LT(files[1].top, files[1].bottom);
}

/// On steep flanks there are fewer level lines, so that their numbers do not touch; a gentle map keeps gnuplot's own.
TEST(Figure, NumbersOfLevelLinesDoNotTouch) {
  Panel steep{.map_x = {-20, -10, 0, 10, 20}, .map_y = {0.19, 0.2, 0.21}, .map_symmetric = true};
  for (int j = 0; j < 3; ++j)
    for (const double x : steep.map_x) steep.map.push_back(0.44 - 0.00415 * x * x);
  Panel gentle = steep;
  gentle.map = {0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4};
  const auto levels = [](const Panel& p) {
    const std::string script = gnuplot_script({.panels = {p}}, "m", false);
    const std::size_t at = script.find("cntrparam levels ") + 17;
    return script.substr(at, script.find('\n', at) - at);
  };
  EXPECT_EQ(levels(steep), "incremental -1,0.5,0") << "0.2 by gnuplot";
  EXPECT_EQ(levels(gentle), "auto 8");
}

/// One number on each level line of a map: two of one line would stand side by side in a small panel.
TEST(Figure, ALevelLineHasOneNumber) {
  const std::string script = gnuplot_script({.panels = {two_panels().panels[1]}}, "m", false);
  EXPECT_NE(script.find("set cntrlabel onecolor format '%.5g' start 14 interval -1"), std::string::npos) << script;
}

/// What is round-off beside the other points is told as zero.
TEST(Figure, RoundOffIsToldAsZero) {
  Panel p{.title = "m", .map_x = {-1, 1}, .map_y = {0, 1}, .map = {-0.0, 6.0467e-14, 5, 7}, .map_label = " [rpm]"};
  const std::string told = map_values(p, {"", "", "", true, 0, 100, 100, 0.1, 0.9, 0.1, 0.9});
  EXPECT_NE(told.find("m: 0 rpm"), std::string::npos) << told;
  EXPECT_EQ(told.find("-0 "), std::string::npos) << told;
  EXPECT_EQ(told.find("e-14"), std::string::npos) << told;
}

TEST(Figure, LongTitlesAreBroken) {
  Figure f = two_panels();
  f.title = std::string(100, 'a') + " " + std::string(100, 'b');  // two panels of 620 pixels hold some 160 letters
  EXPECT_NE(gnuplot_script(f, "x").find("'" + std::string(100, 'a') + "'.\"\\n\".'" + std::string(100, 'b') + "'"),
            std::string::npos);
}

TEST(Figure, UnequalColumnsAreRefused) {
  Figure f = two_panels();
  f.panels[0].series[0].y.pop_back();
  EXPECT_THROW(gnuplot_script(f, "x"), std::invalid_argument);
  f = two_panels();
  f.panels[1].map.pop_back();
  EXPECT_THROW(gnuplot_script(f, "x"), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::post
