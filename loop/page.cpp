#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "loop/report.hpp"

namespace hosel::loop {
namespace {

std::string escape(const std::string& s) {
  std::string out;
  for (const char c : s) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else out += c;
  }
  return out;
}

struct Point {
  double x, before, after;
  bool holdout;
};

/// Round steps of about a fifth of the range.
double tick(double range) {
  const double raw = range / 4, power = std::pow(10, std::floor(std::log10(raw)));
  for (const double f : {1.0, 2.0, 5.0, 10.0})
    if (raw <= f * power) return f * power;
  return 10 * power;
}

/// Residual before (grey) and after (blue, holdout orange) against a regressor, the noise as a band.
std::string scatter(const std::vector<Point>& points, const std::string& x_label, const std::string& y_label, double noise) {
  constexpr double w = 460, h = 270, left = 62, right = 12, top = 10, bottom = 44;
  double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y1 = 2.5 * noise;
  std::vector<double> sizes;
  for (const Point& p : points) {
    x0 = std::min(x0, p.x);
    x1 = std::max(x1, p.x);
    sizes.push_back(std::max(std::abs(p.before), std::abs(p.after)));
  }
  if (points.empty()) return "";
  std::ranges::sort(sizes);
  y1 = std::max(y1, 1.08 * sizes[std::size_t(0.99 * double(sizes.size() - 1))]);
  if (!(x1 > x0)) x1 = x0 + 1;
  const double margin = 0.03 * (x1 - x0);
  x0 -= margin;
  x1 += margin;
  const auto X = [&](double x) { return left + (x - x0) / (x1 - x0) * (w - left - right); };
  const auto Y = [&](double y) { return top + (y1 - std::clamp(y, -y1, y1)) / (2 * y1) * (h - top - bottom); };
  std::string s = fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='{} against {}'>", w, h, escape(y_label), escape(x_label));
  s += fmt::format("<rect class='band' x='{}' y='{:.1f}' width='{}' height='{:.1f}'/>", left, Y(noise), w - left - right, Y(-noise) - Y(noise));
  const double dy = tick(2 * y1), dx = tick(x1 - x0);
  for (double y = std::ceil(-y1 / dy) * dy; y <= y1; y += dy)
    s += fmt::format("<line class='grid' x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}'/><text x='{}' y='{:.1f}' text-anchor='end'>{:g}</text>", left, w - right,
                     Y(y), Y(y), left - 6, Y(y) + 4, std::abs(y) < 1e-9 * dy ? 0.0 : y);
  for (double x = std::ceil(x0 / dx) * dx; x <= x1; x += dx)
    s += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{:g}</text>", X(x), h - bottom + 16, std::abs(x) < 1e-9 * dx ? 0.0 : x);
  const std::size_t step = std::max<std::size_t>(1, points.size() / 1500);
  for (std::size_t i = 0; i < points.size(); i += step)
    if (std::isfinite(points[i].before)) s += fmt::format("<circle class='before' cx='{:.1f}' cy='{:.1f}' r='2.6'/>", X(points[i].x), Y(points[i].before));
  for (std::size_t i = 0; i < points.size(); i += step)
    if (std::isfinite(points[i].after))
      s += fmt::format("<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='2.6'/>", points[i].holdout ? "holdout" : "after", X(points[i].x), Y(points[i].after));
  s += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>", (left + w - right) / 2, h - 8, escape(x_label));
  s += fmt::format("<text transform='translate(13 {:.1f}) rotate(-90)' text-anchor='middle'>{}</text></svg>", (top + h - bottom) / 2, escape(y_label));
  return s;
}

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : "–"; }

/// 95 % interval of a root mean square from n values.
std::string rms(double x, int n) {
  if (!std::isfinite(x)) return "–";
  if (n < 3) return number(x);
  const double half = 1.96 / std::sqrt(2.0 * n);
  return fmt::format("{} <small>({}–{})</small>", number(x), number(x * (1 - half)), number(x * (1 + half)));
}

}  // namespace

