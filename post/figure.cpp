#include "post/figure.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "post/digits.hpp"
#include "post/file.hpp"
#include "post/html.hpp"
#include "post/svg.hpp"

extern char** environ;

namespace hosel::post {
namespace fs = std::filesystem;
namespace {

/// The text with a blank for what no picture can hold: control characters, and what is no character (U+FFFE, U+FFFF).
std::string characters(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto three = text.substr(i, 3);
    const bool none = three == "\xEF\xBF\xBE" || three == "\xEF\xBF\xBF";
    out += none || static_cast<unsigned char>(text[i]) < 0x20 || text[i] == 0x7f ? ' ' : text[i];
    if (none) i += 2;
  }
  return out;
}

/// A gnuplot string in single quotes; enhanced markup is off, so the text stands as it is. A line break would end the
/// string and let what follows be executed: it is a blank here. A quote becomes its printed form: gnuplot reads doubled
/// ones wrongly where a string begins with them or where they follow each other. gnuplot hands on to its SVG what
/// begins an entity (&#) or ends a section (]]>): blanks part them.
std::string literal(std::string_view text) {
  std::string out = "'";
  for (const char c : characters(text)) {
    if ((c == '#' && out.ends_with('&')) || (c == '>' && out.ends_with("]]"))) out += ' ';
    if (c == '\'') out += "’";
    else out += c;
  }
  return out + "'";
}

/// At most so many characters: a longer name would leave no room for the curves.
std::string shortened(std::string_view text, std::size_t most) {
  std::size_t characters = 0, end = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xC0) == 0x80) continue;  // goes on with a character
    if (++characters == most) end = i;
  }
  return characters <= most ? std::string(text) : std::string(text.substr(0, end)) + "…";
}

/// What is to be read in a picture.
std::string shown(std::string_view text) { return literal(shortened(text, 80)); }

/// A line of a data block.
std::string data_line(std::initializer_list<double> numbers) {
  std::string out;
  for (const double x : numbers)
    out += (out.empty() ? "" : " ") + (std::isfinite(x) ? fmt::format("{:.10g}", x) : std::string("NaN"));
  return out + "\n";
}

std::string data_block(const std::string& name, const Series& s) {
  if (s.x.size() != s.y.size() || (!s.error.empty() && s.error.size() != s.x.size()))
    throw std::invalid_argument("figure: series '" + s.label + "' has columns of different length");
  std::string out = "$" + name + " << EOD\n";
  for (std::size_t i = 0; i < s.x.size(); ++i)
    out += s.error.empty() ? data_line({s.x[i], s.y[i]}) : data_line({s.x[i], s.y[i], s.error[i]});
  return out + "EOD\n";
}

std::string map_block(const std::string& name, const Panel& p) {
  if (p.map.size() != p.map_x.size() * p.map_y.size())
    throw std::invalid_argument("figure: map '" + p.title + "' does not fill its grid");
  std::string out = "$" + name + " << EOD\n";
  for (std::size_t j = 0; j < p.map_y.size(); ++j) {
    for (std::size_t i = 0; i < p.map_x.size(); ++i)
      out += data_line({p.map_x[i], p.map_y[j], p.map[j * p.map_x.size() + i]});
    out += '\n';
  }
  return out + "EOD\n";
}

/// In lines that fit a width [pixel], as a gnuplot expression.
std::string title(std::string_view whole, int width) {
  const std::size_t most = std::size_t(std::max(20, int(width / 7.8)));
  const std::string text = shortened(whole, 3 * most);
  std::string out, line;
  std::size_t begin = 0;
  const auto flush = [&] {
    out += (out.empty() ? "" : R"(."\n".)") + literal(shortened(line, most));
    line.clear();
  };
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (!line.empty() && line.size() + 1 + end - begin > most) flush();
    line += (line.empty() ? "" : " ") + text.substr(begin, end - begin);
    begin = end + 1;
  }
  flush();
  return out;
}

bool shows_something(const Panel& p) {
  return !p.map.empty() || std::ranges::any_of(p.series, [](const Series& s) { return !s.x.empty(); });
}

