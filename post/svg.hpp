/// Pictures inside a page: plain SVG whose classes html_page colours.
#pragma once

#include <string>
#include <vector>

namespace hosel::post {

/// The least of 1, 2 and 5 times a power of ten that is no less than a range over `parts`: between marks of an axis.
double round_step(double range, double parts);

struct SvgSeries {
  std::string style;  ///< class
  std::vector<double> x, y;
  double radius = 0;       ///< of dots; 0: a line
  std::string label = {};  ///< beside the line
};

/// A point of interest: a ring and its words.
struct SvgMark {
  double x, y;
  std::string text;
};

struct SvgBand {
  double x0, x1, y0, y1;
};

/// Values over a frame with round ticks; dots beyond the frame are drawn at its edge, lines leave it. Long series are
/// thinned.
struct SvgPlot {
  double width, height;  ///< of the picture
  double x0, x1, y0, y1;
  std::string x_label, y_label, told;  ///< told: for who cannot see it
  std::vector<SvgBand> bands;
  std::vector<SvgSeries> series;
  std::vector<SvgMark> marks = {};
};
std::string svg(const SvgPlot& plot);

struct SvgBar {
  std::string style;
  double value, low, high;  ///< the whisker's ends
  std::string text;
};

/// Pairs of bars from zero, a dashed line at one. Over a wide range by powers of ten.
struct SvgBars {
  std::string told, one, axis;  ///< one: what the dashed line is
  struct Row {
    std::string label;
    std::vector<SvgBar> bars;
  };
  std::vector<Row> rows;
};
std::string svg(const SvgBars& bars);

}  // namespace hosel::post
