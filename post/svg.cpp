#include "post/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "post/html.hpp"

namespace hosel::post {
namespace {

constexpr std::size_t kMost = 1500;  // points of a series
constexpr double kLeft = 62, kRight = 12, kTop = 10, kBottom = 44;

std::string opened(double width, double height, const std::string& told) {
  return fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='{}'>", width, height, escape_html(told));
}

constexpr double kLetter = 6.6, kLine = 14;  // width and height of a text's characters [pixel]

/// A rectangle that words or a mark take, by its centre and half its sides.
struct Box {
  double x, y, half_width, half_height;
  bool meets(const Box& b, double room) const {
    return std::abs(x - b.x) < half_width + b.half_width + room && std::abs(y - b.y) < half_height + b.half_height;
  }
};

struct Spot {
  double x, y;
};

/// What a series covers: its points, of a line so close that no word fits between two of them.
std::vector<Spot> covered(const SvgSeries& one, const auto& X, const auto& Y) {
  std::vector<Spot> out;
  for (std::size_t i = 0; i < one.x.size(); ++i) {
    if (!std::isfinite(one.y[i])) continue;
    const Spot to{X(one.x[i]), Y(one.y[i])};
    if (one.radius == 0 && i > 0 && std::isfinite(one.y[i - 1])) {
      const Spot from{X(one.x[i - 1]), Y(one.y[i - 1])};
      const int parts = int(std::hypot(to.x - from.x, to.y - from.y) / 3) + 1;
      for (int k = 1; k < parts; ++k)
        out.push_back({std::lerp(from.x, to.x, double(k) / parts), std::lerp(from.y, to.y, double(k) / parts)});
    }
    out.push_back(to);
  }
  return out;
}

double distance(const Box& box, const std::vector<Spot>& spots) {
  double least = 1e9;
  for (const Spot& s : spots)
    least = std::min(least, std::hypot(std::max(0.0, std::abs(s.x - box.x) - box.half_width),
                                       std::max(0.0, std::abs(s.y - box.y) - box.half_height)));
  return least;
}

/// Where the words of a series stand: inside the frame, clear of what is taken, clear of every line, and nearer to
/// their own line than to another. Nothing where there is no such place.
std::optional<Box> label_place(std::size_t own, const std::vector<std::vector<Spot>>& lines,
                               const std::vector<Spot>& along, std::size_t letters, const Box& frame,
                               const std::vector<Box>& taken) {
  constexpr double clear = 3, enough = 16;  // from a line; more than `enough` is no better
  const double half = kLetter / 2 * double(letters);
  std::optional<Box> best;
  double best_score = 0;
  for (const Spot& p : along)
    for (const double dy : {-14.0, 14.0, -24.0, 24.0, 0.0})
      for (const double dx : {0.0, half + 8, -half - 8}) {
        if (dx == 0 && dy == 0) continue;
        const Box box{p.x + dx, p.y + dy, half, 6};
        if (std::abs(box.x - frame.x) + half > frame.half_width || std::abs(box.y - frame.y) + 8 > frame.half_height)
          continue;
        if (std::ranges::any_of(taken, [&](const Box& b) { return box.meets(b, 6); })) continue;
        const double mine = distance(box, lines[own]);
        double others = enough;
        for (std::size_t k = 0; k < lines.size(); ++k)
          if (k != own) others = std::min(others, distance(box, lines[k]));
        if (mine < clear || others < clear || others < 1.5 * std::min(mine, 8.0)) continue;
        if (const double score = others - 0.5 * mine; !best || score > best_score) best = box, best_score = score;
      }
  return best;
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
  std::string s;
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
  std::vector<Box> taken;
  for (const SvgMark& m : p.marks) {
    const bool left = X(m.x) > kLeft + 0.6 * w;
    s += fmt::format(
        "<circle class='mark' cx='{:.1f}' cy='{:.1f}' r='4'/><text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>",
        X(m.x), Y(m.y), X(m.x) + (left ? -9 : 9), Y(m.y) - 4, left ? "end" : "start", escape_html(m.text));
    const double half = kLetter / 2 * double(m.text.size());
    taken.push_back({X(m.x), Y(m.y), 5, 5});
    taken.push_back({X(m.x) + (left ? -1 : 1) * (9 + half), Y(m.y) - 8, half, kLine / 2});
  }
  std::vector<std::vector<Spot>> lines;
  for (const SvgSeries& one : p.series) lines.push_back(covered(one, X, Y));
  const Box frame{kLeft + w / 2, kTop + h / 2, w / 2, h / 2};
  std::vector<const SvgSeries*> key;  // series whose words have no place beside them
  for (std::size_t k = 0; k < p.series.size(); ++k) {
    const SvgSeries& one = p.series[k];
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
    if (one.label.empty() || lines[k].empty()) continue;
    // The peak, and places along the line.
    std::vector<Spot> along{*std::ranges::min_element(lines[k], {}, &Spot::y)};
    for (std::size_t i = 0; i < lines[k].size(); i += 1 + lines[k].size() / 150) along.push_back(lines[k][i]);
    if (const auto place = label_place(k, lines, along, one.label.size(), frame, taken)) {
      taken.push_back(*place);
      s += fmt::format("<text class='{}' x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>", one.style, place->x,
                       place->y + 4, escape_html(one.label));
    } else {
      key.push_back(&one);
    }
  }
  double height = p.height, x = kLeft;
  for (const SvgSeries* one : key) {  // rows beneath the axis
    const double wide = 30 + kLetter * double(one->label.size());
    if (x == kLeft || x + wide > p.width) x = kLeft, height += 18;
    s += one->radius > 0 ? fmt::format("<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='{}'/>", one->style, x + 9,
                                       height - 9, one->radius)
                         : fmt::format("<polyline class='{}' points='{:.1f},{:.1f} {:.1f},{:.1f}'/>", one->style, x,
                                       height - 9, x + 18, height - 9);
    s += fmt::format("<text class='{}' x='{:.1f}' y='{:.1f}'>{}</text>", one->style, x + 23, height - 5,
                     escape_html(one->label));
    x += wide + 12;
  }
  return opened(p.width, height, p.told) + s +
         fmt::format(
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