/// Where the axes of a map stand in its own picture, `above` pixels of which are the figure's title.
void place_axes(PanelFile& file, const Panel& p, int above) {
  const double w = file.width, h = file.height,
               lines = p.title.empty() ? 0 : 1 + std::floor(7.8 * double(p.title.size()) / w);
  double left = 92, right = w - 106, top = above + 14 + 20 * lines, bottom = h - 58;
  if (p.map_equal_axes) {
    const double across = p.map_x.back() - p.map_x.front(), up = p.map_y.back() - p.map_y.front();
    const double scale = std::min((right - left) / across, (bottom - top) / up);
    const double x = 0.5 * (right - left - scale * across), y = 0.5 * (bottom - top - scale * up);
    left += x, right -= x, top += y, bottom -= y;
  }
  file.left = left / w, file.right = right / w, file.top = top / h, file.bottom = bottom / h;
}

/// The levels of a map's lines for gnuplot: eight by its own choice, fewer where the numbers of two neighbours would
/// touch on a steep flank. `width` and `height` of the panel [pixel].
std::string contour_levels(const Panel& p, int width, int height) {
  constexpr double letter = 5.5, line = 14;  // of the numbers' font [pixel]
  const std::string automatic = "auto 8";
  const std::size_t columns = p.map_x.size(), rows = p.map_y.size();
  double low = INFINITY, high = -INFINITY;
  for (const double v : p.map)
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (columns < 2 || rows < 2 || !(high > low)) return automatic;
  // Beside the axes stand their numbers, the colours and the labels.
  const double across = p.map_x.back() - p.map_x.front(), up = p.map_y.back() - p.map_y.front();
  double x_scale = std::max(100.0, width - 310.0) / across, y_scale = std::max(100.0, height - 165.0) / up;
  if (p.map_equal_axes) x_scale = y_scale = std::min(x_scale, y_scale);
  // Between two levels, so that numbers as wide as `words` lie beside or above each other; of nine cells in ten.
  const auto wanted = [&](double words) {
    std::vector<double> of_cells;
    for (std::size_t j = 0; j + 1 < rows; ++j)
      for (std::size_t i = 0; i + 1 < columns; ++i) {
        const double v = p.map[j * columns + i];
        const double gx = (p.map[j * columns + i + 1] - v) / (x_scale * (p.map_x[i + 1] - p.map_x[i])),
                     gy = (p.map[(j + 1) * columns + i] - v) / (y_scale * (p.map_y[j + 1] - p.map_y[j]));
        const double slope = gx * gx + gy * gy;
        if (slope > 0) of_cells.push_back(slope * std::min(words / std::abs(gx), line / std::abs(gy)));  // not NaN
      }
    if (of_cells.empty()) return 0.0;
    const auto steep = of_cells.begin() + std::ptrdiff_t(0.9 * double(of_cells.size() - 1));
    std::ranges::nth_element(of_cells, steep);
    return *steep;
  };
  const auto letters = [](double level) { return double(fmt::format("{:.5g}", level).size()); };
  // The step that gnuplot itself takes for "auto 8".
  const double power = std::pow(10, std::floor(std::log10(high - low))), places = 18 * power / (high - low);
  const double least = power * (places > 10 ? 0.2 : places > 4 ? 0.5 : places > 2 ? 1 : 2);
  // No wider than leaves two levels: a map with one line says little.
  for (double step = least; step <= round_step(high - low, 3); step = round_step(1.5 * step, 1)) {
    double words = 0;
    const double first = std::ceil(low / step), last = std::floor(high / step);
    for (double k = first; k < last; ++k)
      words = std::max(words, letter * (letters(k * step) + letters((k + 1) * step)) / 2);
    if (step < wanted(words) && round_step(1.5 * step, 1) <= round_step(high - low, 3)) continue;
    if (step == least) break;
    return fmt::format("incremental {:.10g},{:.10g},{:.10g}", first * step, step, last * step);
  }
  return automatic;
}

