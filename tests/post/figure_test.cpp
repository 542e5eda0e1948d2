// Figures: the script carries its data, gnuplot draws it.
#include "hosel/post/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

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

TEST(Figure, PictureIsDrawn) {
  const auto stem = std::filesystem::path(testing::TempDir()) / "hosel_figure";
  ASSERT_EQ(draw(two_panels(), stem), "");
  std::ifstream png(stem.string() + ".png", std::ios::binary);
  std::string magic(8, 0);
  png.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(std::filesystem::file_size(stem.string() + ".png"), 10000u);
}

TEST(Figure, UnequalColumnsAreRefused) {
  Figure f = two_panels();
  f.panels[0].series[0].y.pop_back();
  EXPECT_THROW(gnuplot_script(f, "x.png"), std::invalid_argument);
  f = two_panels();
  f.panels[1].map.pop_back();
  EXPECT_THROW(gnuplot_script(f, "x.png"), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::post