std::string page(const LoopResult& r, const Shots& shots) {
  std::string s = "<!doctype html><html lang='en'><meta charset='utf-8'><title>" + escape(r.title) + "</title><style>"
      "body{font:15px/1.5 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#222;background:#fff}"
      "h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem;border-bottom:1px solid #ddd}table{border-collapse:collapse;margin:.5rem 0}"
      "td,th{padding:.2rem .7rem;text-align:right;border-bottom:1px solid #eee}td:first-child,th:first-child,.l{text-align:left}small{color:#666}"
      ".verdict{font-size:1.15rem;background:#eef4fa;border-left:4px solid #1f5f99;padding:.6rem 1rem}"
      ".figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(400px,1fr));gap:1rem}svg{width:100%;background:#fff}svg text{font-size:12px;fill:#333}"
      ".grid{stroke:#e4e4e4}.band{fill:#f3efe2}.before{fill:#9a9a9a;opacity:.6}.after{fill:#1f5f99;opacity:.8}.holdout{fill:#d9731a;opacity:.85}"
      "</style>";
  s += fmt::format("<h1>{}</h1><p class='verdict'><b>{}.</b> {}</p>", escape(r.title.empty() ? "Measured shots against a model" : r.title), name(r.verdict),
                   escape(sentence(r)));
  s += fmt::format("<p>Base model <b>{}</b>. {} rows read, {} used ({} to learn from, {} held out, seed {}), {} flagged.</p>", escape(r.base), r.read, r.used, r.train,
                   r.holdout, r.seed, r.flagged.size());

  s += "<h2>Before and after</h2><table><tr><th>channel<th>noise<th>scatter / noise<th>held out: RMS before<th>RMS after<th>bias before<th>bias after</tr>";
  for (const ChannelResult& c : r.channels)
    s += fmt::format("<tr><td>{}<td>{} <small>{}</small><td>{}<td>{}<td>{}<td>{}<td>{}</tr>", escape(c.name), number(c.noise), c.noise_source, number(c.scatter),
                     rms(c.before.holdout_rmse, c.before.holdout), rms(c.after.holdout_rmse, c.after.holdout), number(c.before.holdout_bias), number(c.after.holdout_bias));
  s += "</table><p><small>Residual is model minus measured; in brackets 95 % intervals.</small></p>";

  s += "<h2>Residuals</h2><p><small>Grey: before. Blue: after, training shots. Orange: after, held-out shots. Band: one standard deviation of the noise.</small></p><div class='figures'>";
  const Selection& sel = r.selection;
  for (std::size_t c = 0; c < r.channels.size(); ++c) {
    // Against the column that the structure follows most, and against the shot number.
    std::string column;
    for (const Finding& f : sel.before.findings)
      if (f.channel == int(c) && f.regressor >= 0 && std::size_t(f.regressor) < sel.regressors.size()) {
        const Column* k = shots.find(sel.regressors[std::size_t(f.regressor)].column);
        if (k && k->numeric) {
          column = k->name;
          break;
        }
      }
    if (column.empty())
      if (const Column* loft = shots.find_stem("dynamic_loft")) column = loft->name;
    const Column* k = shots.find(column);
    if (!k) continue;
    std::vector<Point> points;
    for (const UsedShot& u : r.shots)
      if (const double x = k->native(std::size_t(u.row)); std::isfinite(x)) points.push_back({x, u.before[c], u.after[c], u.holdout});
    s += "<div>" + scatter(points, column, r.channels[c].name + ": model − measured", r.channels[c].noise) + "</div>";
  }
  s += "</div>";

  s += "<h2>Candidates</h2><table><tr><th>effects<th class='l'>parameters<th>deviance falls by<th>held-out score</tr>";
  s += fmt::format("<tr><td>base alone<td class='l'>–<td>0<td>{}</tr>", number(r.base_score));
  for (std::size_t i = 0; i < std::min<std::size_t>(12, r.candidates.size()); ++i) {
    const ScoredCandidate& c = r.candidates[i];
    std::string parameters;
    const auto list = c.candidate.fit.model.parameters();
    for (std::size_t k = 0; k < list.size(); ++k)
      parameters += fmt::format("{}{} = {} ± {} {}", k ? "; " : "", list[k]->name, number(c.candidate.fit.p[std::ptrdiff_t(k)] / list[k]->si), number(c.sd[k] / list[k]->si),
                                list[k]->unit == "1" ? "" : list[k]->unit);
    s += fmt::format("<tr><td>{}<td class='l'>{}<td>{}<td>{}</tr>", escape(fmt::format("{}", fmt::join(c.candidate.effects, " + "))), escape(parameters),
                     number(sel.base.deviance - c.candidate.fit.deviance), number(c.holdout_score));
  }
  s += "</table>";
  if (!r.ties.empty()) {
    s += "<p>Tied: ";
    for (const auto& t : r.ties) s += escape(fmt::format("{}. ", fmt::join(t, " or ")));
    s += "</p>";
  }
  if (!r.unexplained.empty()) {
    s += "<h2>Unexplained</h2><ul>";
    for (const Location& l : r.unexplained) s += fmt::format("<li>{} against {} <small>({})</small>", escape(l.channel), escape(l.regressor), escape(l.detail));
    s += "</ul>";
  }
  if (!r.derived.empty()) {
    s += "<h2>Columns that are not measurements</h2><ul>";
    for (const DerivedColumn& d : r.derived)
      s += fmt::format("<li><b>{}</b> = {} <small>(residual {}, recording step {}, {} rows)</small>", escape(d.column), escape(d.formula), number(d.residual_sd),
                       number(d.recording_resolution), d.rows);
    s += "</ul>";
  }
  if (!r.flagged.empty()) {
    s += "<h2>Flagged rows</h2><table><tr><th>shot<th class='l'>column<th class='l'>reason<th>finding</tr>";
    for (std::size_t i = 0; i < std::min<std::size_t>(r.flagged.size(), 200); ++i)
      s += fmt::format("<tr><td>{}<td class='l'>{}<td class='l'>{}<td>{}</tr>", escape(r.flagged[i].shot), escape(r.flagged[i].column), escape(r.flagged[i].reason), r.flagged[i].finding);
    s += "</table>";
    if (r.flagged.size() > 200) s += fmt::format("<p><small>and {} more, in report.json</small></p>", r.flagged.size() - 200);
  }
  s += "<h2>What to measure next</h2><p>" + escape(r.next.text) + "</p>";
  if (!r.next.shots.empty()) {
    s += "<table><tr>";
    for (const auto& [header, x] : r.next.shots[0].inputs) s += "<th>" + escape(header);
    s += "</tr>";
    for (const DesignedShot& d : r.next.shots) {
      s += "<tr>";
      for (const auto& [header, x] : d.inputs) s += "<td>" + number(x);
      s += "</tr>";
    }
    s += "</table>";
  }
  s += "<h2>Smallest effect that these shots would show</h2><table><tr><th>effect<th class='l'>parameter<th>value</tr>";
  for (const Detectable& d : r.minimum_detectable)
    s += fmt::format("<tr><td>{}<td class='l'>{}<td>{} {}</tr>", escape(d.effect), escape(d.parameter),
                     std::isfinite(d.value) ? number(d.value) : std::string("beyond its plausible range"), std::isfinite(d.value) && d.unit != "1" ? d.unit : "");
  s += "</table>";
  if (!r.notes.empty() || !r.unused.empty()) {
    s += "<h2>Notes</h2><ul>";
    for (const auto& [reason, n] : r.unused) s += fmt::format("<li>{} rows not used: {}", n, escape(reason));
    for (const std::string& n : r.notes) s += "<li>" + escape(n);
    s += "</ul>";
  }
  return s + "</html>\n";
}

}  // namespace hosel::loop