/// Data of panel k, and behind it the words that plot them. `alone`: the place of a map's axes in its own picture;
/// `told`: the points of curves carry their numbers, for tell_values.
std::pair<std::string, std::string> panel_script(const Panel& p, int k, int width, int height,
                                                 const PanelFile* alone = nullptr, bool told = false) {
  // A key below stands so near the label that an empty line must part them.
  const bool key = p.map.empty() && std::ranges::any_of(p.series, [](const Series& c) { return !c.label.empty(); });
  std::string data, s = "\nset title " + title(p.title, width) + "\nset xlabel " + shown(p.x_label) +
                        (key ? R"(."\n" offset 0,0.4)" : "") + "\nset ylabel " + shown(p.y_label) + "\n";
  s += p.log_x ? "set logscale x\n" : "unset logscale x\n";
  s += p.log_y ? "set logscale y\n" : "unset logscale y\n";
  if (!p.map.empty()) {
    const std::string name = fmt::format("map{}", k);
    data += map_block(name, p);
    double low = INFINITY, high = -INFINITY;
    for (const double v : p.map)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    // A field that is constant to round-off is shown as one colour, not as noise.
    const double size = std::max(std::abs(low), std::abs(high));
    if (p.map_symmetric) {
      const double reach = std::max(std::isfinite(size) ? size : 0, p.map_reach);
      high = reach > 1e-9 ? reach : 1;
      low = -high;
    } else if (!(high - low > 1e-9 * size)) {
      low = (std::isfinite(low) ? low : 0) - 1, high = low + 2;
    }
    s += fmt::format(
        "set palette defined ({})\nset format cb '%.6g'\nset size {}\n"
        "set cblabel {} offset 1,0\nset cbrange [{:.10g}:{:.10g}]\nset xrange [{:.10g}:{:.10g}]\nset yrange "
        "[{:.10g}:{:.10g}]\n",
        p.map_symmetric ? "0 '#2b5c8a', 0.5 '#f7f5ec', 1 '#b5432f'"
                        : "0 '#ffffd9', 0.3 '#c7e9b4', 0.65 '#7fcdbb', 1 '#41a0c4'",
        p.map_equal_axes && !alone ? "ratio -1" : "noratio", shown(p.map_label), low, high, p.map_x.front(),
        p.map_x.back(), p.map_y.front(), p.map_y.back());
    const double range = p.map_x.back() - p.map_x.front();
    // At most six marks: their numbers do not touch in a narrow map.
    if (range > 0) s += fmt::format("set xtics {:.10g}\n", round_step(range, 5));
    if (p.map_contours)
      s += "set contour base\nset cntrparam cubicspline\nset cntrparam points 6\nset cntrparam levels " +
           contour_levels(p, width, height) +
           // One number a line, off its end: points of a line are six for each cell that it crosses.
           fmt::format("\nset cntrlabel onecolor format '%.5g' start {} interval -1 font ',8'\n",
                       std::max<std::size_t>(8, 2 * std::min(p.map_x.size(), p.map_y.size()))) +
           "set style textbox opaque noborder fillcolor '#ffffff' margins 0.2,0.2\n";
    // Cells of one colour each: small enough that a coarse grid looks as smooth as a fine one.
    const auto parts = [](std::size_t points) {
      return std::max<std::size_t>(2, 120 / std::max<std::size_t>(1, points));
    };
    // Wide numbers at the axis and at the colours would push their labels out of the picture.
    if (alone)
      s += fmt::format(
          "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\nset tmargin at screen {:.6f}\nset bmargin at "
          "screen {:.6f}\nset colorbox user origin screen {:.6f}, screen {:.6f} size screen {:.6f}, screen {:.6f}\n",
          alone->left, alone->right, 1 - alone->top, 1 - alone->bottom, alone->right + 12.0 / alone->width,
          1 - alone->bottom, 14.0 / alone->width, alone->bottom - alone->top);
    else s += "set lmargin 12\nset rmargin 13\n";
    s += fmt::format("set pm3d map interpolate {},{}\nsplot ${} with pm3d nocontour notitle", parts(p.map_x.size()),
                     parts(p.map_y.size()), name);
    if (p.map_contours) s += ", $" + name + " with lines nosurface lc rgb '#303030' lw 1 notitle";
    for (std::size_t i = 0; i < p.series.size(); ++i) {
      const std::string mark = fmt::format("s{}_{}", k, i);
      data += data_block(mark, p.series[i]);
      s += ", $" + mark + " using 1:2:(0) with " + p.series[i].style + " lc rgb '#000000' nocontour " +
           (p.series[i].label.empty() ? "notitle" : "title " + shown(p.series[i].label));
    }
    if (p.map_contours) s += ", $" + name + " with labels boxed nosurface notitle";
    return {data, s + "\nunset contour\nunset pm3d\nunset lmargin\nunset rmargin\nunset tmargin\nunset bmargin\nset "
                      "xtics autofreq\nset size noratio\nset autoscale xy\n"};
  }
  std::string plot;
  bool marks = false;
  for (std::size_t i = 0; i < p.series.size(); ++i) {
    const Series& c = p.series[i];
    if (c.x.empty()) continue;
    const bool points = !c.error.empty() || c.style.find("points") != std::string::npos;
    marks = marks || points;
    const std::string name = fmt::format("s{}_{}", k, i);
    data += data_block(name, c);
    if (!plot.empty()) plot += ", \\\n     ";
    plot += "$" + name + (c.error.empty() ? " using 1:2 with " + c.style : std::string(" using 1:2:3 with yerrorbars"));
    plot += fmt::format(" lt {} lw 1.8 ", c.colour > 0 ? std::size_t(c.colour) : i + 1);
    // The colours come round: the next eight curves are dashed, the next eight marks have another form.
    if (i >= 8 && c.colour == 0 && c.error.empty()) plot += fmt::format("dt {} ", 1 + i / 8);
    if (points) plot += fmt::format("pt {} ps 0.8 ", 6 + (i + i / 8) % 8);
    plot += c.label.empty() ? "notitle" : "title " + shown(c.label);
  }
  for (std::size_t i = 0; told && i < p.series.size(); ++i)
    if (!p.series[i].x.empty())
      plot += fmt::format(
          ", \\\n     $s{0}_{1} using 1:2:(sprintf('{1} %d', $0)) with labels hypertext point pt 7 ps 1.2 lc rgb "
          "'#ff000000' notitle",
          k, i);
  if (!p.y_names.empty()) {
    std::string names;
    for (std::size_t i = 0; i < p.y_names.size(); ++i) {
      std::string name;  // a tic's words are a format; doubled where they are short already, or a half would be left
      for (const char c : shown(p.y_names[i])) name += c == '%' ? std::string("%%") : std::string(1, c);
      names += fmt::format("{}{} {}", i ? ", " : "", name, -std::ptrdiff_t(i));
    }
    s += fmt::format("set ytics ({})\nset yrange [{}:0.5]\n", names, 0.5 - double(p.y_names.size()));
  }
  if (p.y_down) s += "set yrange [*:*] reverse\n";
  // Marks and their bars stay clear of the frame.
  s += marks && !p.log_x && !p.log_y ? "set offsets graph 0.04, graph 0.04, graph 0.04, graph 0.04\n"
                                     : "unset offsets\n";
  s += "plot " + plot + "\n";
  if (!p.y_names.empty()) s += "set ytics autofreq\nset autoscale y\n";
  if (p.y_down) s += "set yrange [*:*] noreverse\n";
  return {data, s};
}

