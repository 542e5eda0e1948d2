/// Figures: data and script in one gnuplot file, and the pictures that gnuplot makes of it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hosel::post {

/// One curve or cloud of points.
struct Series {
  std::string label = {};              ///< in the key; empty: not in the key
  std::vector<double> x = {}, y = {};  ///< same length
  std::string style = "lines";         ///< gnuplot style: lines, points, linespoints, ...
  std::vector<double> error = {};      ///< half-length of a bar in y; empty: none
  int colour = 0;                      ///< 1 to 8, that of a curve which belongs with it; 0: the next in turn

  /// One point more.
  void add(double at_x, double at_y) {
    x.push_back(at_x);
    y.push_back(at_y);
  }
};

/// One set of axes. With `map` non-empty it is a coloured map with contour lines, else curves.
struct Panel {
  std::string title = {};
  std::string x_label = {}, y_label = {};  ///< with units: "dynamic loft [deg]"
  bool log_x = false, log_y = false;
  bool y_down = false;                    ///< y grows downwards
  std::vector<std::string> y_names = {};  ///< what stands at y = 0, -1, -2, ... in place of numbers
  std::vector<Series> series = {};

  std::vector<double> map_x = {}, map_y = {};  ///< grid lines of the map
  std::vector<double> map = {};                ///< value at (map_x[i], map_y[j]) in [j * map_x.size() + i]
  std::string map_label = {};                  ///< of the colour bar, with unit
  bool map_symmetric = false;                  ///< colours diverge from zero, as far to either side: for differences
  double map_reach = 0;                        ///< of those: at least so far, to compare with another map
  bool map_equal_axes = false;                 ///< one unit is as long in x as in y
  bool map_contours = true;                    ///< lines with their values: for smooth fields

  bool on_page = true;  ///< beside the others on a run's page; else in the picture of all panels alone
};

struct Figure {
  std::string title = {};
  std::vector<Panel> panels = {};
  int columns = 1;                            ///< of the grid of panels
  int panel_width = 620, panel_height = 440;  ///< [pixel]
};

/// One panel alone: `picture`, and the same as PDF. Curves as SVG, whose points tell their values where they are few;
/// maps, which are thousands of coloured cells, as PNG.
struct PanelFile {
  std::string picture, pdf;
  std::string title;  ///< what to call it: its own title, else what stands at its axes
  bool map;
  std::size_t panel;           ///< number in Figure::panels
  int width, height;           ///< [pixel]
  double left = 0, right = 0;  ///< of a map's axes, shares of the width
  double top = 0, bottom = 0;  ///< and of the height, from above
};

/// The gnuplot script with its data: where gnuplot is started it draws `stem`.png, all panels that hold something, and
/// if asked each of them alone in the folder `stem`, a single one beside it. Titles, labels and names may hold
/// anything: they are quoted. `Series::style` is gnuplot's own word and comes from the code. Throws
/// std::invalid_argument on series or maps whose lengths do not match.
std::string gnuplot_script(const Figure& figure, std::string_view stem, bool panels = true);
std::vector<PanelFile> panel_files(const Figure& figure, std::string_view stem);

/// Whether the points of a panel's curves tell their values.
bool tells_values(const Panel& panel);
/// Places of a map, invisible, each with its value for who points at it: an SVG that fits over the map's picture.
std::string map_values(const Panel& panel, const PanelFile& file);

/// Whether there is anything to draw.
bool shows(const Figure& figure);

/// Writes `stem`.gp and lets gnuplot draw it, in a folder of its own: pictures are put in place when they are whole,
/// over whatever had their names. Returns an empty string, or a sentence why there is no picture (gnuplot absent or
/// refusing, nothing to show); the script stays. A gnuplot below `outside` is a file of the run and not started. Throws
/// as gnuplot_script.
std::string draw(const Figure& figure, const std::filesystem::path& stem, bool panels = true,
                 const std::filesystem::path& outside = {});

}  // namespace hosel::post
