#include "hosel/post/figure.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

extern char** environ;

namespace hosel::post {
namespace {

/// A gnuplot string in single quotes; enhanced markup is off, so the text stands as it is. A line break would end the
/// string and let what follows be executed: it and its kind become blanks.
std::string literal(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    if (c == '\'') out += '\'';
  }
  return out + "'";
}

void append_number(std::string& out, double value) {
  out += std::isfinite(value) ? fmt::format("{:.10g}", value) : "NaN";
}

std::string data_block(const std::string& name, const Series& s) {
  if (s.x.size() != s.y.size() || (!s.error.empty() && s.error.size() != s.x.size()))
    throw std::invalid_argument("figure: series '" + s.label + "' has columns of different length");
  std::string out = "$" + name + " << EOD\n";
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    append_number(out, s.x[i]);
    out += ' ';
    append_number(out, s.y[i]);
    if (!s.error.empty()) {
      out += ' ';
      append_number(out, s.error[i]);
    }
    out += '\n';
  }
  return out + "EOD\n";
}

std::string map_block(const std::string& name, const Panel& p) {
  if (p.map.size() != p.map_x.size() * p.map_y.size())
    throw std::invalid_argument("figure: map '" + p.title + "' does not fill its grid");
  std::string out = "$" + name + " << EOD\n";
  for (std::size_t j = 0; j < p.map_y.size(); ++j) {
    for (std::size_t i = 0; i < p.map_x.size(); ++i) {
      append_number(out, p.map_x[i]);
      out += ' ';
      append_number(out, p.map_y[j]);
      out += ' ';
      append_number(out, p.map[j * p.map_x.size() + i]);
      out += '\n';
    }
    out += '\n';
  }
  return out + "EOD\n";
}

}  // namespace