/// What a panel is called: its title, else what stands at its upright axis, without the unit.
std::string called(const Panel& p) {
  const std::string& name = p.title.empty() ? p.y_label : p.title;
  return p.title.empty() ? name.substr(0, name.find(" [")) : name;
}

/// Tells eight curves apart for every kind of eye; the key stands below, never over a curve.
constexpr const char* kLook =
    "set grid lc rgb '#dddddd'\nset tics nomirror\nset border lc rgb '#404040'\n"
    "set linetype 1 lc rgb '#0072b2'\nset linetype 2 lc rgb '#d55e00'\nset linetype 3 lc rgb '#009e73'\n"
    "set linetype 4 lc rgb '#cc79a7'\nset linetype 5 lc rgb '#56b4e9'\nset linetype 6 lc rgb '#e69f00'\n"
    "set linetype 7 lc rgb '#000000'\nset linetype 8 lc rgb '#8c8c8c'\nset linetype cycle 8\n"
    "set key below center horizontal Left reverse samplen 2 maxrows 4\n";

/// Pixels above the panels for the figure's title.
int title_height(const Figure& f, int width) {
  if (f.title.empty()) return 0;
  return 22 * (1 + int(title(f.title, width).size() / std::size_t(width / 7.8))) + 18;
}

}  // namespace

