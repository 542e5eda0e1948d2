// Words in a picture of a page: none on a mark, on another's words or on a line.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <string>
#include <vector>

#include "post/svg.hpp"

namespace hosel::post {
namespace {

struct Words {
  std::string text;
  double left, right, y;
};

/// The texts of these words, where they stand.
std::vector<Words> words(const std::string& picture, const std::string& wanted) {
  std::vector<Words> out;
  const std::regex text("<text[^>]* x='([^']+)' y='([^']+)'([^>]*)>([^<]+)</text>");
  for (std::sregex_iterator it(picture.begin(), picture.end(), text), end; it != end; ++it) {
    const std::string said = (*it)[4], anchor = (*it)[3];
    if (!std::regex_match(said, std::regex(wanted))) continue;
    const double x = std::stod((*it)[1]), wide = 6.6 * double(said.size());
    const double left = anchor.find("middle") != std::string::npos ? x - wide / 2
                        : anchor.find("end") != std::string::npos  ? x - wide
                                                                   : x;
    out.push_back({said, left, left + wide, std::stod((*it)[2])});
  }
  return out;
}

SvgPlot plot() { return {480, 330, 0, 1, 0, 1.1, "time [ms]", "force", "", {}, {}}; }

SvgSeries bell(const char* label, double height, double middle, double width) {
  SvgSeries s{.style = "line-1", .x = {}, .y = {}, .label = label};
  for (int i = 0; i <= 200; ++i) {
    s.x.push_back(i / 200.0);
    s.y.push_back(height * std::exp(-std::pow((s.x.back() - middle) / width, 2)));
  }
  return s;
}

TEST(Svg, NoLabelLiesOnTheWordsOfAMark) {
  for (const double middle : {0.3, 0.45, 0.7}) {
    SvgPlot p = plot();
    p.series = {bell("normal", 1, middle, 0.2), bell("along the slip", 0.2, middle, 0.1)};
    p.marks = {{middle, 1, "11.95 kN at 0.201 ms"}};
    const std::string picture = svg(p);
    const auto labels = words(picture, "normal|along the slip|11.95 kN.*");
    ASSERT_EQ(labels.size(), 3u);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_TRUE(labels[a].right < labels[b].left || labels[b].right < labels[a].left ||
                    std::abs(labels[a].y - labels[b].y) > 11)
            << labels[a].text << " and " << labels[b].text << ", peak at " << middle;
  }
}

/// A small peak among large ones: its words stand clear of every line, and nearer to its own line than to another.
TEST(Svg, ALabelBelongsToItsLine) {
  SvgPlot p = plot();
  p.series = {bell("motion", 1, 0.5, 0.3), bell("held by the face", 0.4, 0.5, 0.08)};
  const auto label = words(svg(p), "held by the face");
  ASSERT_EQ(label.size(), 1u);
  const double w = 480 - 62 - 12, h = 330 - 10 - 44;
  const auto distance = [&](const SvgSeries& s) {
    double least = 1e9;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      const double x = 62 + s.x[i] * w, y = 10 + (1.1 - s.y[i]) / 1.1 * h, cy = label[0].y - 4;
      least = std::min(least, std::hypot(std::max({0.0, label[0].left - x, x - label[0].right}),
                                         std::max(0.0, std::abs(y - cy) - 6)));
    }
    return least;
  };
  EXPECT_GT(distance(p.series[0]), 3);
  EXPECT_GT(distance(p.series[1]), 1);
  EXPECT_LT(distance(p.series[1]), distance(p.series[0]));
}

/// Waves that leave no room: the words go beneath the axis, and the picture grows by their row.
TEST(Svg, WordsWithoutRoomAreInAKey) {
  SvgPlot p = plot();
  for (int k = 0; k < 2; ++k) {
    SvgSeries s{.style = "line-1", .x = {}, .y = {}, .label = k ? "the second of two waves" : "the first of two waves"};
    for (int i = 0; i <= 2000; ++i) {
      s.x.push_back(i / 2000.0);
      s.y.push_back(0.55 * (1 + std::cos(60 * std::numbers::pi * s.x.back() + k)));
    }
    p.series.push_back(s);
  }
  const std::string picture = svg(p);
  EXPECT_NE(picture.find("viewBox='0 0 480 348'"), std::string::npos) << picture.substr(0, 60);
  const auto labels = words(picture, "the .* waves");
  ASSERT_EQ(labels.size(), 2u);
  for (const Words& l : labels) EXPECT_GT(l.y, 330);
  EXPECT_LT(labels[0].right, labels[1].left);
}

}  // namespace
}  // namespace hosel::post