std::string gnuplot_script(const Figure& f, std::string_view png) {
  const int n = static_cast<int>(f.panels.size());
  const int columns = std::max(1, std::min(f.columns, n)), rows = std::max(1, (n + columns - 1) / columns);
  std::string s, plots;
  for (int k = 0; k < n; ++k) {
    const Panel& p = f.panels[k];
    plots += "\nset title " + literal(p.title) + "\nset xlabel " + literal(p.x_label) + "\nset ylabel " +
             literal(p.y_label) + "\nset key opaque " + p.key + "\n";
    plots += p.log_x ? "set logscale x\n" : "unset logscale x\n";
    plots += p.log_y ? "set logscale y\n" : "unset logscale y\n";
    if (!p.map.empty()) {
      const std::string name = fmt::format("map{}", k);
      s += map_block(name, p);
      double low = INFINITY, high = -INFINITY;
      for (const double v : p.map)
        if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
      // A field that is constant to round-off is shown as one colour, not as noise.
      const double size = std::max(std::abs(low), std::abs(high));
      if (p.map_symmetric) {
        high = size > 1e-9 ? size : 1;
        low = -high;
      } else if (!(high - low > 1e-9 * size)) {
        low = (std::isfinite(low) ? low : 0) - 1, high = low + 2;
      }
      plots += fmt::format(
          "set palette defined ({})\nset size {}\n"
          "set cblabel {}\nset cbrange [{:.10g}:{:.10g}]\nset xrange [{:.10g}:{:.10g}]\nset yrange [{:.10g}:{:.10g}]\n",
          p.map_symmetric ? "0 '#2b5c8a', 0.5 '#f7f5ec', 1 '#b5432f'"
                          : "0 '#ffffd9', 0.3 '#c7e9b4', 0.65 '#7fcdbb', 1 '#41a0c4'",
          p.map_equal_axes ? "ratio -1" : "noratio", literal(p.map_label), low, high, p.map_x.front(), p.map_x.back(),
          p.map_y.front(), p.map_y.back());
      if (p.map_contours)
        plots +=
            "set contour base\nset cntrparam cubicspline\nset cntrparam points 6\nset cntrparam levels auto 8\n"
            "set cntrlabel onecolor format '%.5g' start 8 interval 90 font ',8'\n"
            "set style textbox opaque noborder fillcolor '#ffffff' margins 0.2,0.2\n";
      plots += "set pm3d map interpolate 3,3\nsplot $" + name + " with pm3d nocontour notitle";
      if (p.map_contours) plots += ", $" + name + " with lines nosurface lc rgb '#303030' lw 1 notitle";
      for (std::size_t i = 0; i < p.series.size(); ++i) {
        const std::string mark = fmt::format("s{}_{}", k, i);
        s += data_block(mark, p.series[i]);
        plots += ", $" + mark + " using 1:2:(0) with " + p.series[i].style + " lc rgb '#000000' nocontour " +
                 (p.series[i].label.empty() ? "notitle" : "title " + literal(p.series[i].label));
      }
      if (p.map_contours) plots += ", $" + name + " with labels boxed nosurface notitle";
      plots += "\nunset contour\nunset pm3d\nset size noratio\nset autoscale xy\n";
      continue;
    }
    std::string plot;
    bool marks = false;
    for (std::size_t i = 0; i < p.series.size(); ++i) {
      const Series& c = p.series[i];
      if (c.x.empty()) continue;
      marks = marks || !c.error.empty() || c.style.find("points") != std::string::npos;
      const std::string name = fmt::format("s{}_{}", k, i);
      s += data_block(name, c);
      const std::string title = c.label.empty() ? "notitle" : "title " + literal(c.label);
      if (!plot.empty()) plot += ", \\\n     ";
      plot += "$" + name +
              (c.error.empty() ? " using 1:2 with " + c.style : std::string(" using 1:2:3 with yerrorbars"));
      plot += fmt::format(" lt {} lw 1.6 ", i + 1);
      // The colours come round: the next eight curves are dashed.
      if (i >= 8 && c.error.empty()) plot += fmt::format("dt {} ", 1 + i / 8);
      if (!c.error.empty() || c.style.find("points") != std::string::npos)
        plot += fmt::format("pt {} ps 0.9 ", 6 + static_cast<int>(i) % 8);
      plot += title;
    }
    plots += plot.empty()
                 ? "set xrange [0:1]\nset yrange [0:1]\nplot NaN notitle\nset autoscale xy\n"
                 // Marks and their bars stay clear of the frame.
                 : (marks && !p.log_x && !p.log_y ? "set offsets graph 0.04, graph 0.04, graph 0.04, graph 0.04\n"
                                                  : "unset offsets\n") +
                       std::string("plot ") + plot + "\n";
  }
  std::string head = fmt::format(
      "set terminal pngcairo noenhanced size {},{} font 'Sans,11' background '#ffffff'\nset output {}\n"
      "set grid lc rgb '#dddddd'\nset tics nomirror\n",
      columns * f.panel_width, rows * f.panel_height + (f.title.empty() ? 0 : 40), literal(png));
  head +=
      fmt::format("set multiplot layout {},{}{}\n", rows, columns, f.title.empty() ? "" : " title " + literal(f.title));
  return s + head + plots + "\nunset multiplot\nunset output\n";
}

std::string draw(const Figure& figure, const std::filesystem::path& stem) {
  std::filesystem::path gp = stem;
  gp += ".gp";
  const std::string name = stem.filename().string(), place = stem.parent_path().empty() ? "." : stem.parent_path();
  if (std::ofstream out(gp); !(out << gnuplot_script(figure, name + ".png")) || !out.flush())
    throw std::runtime_error("cannot write " + gp.string());
  // gnuplot works beside the script: no path of the person's ever becomes program text.
  std::string program = "gnuplot", script = "./" + name + ".gp";
  char* argv[] = {program.data(), script.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, place.c_str());
  pid_t child = 0;
  const int refused = posix_spawnp(&child, "gnuplot", &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (refused) return "no picture: gnuplot is not installed (the script is " + gp.string() + ")";
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return "no picture: gnuplot could not draw " + gp.string();
  return {};
}

}  // namespace hosel::post