bool tells_values(const Panel& p) {
  constexpr std::size_t kMost = 400;  // points
  std::size_t count = 0;
  for (const Series& c : p.series) count += c.x.size();
  return p.map.empty() && p.y_names.empty() && count <= kMost;
}

std::vector<PanelFile> panel_files(const Figure& f, std::string_view stem) {
  std::vector<PanelFile> out;
  const auto n = std::ranges::count_if(f.panels, shows_something);
  for (std::size_t k = 0; k < f.panels.size(); ++k) {
    const Panel& p = f.panels[k];
    if (!shows_something(p)) continue;
    std::string file(stem);
    if (n > 1) {
      file += fmt::format("/{}-", out.size() + 1);
      const std::string name = called(p).substr(0, 100);  // of a file's name no more than 255 bytes are stored
      for (const char c : name.substr(0, name.find(" ["))) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c));
        if (plain || !file.ends_with('-')) file += plain ? char(std::tolower(static_cast<unsigned char>(c))) : '-';
      }
      while (file.ends_with('-')) file.pop_back();
    }
    const int above = n == 1 ? title_height(f, f.panel_width) : 0;
    out.push_back({file + (p.map.empty() ? ".svg" : ".png"), file + ".pdf", called(p).empty() ? f.title : called(p),
                   !p.map.empty(), k, f.panel_width, f.panel_height + above});
    if (!p.map.empty()) place_axes(out.back(), p, above);
  }
  return out;
}

std::string gnuplot_script(const Figure& f, std::string_view stem, bool each) {
  const auto files = panel_files(f, stem);
  const int n = static_cast<int>(files.size());
  const int columns = std::max(1, std::min(f.columns, n)), rows = std::max(1, (n + columns - 1) / columns);
  std::string data;
  std::vector<std::string> together, panels, telling;  // words of each panel, in company, alone and with its values
  for (const PanelFile& file : files) {
    const Panel& p = f.panels[file.panel];
    const int k = int(panels.size());
    auto [block, words] = panel_script(p, k, f.panel_width, f.panel_height, &file);
    data += block;
    panels.push_back(std::move(words));
    together.push_back(n == 1 ? panels.back() : panel_script(p, k, f.panel_width, f.panel_height).second);
    telling.push_back(tells_values(p) ? panel_script(p, k, f.panel_width, f.panel_height, &file, true).second
                                      : panels.back());
  }
  std::string s = data + kLook;
  const int width = columns * f.panel_width;
  const std::string above = f.title.empty() ? "" : title(f.title, width);
  s += fmt::format("set terminal pngcairo noenhanced size {},{} font 'Sans,11' background '#ffffff'\nset output {}\n",
                   width, rows * f.panel_height + title_height(f, width), literal(std::string(stem) + ".png"));
  s += fmt::format("set multiplot layout {},{}{}\n", rows, columns, above.empty() ? "" : " title " + above);
  for (const std::string& p : together) s += p;
  s += "\nunset multiplot\n";
  const auto alone = [&](std::string_view terminal, const std::string& file, const std::string& words) {
    s += fmt::format("set terminal {}\nset output {}\n{}", terminal, literal(file), words);
  };
  for (int k = 0; each && k < n; ++k) {
    const PanelFile& file = files[std::size_t(k)];
    if (!file.map)
      alone(fmt::format("svg noenhanced size {},{} font 'sans-serif,13' background '#ffffff'", f.panel_width,
                        f.panel_height),
            file.picture, telling[std::size_t(k)]);
    else if (n > 1)
      alone(fmt::format("pngcairo noenhanced size {},{} font 'Sans,11' background '#ffffff'", f.panel_width,
                        f.panel_height),
            file.picture, panels[std::size_t(k)]);
    alone(fmt::format("pdfcairo noenhanced size {:.2f},{:.2f} font 'Sans,10'", f.panel_width / 110.0,
                      f.panel_height / 110.0),
          file.pdf, panels[std::size_t(k)]);
  }
  return s + "unset output\n";
}

