#include "post/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "post/html.hpp"

namespace hosel::post {
namespace {

constexpr std::size_t kMost = 1500;  // points of a series
constexpr double kLeft = 62, kRight = 12, kTop = 10, kBottom = 44;

std::string opened(double width, double height, const std::string& told) {
  return fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='{}'>", width, height, escape_html(told));
}

}  // namespace

double round_step(double range, double parts) {
  const double least = range / parts, ten = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1, 2, 5})
    if (step * ten >= least) return step * ten;
  return 10 * ten;
}

std::string svg(const SvgPlot& p) {
  const double w = p.width - kLeft - kRight, h = p.height - kTop - kBottom;
  const auto X = [&](double x) { return kLeft + (x - p.x0) / (p.x1 - p.x0) * w; };
  const auto beyond = [&](double y) { return kTop + (p.y1 - y) / (p.y1 - p.y0) * h; };
  const auto Y = [&](double y) { return beyond(std::clamp(y, p.y0, p.y1)); };
  std::string s = opened(p.width, p.height, p.told);
  for (const SvgBand& b : p.bands)
    s += fmt::format("<rect class='band' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/>", X(b.x0), Y(b.y1),
                     X(b.x1) - X(b.x0), Y(b.y0) - Y(b.y1));
  const auto round = [](double x, double step) { return std::abs(x) < 1e-9 * step ? 0.0 : x; };
  // Numbers beside each other need more room than above each other.
  double dy = round_step(p.y1 - p.y0, 4);
  const double dx = round_step((p.x1 - p.x0) / std::max(1.0, p.width / 480), 4);
  // One number is no scale: a range about zero that ends short of the first step.
  if (std::floor(p.y1 / dy) - std::ceil(p.y0 / dy) < 2) dy /= 2;
  for (double y = std::ceil(p.y0 / dy) * dy; y <= p.y1; y += dy)
    s += fmt::format(
        "<line class='grid' x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}'/><text x='{}' y='{:.1f}' "
        "text-anchor='end'>{:g}</text>",
        kLeft, kLeft + w, Y(y), Y(y), kLeft - 6, Y(y) + 4, round(y, dy));
  for (double x = std::ceil(p.x0 / dx) * dx; x <= p.x1; x += dx)
    s += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{:g}</text>", X(x), kTop + h + 16, round(x, dx));
  std::vector<std::array<double, 3>> labels;  // centre, half the width
  for (const SvgSeries& one : p.series) {
    std::string points;
    for (std::size_t i = 0; i < one.x.size(); i += std::max<std::size_t>(1, one.x.size() / kMost)) {
      if (!std::isfinite(one.y[i])) continue;
      if (one.radius > 0)
        s += fmt::format("<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='{}'/>", one.style, X(one.x[i]), Y(one.y[i]),
                         one.radius);
      else points += fmt::format("{:.1f},{:.1f} ", X(one.x[i]), beyond(one.y[i]));
    }
    if (!points.empty())  // a picture in the picture ends at its frame
      s += fmt::format(
          "<svg x='{0}' y='{1}' width='{2}' height='{3}' viewBox='{0} {1} {2} {3}'><polyline class='{4}' "
          "points='{5}'/></svg>",
          kLeft, kTop, w, h, one.style, points);
    if (one.label.empty() || one.y.empty()) continue;
    // Above or below the line, where the words are farthest from every line.
    const double half = 3.3 * double(one.label.size());
    double best = -1, at_x = 0, at_y = 0;
    for (std::size_t i = 0; i < one.y.size(); ++i)
      for (const double above : {14.0, -14.0, 24.0, -24.0}) {
        const double cx = X(one.x[i]), cy = Y(one.y[i]) - above;
        if (cx - half < kLeft || cx + half > kLeft + w || cy < kTop + 8 || cy > kTop + h - 8) continue;
        // Words of an earlier label are no room.
        if (std::ranges::any_of(labels, [&](const auto& l) {
              return std::abs(l[0] - cx) < l[2] + half + 6 && std::abs(l[1] - cy) < 14;
            }))
          continue;
        double nearest = 20 - 0.2 * std::abs(above);  // room enough
        for (const SvgSeries& other : p.series)
          for (std::size_t k = 1; k < other.x.size(); ++k)
            for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {  // a steep line crosses words between its points
              const double x = X(std::lerp(other.x[k - 1], other.x[k], t)),
                           y = Y(std::lerp(other.y[k - 1], other.y[k], t));
              nearest = std::min(
                  nearest, std::hypot(std::max(0.0, std::abs(x - cx) - half), std::max(0.0, std::abs(y - cy) - 6)));
            }
        if (nearest > best) best = nearest, at_x = cx, at_y = cy;
      }
    if (best >= 0) labels.push_back({at_x, at_y, half});
    if (best >= 0)
      s += fmt::format("<text class='{}' x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>", one.style, at_x,
                       at_y + 4, escape_html(one.label));
  }
  for (const SvgMark& m : p.marks) {
    const bool left = X(m.x) > kLeft + 0.6 * w;
    s += fmt::format(
        "<circle class='mark' cx='{:.1f}' cy='{:.1f}' r='4'/><text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>",
        X(m.x), Y(m.y), X(m.x) + (left ? -9 : 9), Y(m.y) - 4, left ? "end" : "start", escape_html(m.text));
  }
  return s + fmt::format(
                 "<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text><text transform='translate(13 {:.1f}) "
                 "rotate(-90)' text-anchor='middle'>{}</text></svg>",
                 kLeft + w / 2, p.height - 8, escape_html(p.x_label), kTop + h / 2, escape_html(p.y_label));
}

std::string svg(const SvgBars& b) {
  constexpr double width = 640, left = 160, right = 80, bar = 14, top = 22;
  double most = 2, height = top + 26;
  for (const auto& row : b.rows) {
    height += 10 + 18 * double(row.bars.size());
    for (const SvgBar& x : row.bars) most = std::max(most, x.high);  // room for the whisker
  }
  const bool wide = most > 12;
  const auto X = [&](double x) {
    const double share = wide ? std::log10(std::max(x, 0.3) / 0.3) / std::log10(most / 0.3) : x / most;
    return left + share * (width - left - right);
  };
  std::string s = opened(width, height, b.told);
  s += fmt::format(
      "<line class='one' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2:.1f}'/><text x='{0:.1f}' y='{3}' "
      "text-anchor='middle'>{4}</text>",
      X(1), top - 4, height - 24, top - 8, escape_html(b.one));
  double y = top;
  for (const auto& row : b.rows) {
    s += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>{}</text>", left - 10,
                     y + 6 + 9 * double(row.bars.size()), escape_html(row.label));
    y += 4;
    for (const SvgBar& x : row.bars) {
      s += fmt::format("<rect class='{}' x='{}' y='{:.1f}' width='{:.1f}' height='{}' rx='2'/>", x.style, left, y,
                       std::max(1.0, X(x.value) - left), bar);
      s += fmt::format("<line class='whisker' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>", X(x.low), X(x.high),
                       y + 7, y + 7);
      s += fmt::format("<text x='{:.1f}' y='{:.1f}'>{}</text>", X(x.high) + 6, y + 11.5, escape_html(x.text));
      y += 18;
    }
    y += 6;
  }
  return s + fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}{}</text></svg>",
                         (left + width - right) / 2, height - 6, escape_html(b.axis), wide ? " (logarithmic)" : "");
}

}  // namespace hosel::post