namespace {

/// Whether a picture is whole: each of its formats says where it ends.
bool has_its_end(const fs::path& file) {
  const std::string bytes = read_file(file);
  const std::string_view last = std::string_view(bytes).substr(bytes.size() - std::min<std::size_t>(bytes.size(), 32));
  const std::string kind = file.extension();
  return last.find(kind == ".svg" ? "</svg>" : kind == ".png" ? "IEND" : "%%EOF") != std::string_view::npos;
}

/// The largest of all finite values: beside it the others may be round-off.
double largest(const std::vector<double>& values, double at_least = 0) {
  for (const double v : values)
    if (std::isfinite(v)) at_least = std::max(at_least, std::abs(v));
  return at_least;
}

/// "spin [rpm]" and 2500: "spin 2500 rpm".
std::string value_of(const std::string& label, double value, double scale) {
  const std::size_t open = label.find(" ["), close = label.find(']', open);
  std::string name = label.substr(0, open);
  if (const std::size_t arrow = name.rfind("<- "); arrow != name.npos)
    name.erase(0, name.find_first_not_of(' ', arrow + 3));
  return fmt::format("{}{}{}{}", name, name.empty() ? "" : " ", beside(value, scale, false, 5),
                     open == label.npos || close == label.npos ? "" : " " + label.substr(open + 2, close - open - 2));
}

/// Gives each point its values as a title, for browsers, in place of the number that gnuplot would show by a script.
void tell_values(const fs::path& file, const Panel& p) {
  static constexpr std::string_view kBegin = "<g onmousemove=\"gnuplot_svg.showHypertext(evt,'",
                                    kEnd = "<title> </title>";
  const std::string drawn = read_file(file);
  double across = 0, up = 0;
  for (const Series& c : p.series) across = largest(c.x, across), up = largest(c.y, up);
  std::string out;
  std::size_t at = 0;
  for (std::size_t begin; (begin = drawn.find(kBegin, at)) != drawn.npos;) {
    const std::size_t end = drawn.find(kEnd, begin);
    std::size_t series = 0, point = 0;
    if (end == drawn.npos || std::sscanf(drawn.c_str() + begin + kBegin.size(), "%zu %zu", &series, &point) != 2 ||
        series >= p.series.size() || point >= p.series[series].x.size())
      throw std::runtime_error(file.string() + ": gnuplot wrote points that are not understood");
    const Series& c = p.series[series];
    std::string told = (c.label.empty() ? "" : c.label + ": ") + value_of(p.x_label, c.x[point], across) + ", " +
                       value_of(p.y_label, c.y[point], up);
    if (!c.error.empty()) told += fmt::format(" ± {:.2g}", c.error[point]);
    out += drawn.substr(at, begin - at) + "<g><title>" + escape_html(characters(told)) + "</title>";
    at = end + kEnd.size();
  }
  out += drawn.substr(at);
  // Names that gnuplot gives itself and its groups would be told as well.
  if (const std::size_t own = out.find("<title>Gnuplot</title>"); own != out.npos) out.erase(own, 22);
  for (std::size_t begin; (begin = out.find("<title>gnuplot_plot_")) != out.npos;)
    out.erase(begin, out.find("</title>", begin) + 8 - begin);
  write_file(file, out, false);
}

}  // namespace

std::string map_values(const Panel& p, const PanelFile& file) {
  std::string s = fmt::format("<svg viewBox='0 0 {} {}'>", file.width, file.height);
  const auto columns = p.map_x.size(), rows = p.map_y.size();
  const double w = file.width * (file.right - file.left), h = file.height * (file.bottom - file.top);
  const auto X = [&](double x) {
    return file.width * file.left + w * (x - p.map_x.front()) / (p.map_x.back() - p.map_x.front());
  };
  const auto Y = [&](double y) {
    return file.height * file.bottom - h * (y - p.map_y.front()) / (p.map_y.back() - p.map_y.front());
  };
  const double most = largest(p.map), across = largest(p.map_x), up = largest(p.map_y);
  // A place reaches half way to the next.
  const auto edge = [](const std::vector<double>& at, std::size_t i, bool upper) {
    const std::size_t j = upper ? std::min(i + 1, at.size() - 1) : i - (i > 0);
    return 0.5 * (at[i] + at[j]);
  };
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const double v = p.map[j * columns + i];
      if (!std::isfinite(v)) continue;
      const double x0 = X(edge(p.map_x, i, false)), x1 = X(edge(p.map_x, i, true)), y0 = Y(edge(p.map_y, j, true)),
                   y1 = Y(edge(p.map_y, j, false));
      s += fmt::format(
          "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill-opacity='0'><title>{}\n{}, "
          "{}</title></rect>",
          x0, y0, x1 - x0, y1 - y0,
          escape_html((p.title.empty() ? "" : p.title + ": ") + value_of(p.map_label, v, most)),
          escape_html(value_of(p.x_label, p.map_x[i], across)), escape_html(value_of(p.y_label, p.map_y[j], up)));
    }
  return s + "</svg>";
}

bool shows(const Figure& figure) { return std::ranges::any_of(figure.panels, shows_something); }

std::string draw(const Figure& figure, const fs::path& stem, bool panels, const fs::path& outside) {
  if (!shows(figure)) return "no picture: there is nothing to show in " + stem.string();
  fs::path gp = stem;
  gp += ".gp";
  const std::string name = stem.filename().string();
  const fs::path place = stem.parent_path().empty() ? fs::path(".") : stem.parent_path();
  write_file(gp, gnuplot_script(figure, name, panels), false);
  const fs::path program = find_program("gnuplot", outside.empty() ? place : outside);
  if (program.empty())
    return "no picture: gnuplot is not installed where PATH says absolutely (the script is " + gp.string() + ")";
  const WorkFolder work(place);
  const WrittenFiles passing(work.path());  // what is written there goes with it: no run misses it
  std::vector<std::string> made = {name + ".png"};
  const auto files = panel_files(figure, name);
  if (panels && files.size() > 1) {
    fs::create_directories(work.path() / name);
    fs::create_directories(stem);
  }
  for (const PanelFile& file : files) {
    if (!panels) break;
    made.push_back(file.pdf);
    if (!file.map || files.size() > 1) made.push_back(file.picture);
  }
  // gnuplot works below the script: no path of the person's ever becomes program text.
  std::string word = program.string(), alone = "-d", script = "../" + name + ".gp";  // alone: without ~/.gnuplot
  char* argv[] = {word.data(), alone.data(), script.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, work.path().c_str());
  // Its warnings are of the script, not of the run.
  constexpr const char* said = "gnuplot.log";
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, said, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const int refused = posix_spawn(&child, word.c_str(), &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  const auto failed = [&] {
    std::string last;
    std::ifstream log(work.path() / said);
    for (std::string line; std::getline(log, line);)
      if (!line.empty()) last = ": " + line;
    return "no picture: gnuplot could not draw " + gp.string() + last;
  };
  int status = 0;
  if (refused || waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return failed();
  for (const std::string& file : made) {
    if (!fs::is_regular_file(fs::symlink_status(work.path() / file))) return failed();
    // gnuplot ends with 0 on a disk that is full.
    if (!has_its_end(work.path() / file))
      throw std::runtime_error(
          fmt::format("{}: cannot be written: gnuplot wrote a part of it: is the disk full?", (place / file).string()));
  }
  for (const PanelFile& file : files)
    if (panels && !file.map && tells_values(figure.panels[file.panel]))
      tell_values(work.path() / file.picture, figure.panels[file.panel]);
  for (const std::string& file : made) move_file(work.path() / file, place / file);
  return {};
}

}  // namespace hosel::post
